"""The verdict on a gain set as one statement about one arm with its ranges: ``GateAccepted``.

The bound of gravity and the limits of the gains have the same k_g in it. Against a set that is rejected there
is a state at which a motor saturates, else the condition that fails.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from functools import lru_cache
from typing import TYPE_CHECKING

from lyapcheck.answers.gate.otherwise import friction_of, unknown_function
from lyapcheck.check.kinds.gate_accepted import (
    TORQUES,
    BrokenCondition,
    GateAccepted,
    GateParts,
    SaturatingState,
)
from lyapcheck.check.kinds.gravity import GravityBelow
from lyapcheck.check.kinds.inertia import Bisection, HarmonicSizes
from lyapcheck.check.limits import LARGEST, MAX_ARM
from lyapcheck.check.loop.field import size_of
from lyapcheck.check.numbers.constants import hyperbolic_constants
from lyapcheck.check.statement import Ends, Monomials, Proof, Statement
from lyapcheck.control.conditions import ACCEPTED, CONDITIONS, REJECTED
from lyapcheck.control.gravity import steep_postures
from lyapcheck.control.judgement import JudgedStatement, judged_statement, proves
from lyapcheck.family.registry import named
from lyapcheck.robots.dynamics import FEW_JOINTS, TooManyTerms
from lyapcheck.robots.trig import to_terms

if TYPE_CHECKING:
    from lyapcheck.answers.gate.judge import GateResult
    from lyapcheck.robots import RobotModel

DIGITS = (30, 120, 1000)
"""Of γ, in turn."""


def verdict_statement(result: GateResult) -> JudgedStatement | None:
    """What the checker says of the whole verdict; ``None`` where no such statement can be made of it.

    Soundness: that of ``lyapcheck.check.verify``.
    """
    statement = _statement(result)
    if statement is None or result.verdict not in (ACCEPTED, REJECTED):
        return None
    if result.verdict == REJECTED:
        known, _ = next(_with_gravity(result, statement))
        its = judged_statement(known, _refutations(result, known))
        return its if its.shown == "refuted" else None
    for known, proofs in _with_gravity(result, statement):
        stability = tuple(proof for _, proof in _stability(result))
        its = judged_statement(known, (GateParts(proofs, digits, stability) for digits in DIGITS))
        if its.shown == "proved":
            return its
    return None


def _statement(result: GateResult) -> GateAccepted | None:
    """The statement, so far without gravity; ``None`` for another γ, or an h unknown to the checker."""
    limits, gains, model = result.limits, result.gains, result.limits.model
    torques = {"10", *TORQUES} & set(result.deciding)
    known = result.gamma == "true" and named(gains.family, gains.m).bounded and not unknown_function(gains)
    if not known or limits.n > MAX_ARM or (torques and None in limits.torque):
        return None
    least = limits.viscous_min or Fraction(0)
    friction: tuple[Ends, ...] = ((least, least),) * limits.n
    if model is not None:
        own = friction_of(model, result.file.bounds.viscous_min, True)
        friction = own or tuple(number.bounds for number in model.viscous)
    return GateAccepted(
        joints=limits.n,
        gravity=(),
        potential=(),
        parameters=() if model is None else tuple(number.bounds for number in model.parameters.values()),
        k_g=tuple(map(Fraction, limits.gravity)),
        viscous=friction,
        limits=tuple(None if limit is None else Fraction(limit) for limit in limits.torque),
        family=gains.family,
        m=gains.m,
        kp=tuple(map(Fraction, gains.kp)),
        kv=tuple(map(Fraction, gains.kv)),
        conditions=tuple(name for name in CONDITIONS if name in result.deciding),
        stability=tuple(its for its, _ in _stability(result)),
    )


def _stability(result: GateResult) -> Iterator[tuple[Statement, Proof]]:
    """The statements about stability that decide, with their proofs."""
    for check in result.checks:
        known, about_arm = check.judgement, check.id in result.deciding and check.id not in CONDITIONS
        if about_arm and known is not None and known.shown == "proved" and known.proof is not None:
            yield known.statement, known.proof


def _with_gravity(
    result: GateResult, statement: GateAccepted
) -> Iterator[tuple[GateAccepted, tuple[Proof, ...]]]:
    """With the gravity of the model and k_g that it keeps; where none serves, with k_g as a premise."""
    if result.limits.model is not None:
        shown = _shown(result.limits.model, statement.k_g)
        if shown is not None:
            gravity, potential, k_g, proofs = shown
            yield replace(statement, gravity=gravity, potential=potential, k_g=k_g), proofs
    yield statement, ()


Shown = tuple[tuple[Monomials, ...], Monomials, tuple[Fraction, ...], tuple[Proof, ...]]


@lru_cache(maxsize=16)
def _shown(model: RobotModel, k_g: tuple[Fraction, ...]) -> Shown | None:
    """g and the potential, and for each joint k_gi, or a larger bound that is shown; with the proofs."""
    try:
        gravity = tuple(tuple(to_terms(torque)) for torque in model.gravity)
        potential = tuple(to_terms(model.potential))
    except TooManyTerms:
        return None
    ranges = tuple(number.bounds for number in model.parameters.values())
    bounds: list[Fraction] = []
    proofs: list[Proof] = []
    for entry, k in zip(gravity, k_g, strict=True):
        own = GravityBelow(model.n, (entry,), ranges, k)
        ways: list[Proof] = [HarmonicSizes(), *([Bisection()] if model.n <= FEW_JOINTS else [])]
        proof = next((way for way in ways if proves(own, way)), None)
        sizes = (size_of(part, ranges) for part in own.entries)
        bounds.append(max(k, *sizes) if proof is None else k)
        proofs.append(proof or HarmonicSizes())
    return gravity, potential, tuple(bounds), tuple(proofs)


def _refutations(result: GateResult, statement: GateAccepted) -> Iterator[Proof]:
    """States that saturate a motor, then conditions that fail."""
    failed = [(check.id, check.joint or 0) for check in result.failures if check.verdict == REJECTED]
    model = result.limits.model
    if statement.gravity and model is not None:
        far = _far(result)
        for i in dict.fromkeys(joint for name, joint in failed if name in TORQUES):
            for turns, parameters in steep_postures(model, i):
                for x in (far, -far):
                    yield SaturatingState(i, turns, parameters, x)
    for name, joint in failed:
        if name in statement.conditions:
            yield from (BrokenCondition(name, joint, digits) for digits in DIGITS)


def _far(result: GateResult) -> Fraction:
    """About where h is largest, rad."""
    gains = result.gains
    if gains.family not in ("hyperbolic", "tanh"):
        return Fraction(LARGEST)
    place = hyperbolic_constants(gains.m or 1).gamma_at
    return Fraction(20) if place is None else Fraction(round(place.lower * 10**12), 10**12)
