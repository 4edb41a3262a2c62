"""The verdict on a gain set as one statement about one arm with its ranges: ``GateAccepted``.

The bound of gravity and the limits of the gains have the same k_g in it. Against a set that is rejected there
is a state at which a motor saturates, else the condition that fails.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING

from lyapcheck.answers.gate.shown import DIGITS, is_stated, numbers_of, shown_gravity, stated
from lyapcheck.check.judgement import LARGEST
from lyapcheck.check.kinds.gate_accepted import (
    TORQUES,
    BrokenCondition,
    GateAccepted,
    GateParts,
    SaturatingState,
)
from lyapcheck.check.numbers.balls import hyperbolic_constants
from lyapcheck.check.statement import Proof, Statement
from lyapcheck.control.conditions import ACCEPTED, REJECTED
from lyapcheck.control.gains import CERTIFICATES
from lyapcheck.control.gravity import steep_postures
from lyapcheck.control.judgement import JudgedStatement, judged_statement

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
    if not is_stated(gains, limits, result.gamma) or (torques and None in limits.torque):
        return None
    numbers = numbers_of(limits, result.file.bounds.viscous_min)
    its = tuple(statement for statement, _ in _stability(result))
    return replace(stated(gains, limits, numbers, result.deciding), stability=its)


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
