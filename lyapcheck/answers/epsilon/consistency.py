"""What the numbers say about each other: no proved one may be refuted, and what follows is said.

References: ``reyes2019family`` (18).
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import TYPE_CHECKING

from lyapcheck.check.loop.states import confirms_positive
from lyapcheck.files.decimals import decimal_text

if TYPE_CHECKING:
    from lyapcheck.search.controlled_arm import ControlledArm
    from lyapcheck.search.falsify import RisingState


ROUNDED = Fraction(1, 10**8)
"""More than the end of (18) loses where it is rounded down, as a share of it."""
FINDINGS: Mapping[str, str] = {
    "published-refuted": (
        "(18) is refuted: it allows all ε₀ below its end, and the witness refutes a smaller one"
    ),
    "published-certified": "(18) allows no ε₀ above the certified one",
    "no-interval": (
        "the ε₀ without a failing state are not an interval: some that fail lie below others that do not"
    ),
}
"""What the numbers may say about each other, by the id of the rule that an annotation names."""


class Contradiction(RuntimeError):
    """A proved state refutes a proved ε₀: one of the two proofs is wrong, and nothing may be reported."""


def require_consistent(
    controlled: ControlledArm, witness: RisingState | None, claimed: Mapping[str, Fraction | None]
) -> None:
    """Raise `Contradiction` if the witness has dV/dt > 0 at an ε₀ that is claimed to be certified."""
    for name, eps0 in claimed.items():
        if witness is None or eps0 is None:
            continue
        if confirms_positive(controlled.arm, controlled.controller, eps0, witness.state):
            raise Contradiction(
                f"{controlled.gains.name}: the {name} ε₀ = {decimal_text(eps0)} is refuted by a proved state"
            )
        if name == "scalar" and eps0 >= witness.eps0:
            raise Contradiction(f"{controlled.gains.name}: the scalar ε₀ is not below a falsified one")


def findings(
    published: Fraction | None, certified: Fraction | None, witness: RisingState | None
) -> list[str]:
    """What the numbers say about each other, one sentence each."""
    result = []
    if published is not None and witness is not None and witness.eps0 < published:
        result.append("published-refuted")
    if published is not None and certified is not None and published * (1 + ROUNDED) <= certified:
        result.append("published-certified")
    if certified is not None and witness is not None and certified > witness.eps0:
        result.append("no-interval")
    return [FINDINGS[rule] for rule in result]
