"""The verdict on a gain set as one statement about one arm with its ranges: ``GateAccepted``.

The bound of gravity and the limits of the gains have the same k_g in it. Against a set that is rejected there
is a state at which a motor saturates, else the condition that fails.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING

from lyapcheck.answers.gate.otherwise import unknown_function
from lyapcheck.answers.gate.shown import DIGITS, numbers_of, shown_gravity
from lyapcheck.check.judgement import LARGEST, MAX_ARM
from lyapcheck.check.kinds.gate_accepted import (
    TORQUES,
    BrokenCondition,
    GateAccepted,
    GateParts,
    SaturatingState,
)
from lyapcheck.check.numbers.balls import hyperbolic_constants
from lyapcheck.check.statement import Proof, Statement
from lyapcheck.control.conditions import ACCEPTED, CONDITIONS, REJECTED
from lyapcheck.control.gains import CERTIFICATES
from lyapcheck.control.gravity import steep_postures
from lyapcheck.control.judgement import JudgedStatement, judged_statement
from lyapcheck.family.registry import named

if TYPE_CHECKING:
    from lyapcheck.answers.gate.judge import GateResult


def verdict_statement(result: GateResult) -> JudgedStatement | None:
    """What the checker says of the whole verdict; ``None`` where no such statement can be made of it.

    Soundness: that of ``lyapcheck.check.verify``.
    """
    statement = _statement(result)
    if statement is None or result.verdict not in (ACCEPTED, REJECTED):
        return None
    known, proofs = _with_gravity(result, statement)
    if result.verdict == REJECTED:
        its = judged_statement(known, _refutations(result, known))
        return its if its.shown == "refuted" else None
    stability = tuple(proof for _, proof in _stability(result))
    its = judged_statement(known, (GateParts(proofs, digits, stability) for digits in DIGITS))
    if its.shown != "proved" and stability and known.conditions:
        # stability at nominal numbers is no part of a statement over ranges; its check has a certificate
        alone = replace(known, stability=())
        its = judged_statement(alone, (GateParts(proofs, digits, ()) for digits in DIGITS))
    return its if its.shown == "proved" else None


def _statement(result: GateResult) -> GateAccepted | None:
    """The statement, so far without gravity; ``None`` for another γ, or an h unknown to the checker."""
    limits, gains = result.limits, result.gains
    torques = {"10", *TORQUES} & set(result.deciding)
    known = result.gamma == "true" and named(gains.family, gains.m).bounded and not unknown_function(gains)
    if not known or limits.n > MAX_ARM or (torques and None in limits.torque):
        return None
    parameters, friction, torque = numbers_of(limits, result.file.bounds.viscous_min)
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
        conditions=tuple(name for name in CONDITIONS if name in result.deciding),
        stability=tuple(its for its, _ in _stability(result)),
    )


def _stability(result: GateResult) -> Iterator[tuple[Statement, Proof]]:
    """The statements about stability that decide, with their proofs."""
    for check in result.checks:
        known, about_arm = check.judgement, check.id in result.deciding and check.id in CERTIFICATES
        if about_arm and known is not None and known.shown == "proved" and known.proof is not None:
            yield known.statement, known.proof


def _with_gravity(result: GateResult, statement: GateAccepted) -> tuple[GateAccepted, tuple[Proof, ...]]:
    """With the gravity of the model; where it does not serve, k_g is a premise."""
    model = result.limits.model
    shown = None if model is None else shown_gravity(model, statement.k_g)
    if shown is None:
        return statement, ()
    return replace(statement, gravity=shown.gravity, potential=shown.potential), shown.proofs


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
