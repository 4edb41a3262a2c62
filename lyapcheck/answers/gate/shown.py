"""What the gate takes from an arm: numbers of its motors, and bounds of gravity that are shown."""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from functools import lru_cache
from typing import TYPE_CHECKING

from lyapcheck.answers.gate.otherwise import friction_of
from lyapcheck.check.kinds.all_of import AllOf, EveryPart
from lyapcheck.check.kinds.compared import SameHarmonics
from lyapcheck.check.kinds.gravity import GravityBelow, GravityOfPotential
from lyapcheck.check.kinds.inertia import Bisection, HarmonicSizes
from lyapcheck.check.loop.field import size_of
from lyapcheck.check.statement import Ends, Monomials, Proof
from lyapcheck.control.judgement import JudgedStatement, judged_statement, proves
from lyapcheck.robots.dynamics import FEW_JOINTS, TooManyTerms
from lyapcheck.robots.trig import to_terms

if TYPE_CHECKING:
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
    parameters = () if model is None else tuple(number.bounds for number in model.parameters.values())
    return parameters, friction, limits.torque


@dataclass(frozen=True)
class ShownGravity:
    """g and the potential of an arm, and for each joint k_gi, or a larger bound that is shown."""

    gravity: tuple[Monomials, ...]
    potential: Monomials
    k_g: tuple[Fraction, ...]
    proofs: tuple[Proof, ...]
    judged: JudgedStatement


@lru_cache(maxsize=16)
def shown_gravity(model: RobotModel, k_g: tuple[Fraction, ...]) -> ShownGravity | None:
    """Bounds of gravity that the checker accepts; ``None`` where g is too long to be written out."""
    try:
        gravity = tuple(tuple(to_terms(torque)) for torque in model.gravity)
        potential = tuple(to_terms(model.potential))
    except TooManyTerms:
        return None
    ranges = tuple(number.bounds for number in model.parameters.values())
    bounds: list[GravityBelow] = []
    proofs: list[Proof] = []
    for entry, k in zip(gravity, k_g, strict=True):
        own = GravityBelow(model.n, (entry,), ranges, k)
        ways: list[Proof] = [HarmonicSizes(), *([Bisection()] if model.n <= FEW_JOINTS else [])]
        proof = next((way for way in ways if proves(own, way)), None)
        sizes = (size_of(part, ranges) for part in own.entries)
        bounds.append(own if proof is not None else replace(own, high=max(k, *sizes)))
        proofs.append(proof or HarmonicSizes())
    slope = GravityOfPotential(gravity, potential, ranges)
    parts = AllOf((("potential", slope), *((f"g{i}", part) for i, part in enumerate(bounds, 1))))
    judged = judged_statement(parts, [EveryPart((SameHarmonics(), *proofs))])
    return ShownGravity(gravity, potential, tuple(one.high for one in bounds), tuple(proofs), judged)
