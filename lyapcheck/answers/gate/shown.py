"""What the gate takes from an arm: numbers of its motors, and bounds of gravity that are shown."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import TYPE_CHECKING

from lyapcheck.answers.gate.otherwise import friction_of, unknown_function
from lyapcheck.check.judgement import MAX_ARM
from lyapcheck.check.kinds.all_of import AllOf, EveryPart
from lyapcheck.check.kinds.gate_accepted import GateAccepted
from lyapcheck.check.kinds.gravity import GravityBelow, GravityOfPotential, Levers
from lyapcheck.check.kinds.identity import SameHarmonics
from lyapcheck.check.kinds.inertia import Bisection, HarmonicSizes
from lyapcheck.check.statement import Ends, Monomials, Proof
from lyapcheck.control.conditions import CONDITIONS
from lyapcheck.control.gravity import levers
from lyapcheck.control.judgement import JudgedStatement, judged_statement, proves
from lyapcheck.family.base import named
from lyapcheck.robots.dynamics import FEW_JOINTS, Chain, TooManyTerms
from lyapcheck.robots.trig import to_terms

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet
    from lyapcheck.control.limits import Limits
    from lyapcheck.robots import RobotModel

DIGITS = (30, 120, 1000)
"""Of γ, in turn."""


Numbers = tuple[tuple[Ends, ...], tuple[Ends, ...], tuple[Fraction | None, ...]]
"""Ranges of parameters and of viscous friction, and torque limits."""


def numbers_of(limits: Limits, viscous_min: Fraction | None) -> Numbers:
    """What the gate takes from an arm beside its gravity."""
    least = limits.viscous_min or Fraction(0)
    friction: tuple[Ends, ...] = ((least, least),) * limits.n
    model = limits.model
    if model is not None:
        friction = friction_of(model, viscous_min, True) or tuple(b.bounds for b in model.viscous)
    parameters = () if model is None else model.ranges
    return parameters, friction, limits.torque


def is_stated(gains: GainSet, limits: Limits, gamma: str) -> bool:
    """Whether a statement can speak of a set: the checker knows its h, and γ is the certified one."""
    known = gamma == "true" and named(gains.family, gains.m).bounded and limits.n <= MAX_ARM
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
