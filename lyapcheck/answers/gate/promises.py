"""Why the gate may say *accepted*: the promises on a gain set, each of a question and what was judged.

    gravity  |g_i(q)| ≤ k_gi at every posture of every arm in the ranges, judged once an arm
    gains    the conditions on numbers with the same k_gi, judged for each set
    proofs   of stability, which the checks carry themselves

Where no model shows a k_gi it is a premise, and is printed as one.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING

from lyapcheck.answers.gate.stability import friction_of, unknown_function
from lyapcheck.asked import gate_accepted, gravity_kept
from lyapcheck.check.judgement import MAX_ARM
from lyapcheck.check.kinds.all_of import AllOf, EveryPart
from lyapcheck.check.kinds.gate_accepted import TORQUES, GateAccepted, GateParts
from lyapcheck.check.kinds.gravity import GravityBelow, GravityOfPotential, Levers
from lyapcheck.check.kinds.identity import SameHarmonics
from lyapcheck.check.kinds.inertia import Bisection, HarmonicSizes
from lyapcheck.check.statement import Ends, Monomials, Proof
from lyapcheck.control.conditions import CONDITIONS, Check
from lyapcheck.control.gravity import levers
from lyapcheck.control.judgement import JudgedStatement, judged_statement, proves
from lyapcheck.family.base import named
from lyapcheck.files.decimals import decimal_text
from lyapcheck.promise import Promise, promised
from lyapcheck.robots.dynamics import FEW_JOINTS, Chain, TooManyTerms
from lyapcheck.robots.trig import to_terms

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainFile, GainSet
    from lyapcheck.control.limits import Limits
    from lyapcheck.robots import RobotModel

DIGITS = (30, 120, 1000)
"""Of γ, in turn."""
Numbers = tuple[tuple[Ends, ...], tuple[Ends, ...], tuple[Fraction | None, ...]]
"""Ranges of parameters and of viscous friction, and torque limits."""
SAMPLED = "sampled"
"""It counts together with a condition by which no motor saturates."""
NEEDS_GRAVITY = frozenset(("10", *TORQUES))


@dataclass(frozen=True)
class Gravity:
    """Bounds k_gi, N·m, with the promise that the arm keeps them, or the premise that it does."""

    k_g: tuple[Fraction, ...]
    promise: Promise | None = None
    premises: tuple[str, ...] = ()


@dataclass(frozen=True)
class Grounds:
    """What a gain set is accepted on; ``missing`` says why it is not."""

    promises: tuple[Promise, ...] = ()
    premises: tuple[str, ...] = ()
    missing: str = ""


NO_GROUNDS = Grounds()


class GateQuestions:
    """The questions of one gain file about one arm.

    Args:
        file: the gains.
        limits: by which they are judged.
    """

    def __init__(self, file: GainFile, limits: Limits) -> None:
        self.file, self.limits = file, limits
        self._why_not = ""
        self._known: dict[tuple[str, int | None], bool] = {}

    @cached_property
    def gravity(self) -> Gravity | None:
        """The bounds of the limits; ``None`` where what is shown of them answers another question."""
        arm, k_g = self.limits.model, tuple(self.limits.gravity)
        if arm is None:
            return Gravity(k_g)
        shown = shown_gravity(arm, k_g)
        if shown is not None:
            promise, self._why_not = promised(gravity_kept(arm, k_g), shown.judged)
            return None if promise is None else Gravity(k_g, promise)
        premises = (
            f"premise: |g_{i}| ≤ {decimal_text(k)} N·m, which nothing shows" for i, k in enumerate(k_g, 1)
        )
        return Gravity(k_g, None, tuple(premises))

    def grounds(self, gains: GainSet, deciding: Sequence[str], checks: Sequence[Check]) -> Grounds:
        """The promises by which a set that passes its checks is accepted.

        Soundness: ``lyapcheck.promise``.
        """
        proofs = [check.promise for check in checks if check.id in deciding and check.id not in CONDITIONS]
        if None in proofs:
            return Grounds(missing="a proof of stability is about another arm")
        known = tuple(one for one in proofs if one is not None)
        asked = (*deciding, *([] if SAMPLED not in deciding or set(TORQUES) & set(deciding) else ["10i"]))
        numbers = tuple(name for name in CONDITIONS if name in asked)
        if not numbers:
            return Grounds(known)
        if not self._stated(gains):
            # an h that the checker does not know: each check by itself
            own = [check for check in checks if check.id in numbers]
            return Grounds((*known, *(check.own_promise for check in own)))
        gravity = self.gravity if NEEDS_GRAVITY & set(numbers) else Gravity(tuple(self.limits.gravity))
        if gravity is None:
            return Grounds(missing=self._why_not)
        one, missing = self._gains(gains, numbers)
        if one is None:
            return Grounds(missing=missing)
        promises = (one,) if gravity.promise is None else (gravity.promise, one)
        return Grounds((*promises, *known), gravity.premises)

    def _gains(self, gains: GainSet, numbers: tuple[str, ...]) -> tuple[Promise | None, str]:
        statement = stated(gains, self.limits, self._arm, numbers)
        judged = judged_statement(statement, (GateParts((), digits, ()) for digits in DIGITS))
        asked = gate_accepted(gains, self.limits.model, self.file.bounds, statement.k_g, numbers)
        return promised(asked, judged)

    @cached_property
    def _arm(self) -> Numbers:
        return numbers_of(self.limits, self.file.bounds.viscous_min)

    def _stated(self, gains: GainSet) -> bool:
        """The same, once a function."""
        key = gains.family, gains.m
        if key not in self._known:
            self._known[key] = is_stated(gains, self.limits)
        return self._known[key]


# --- The statements behind both.


def numbers_of(limits: Limits, viscous_min: Fraction | None) -> Numbers:
    """What the gate takes from an arm beside its gravity."""
    least = limits.viscous_min or Fraction(0)
    friction: tuple[Ends, ...] = ((least, least),) * limits.n
    model = limits.model
    if model is not None:
        friction = friction_of(model, viscous_min, True) or tuple(b.bounds for b in model.viscous)
    parameters = () if model is None else model.ranges
    return parameters, friction, limits.torque


def is_stated(gains: GainSet, limits: Limits) -> bool:
    """Whether a statement can speak of a set: the checker knows its h."""
    known = named(gains.family, gains.m).bounded and limits.n <= MAX_ARM
    return known and not unknown_function(gains)


def stated(gains: GainSet, limits: Limits, numbers: Numbers, conditions: Sequence[str]) -> GateAccepted:
    """That a set meets conditions on numbers, so far without gravity and stability."""
    parameters, friction, torque = numbers
    return GateAccepted(
        joints=limits.n,
        gravity=(),
        potential=(),
        parameters=parameters,
        k_g=tuple(map(Fraction, limits.gravity)),
        viscous=friction,
        limits=tuple(None if limit is None else Fraction(limit) for limit in torque),
        family=gains.family,
        m=gains.m,
        kp=tuple(map(Fraction, gains.kp)),
        kv=tuple(map(Fraction, gains.kv)),
        conditions=tuple(name for name in CONDITIONS if name in conditions),
        stability=(),
    )


@dataclass(frozen=True)
class ShownGravity:
    """g and the potential of an arm, where they are written out, with what shows bounds of g."""

    gravity: tuple[Monomials, ...]
    potential: Monomials
    proofs: tuple[Proof, ...]
    judged: JudgedStatement


@lru_cache(maxsize=16)
def shown_gravity(model: RobotModel, k_g: tuple[Fraction, ...]) -> ShownGravity | None:
    """What shows these bounds of gravity; ``None`` where nothing does."""
    known = levers(model) or ()
    try:
        gravity = tuple(tuple(to_terms(torque)) for torque in model.gravity)
        potential = tuple(to_terms(model.potential))
    except TooManyTerms:
        return _along_links(model.chain, k_g, known)
    ranges = model.ranges
    bounds = [GravityBelow(model.n, (entry,), ranges, k) for entry, k in zip(gravity, k_g, strict=True)]
    proofs: list[Proof] = []
    for i, bound in enumerate(bounds):
        ways = [HarmonicSizes(), *known[i : i + 1], *([Bisection()] if model.n <= FEW_JOINTS else [])]
        proof = next((way for way in ways if proves(bound, way)), None)
        if proof is None:
            return None
        proofs.append(proof)
    slope = GravityOfPotential(gravity, potential, ranges)
    parts = AllOf((("potential", slope), *((f"g{i}", part) for i, part in enumerate(bounds, 1))))
    judged = judged_statement(parts, [EveryPart((SameHarmonics(), *proofs))])
    return ShownGravity(gravity, potential, tuple(proofs), judged)


def _along_links(
    chain: Chain | None, k_g: tuple[Fraction, ...], known: tuple[Levers, ...]
) -> ShownGravity | None:
    """Of exact links whose g is too long to be written out."""
    if chain is None:
        return None
    from lyapcheck.check.kinds.chain import ChainGravityBelow, OwnLevers

    bounds = [ChainGravityBelow(chain.links, chain.fall, (i,), k) for i, k in enumerate(k_g, 1)]
    parts = AllOf(tuple((f"g{i}", bound) for i, bound in enumerate(bounds, 1)))
    judged = judged_statement(parts, [EveryPart(tuple(OwnLevers(one.along) for one in known))])
    return ShownGravity((), (), (), judged) if judged.shown == "proved" else None
