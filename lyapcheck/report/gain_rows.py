"""What a report shows of a gain set: its four ε₀ and its simulated run, to digits that machines agree on."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import SimpleNamespace

from lyapcheck.promise import Promise

BOTH_ENDS = ("certified", "falsified")
"""The ε₀ that rest on certificates."""
KINDS = ("published", "scalar", *BOTH_ENDS)
LINKED = (*BOTH_ENDS, "weighted")


@dataclass(frozen=True)
class EpsilonRow:
    """The four ε₀ of a gain set as decimals, rounded to the safe side; ``None`` where there is none.

    Args:
        certified_by: which search proposed the proof.
        assumptions: what is taken for granted about the arm.
        seed: of the sampled states.
        ratio: certified/falsified.
        boxes: the budget of branch and bound.
        reasons: why an ε₀ is missing, by its name.
        certificates: their paths in the report, by the names of ``LINKED``.
        weighted: ε₀Λ with the largest product that is accepted, joint by joint; empty where none was sought.
        promise: that V falls at every state of the arm at its nominal numbers, with the certified ε₀.
    """

    name: str
    m: int | None
    robot: str
    certified_by: str | None
    assumptions: tuple[str, ...]
    seed: int
    published: str | None
    scalar: str | None
    certified: str | None
    falsified: str | None
    ratio: str | None
    boxes: int
    reasons: Mapping[str, str]
    certificates: Mapping[str, str]
    weighted: tuple[str, ...] = ()
    promise: Promise | None = None

    def eps0(self, kind: str) -> str | None:
        """One of ``KINDS``."""
        value: str | None = getattr(self, kind)
        return value


RunRow = SimpleNamespace
"""A simulated run as `lyapcheck simulate` writes it, to six digits. Beyond that two numbers of the bench:
``top_speed``, the largest |q̇_i| in rad/s, and ``rest``, how far off, °, dry friction may hold a joint; none
where it may hold it anywhere."""
