"""Statements about motions as ``lyapcheck bounds`` finds them, with their proofs.

``propose`` does not search for times and levels: they are found together with the statement. So a few
statements are found here, once; what a generator makes of them is put to the checker with the same proofs.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from types import SimpleNamespace
from typing import Any

from lyapcheck.check.kinds.decreasing import Decreasing
from lyapcheck.check.kinds.phases import StaysWithin
from lyapcheck.check.kinds.settling import Settling
from lyapcheck.check.refusal import Refused
from lyapcheck.check.statement import Ends
from lyapcheck.check.verify import verify
from lyapcheck.claims.procedures.states import controlled_arm_of
from lyapcheck.search.decay.bounds import disturbance_bound, settling_bound
from lyapcheck.verdicts import Verdict

MAX_BOXES = 2_000
COSINE, WHOLE, TURN = (0, 1), (0, 0, 0, 0), (0, 0, 0, 1)
Mass = tuple[tuple[Any, ...], ...]


def _one(constant: str, wave: str = "0") -> Mass:
    """One joint."""
    terms = [((0, 0), Fraction(constant)), (COSINE, Fraction(wave))]
    return ((tuple(term for term in terms if term[1]),),)


def _two(a: str, b: str, c: str) -> Mass:
    """Two links in a plane."""
    part, off = (TURN, Fraction(b) / 2), (WHOLE, Fraction(c))
    first = ((WHOLE, Fraction(a)), (TURN, Fraction(b)))
    return ((first, (off, part)), ((off, part), (off,)))


RANGED: Mass = (((((0, 0, 1), Fraction(1)), ((0, 1, 1), Fraction(1, 4))),),)
"""One joint whose inertia ranges."""
PARAMETERS: tuple[Ends, ...] = ((Fraction(4, 5), Fraction(1)),)


@dataclass(frozen=True)
class Asked:
    """What a bound is asked for; friction is up to ``more`` times as large."""

    mass: Mass
    viscous: str
    family: str
    m: int | None
    kp: str
    kv: str
    start: float
    rate: float = 0.0
    torque: str = "0"
    dry: str = "0"
    more: str = "1"
    parameters: tuple[Ends, ...] = ()


ASKED = (
    Asked(_one("2", "1"), "1", "tanh", None, "20", "1", 0.5),
    Asked(_one("1"), "2", "arctan", None, "10", "1/2", 1.0, rate=0.5, torque="1/10"),
    Asked(_one("3/2", "1/2"), "3/2", "algebraic", None, "15", "1", 0.7, dry="1/5"),
    Asked(_one("1", "1/4"), "1", "hyperbolic", 2, "20", "1", 0.6, rate=1.0),
    Asked(_two("3", "1", "1"), "1", "tanh", None, "20", "1", 0.5, torque="1/20", dry="1/20"),
    Asked(RANGED, "1", "arctan", None, "20", "1", 0.5, more="3/2", parameters=PARAMETERS),
)


UNDISTURBED = tuple(k for k, asked in enumerate(ASKED) if asked.torque == asked.dry == "0")
"""Those of which a settling time in phases is asked."""


@lru_cache(maxsize=2 * len(ASKED))
def found(index: int, in_phases: bool = False) -> tuple[Settling | StaysWithin, Any]:
    """The statement and the proof that the search finds for one of ``ASKED``, at one ε₀ or in phases."""
    asked = ASKED[index]
    n = len(asked.mass)
    each = [Fraction(getattr(asked, name)) for name in ("viscous", "kp", "kv", "torque", "dry")]
    b, kp, kv, torque, dry = ((x,) * n for x in each)
    ranges = tuple((x, x * Fraction(asked.more)) for x in b)
    stated = Decreasing(asked.mass, ranges, asked.parameters, asked.family, asked.m, kp, kv, Fraction(1), ())
    controlled = controlled_arm_of(stated, ranges=bool(asked.parameters))
    start = ((asked.start,) * n, (asked.rate,) * n)
    if any(torque) or any(dry):
        shown = disturbance_bound(controlled, *start, torque, dry, max_boxes=MAX_BOXES).shown
    else:
        shown = settling_bound(controlled, *start, 0.1, in_phases=in_phases, max_boxes=MAX_BOXES).shown
    if shown is None:
        raise LookupError(f"the search finds no bound for {asked}")
    return shown.statement, shown.proof


def decide_settling(statement: Settling | StaysWithin) -> Any:
    """Proved, if the checker takes one of the proofs that were found for as many joints."""
    reason, in_phases = "no proof of this many joints", isinstance(statement, StaysWithin)
    for index, asked in enumerate(ASKED):
        if in_phases and index not in UNDISTURBED:
            continue
        same = bool(asked.parameters) == bool(statement.parameters)
        if same and len(asked.mass) == len(statement.mass) and asked.family == statement.family:
            try:
                statement.require_well_formed()
                verify(statement, found(index, in_phases)[1])
                return SimpleNamespace(
                    verdict=Verdict.PROVED, method="falling levels", reason="", witness=None
                )
            except Refused as refusal:
                reason = str(refusal)
    return SimpleNamespace(verdict=Verdict.UNDECIDED, method="falling levels", reason=reason, witness=None)
