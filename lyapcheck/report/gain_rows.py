"""What a report shows of a gain set: its four ε₀ and its simulated run, to digits that machines agree on."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

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


@dataclass(frozen=True)
class PrintedRow:
    """What the paper measured of the same: L2 and final errors in °, settling times in s."""

    L2: float
    settling: tuple[float, ...] | None
    final_error: tuple[float, ...]


@dataclass(frozen=True)
class RunRow:
    """A simulated run as `lyapcheck simulate` writes it, and beyond that two numbers of the bench.

    Args:
        top_speed: the largest |q̇_i|, rad/s.
        rest: how far off, °, dry friction may hold a joint; none where it may hold it anywhere.
    """

    name: str
    m: int | None
    robot: str
    kind: str
    complete: bool
    time: float
    reached: float
    start: tuple[float, ...]
    target: tuple[float, ...]
    joints: tuple[str, ...]
    L2: float | None
    settling_band: float
    settling: tuple[float | None, ...]
    overshoot: tuple[float | None, ...]
    final_error: tuple[float | None, ...]
    peak_torque: tuple[float, ...]
    torque_limit: tuple[float | None, ...]
    inside_limits: tuple[bool | None, ...]
    joint_bounds: tuple[float | None, ...] | None
    torque_norm: float
    torque_bound: float | None
    inside_bound: bool | None
    eps0: float
    V_start: float | None
    V_end: float | None
    V_decreases: bool | None
    V_rises_at: float | None
    breach: Mapping[str, Any] | None
    printed: PrintedRow | None
    top_speed: float
    rest: float | None
