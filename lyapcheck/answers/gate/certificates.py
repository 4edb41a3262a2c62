"""What the gate decided, as certificates that ``lyapcheck recheck`` judges again.

One has the verdict on a gain set: the arm with its ranges, its gravity and the gains in one statement,
``GateAccepted``. Against a set that is rejected there is a state at which a motor saturates, else the
condition that fails. There is one for each check as well, which is about numbers alone.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING

from lyapcheck.answers.gate.friction import held, resting
from lyapcheck.answers.gate.promises import DIGITS, is_stated, shown_gravity
from lyapcheck.answers.gate.words import RULES, Row
from lyapcheck.answers.running.sampled import SampledCheck
from lyapcheck.asked import gate_accepted
from lyapcheck.certificate import Certificate
from lyapcheck.check.certificate import About
from lyapcheck.check.judgement import LARGEST
from lyapcheck.check.kinds.all_of import AllOf, EveryPart, OnePart
from lyapcheck.check.kinds.gate_accepted import (
    TORQUES,
    BrokenCondition,
    GateAccepted,
    GateParts,
    SaturatingState,
)
from lyapcheck.check.kinds.gravity import GravityOfPotential
from lyapcheck.check.numbers.balls import hyperbolic_constants
from lyapcheck.check.statement import Proof, Statement
from lyapcheck.check.verify import weakest
from lyapcheck.control.conditions import ACCEPTED, REJECTED
from lyapcheck.control.gains import CERTIFICATES, RUNNING
from lyapcheck.control.gravity import steep_postures
from lyapcheck.control.judgement import JudgedStatement, judged_statement
from lyapcheck.errors import argument_error
from lyapcheck.files.decimals import decimal_text
from lyapcheck.files.fields import file_stem

if TYPE_CHECKING:
    from collections.abc import Sequence

    from lyapcheck.answers.gate.judge import GateResult
    from lyapcheck.control.conditions import Check

PROOF = "gate"
HELD = "k_p ≤ f/γ: dry friction f holds the joint wherever it stops"
REST = "how far from the goal dry friction may leave the joints"


def whole(result: GateResult) -> Certificate | None:
    """The certificate of the verdict on a gain set, of (11); none where it is undecided.

    One statement about the arm, its ranges and the gains where there is one, else one on numbers alone.

    Soundness: every part is a judgement of ``lyapcheck.check.verify``.
    """
    checks = [check for check in result.checks if result.decides(check) and check.id not in RUNNING]
    known = [(check, check.judgement) for check in checks if check.judgement is not None]
    if result.verdict not in (ACCEPTED, REJECTED) or len(known) < len(checks):
        return None  # without a limit there is no statement to certify
    if not checks or (result.verdict == REJECTED and REJECTED not in {check.verdict for check in checks}):
        return None  # what decides has a certificate of its own
    decided = ", ".join(name for name in result.deciding if name not in RUNNING)
    about = About(result.name, f"{result.name}: {decided}", result.m, result.limits.n, PROOF)
    one = verdict_statement(result)
    if one is not None:
        kept = one.statement
        if isinstance(kept, GateAccepted) and not kept.stability and one.shown == "proved":
            about = replace(about, says=f"{result.name}: {', '.join(kept.conditions)}")
        return Certificate(about, one.statement, one.shown, one.grade, _proof(one))
    names = [f"{check.id} {Row(result, check).joint}" for check in checks]
    parts = AllOf(tuple((name, outcome.statement) for name, (_, outcome) in zip(names, known, strict=True)))
    if result.verdict == REJECTED:
        first = next(k for k, (check, _) in enumerate(known) if check.verdict == REJECTED)
        outcome = known[first][1]
        proof = OnePart(first, _proof(outcome))
        return Certificate(about, parts, "refuted", outcome.grade, proof)
    every = EveryPart(tuple(_proof(outcome) for _, outcome in known))
    return Certificate(about, parts, "proved", weakest(outcome.grade for _, outcome in known), every)


def _proof(result: JudgedStatement) -> Proof:
    assert result.proof is not None
    return result.proof


def certificates(results: Sequence[GateResult]) -> tuple[dict[str, Certificate], tuple[str, ...]]:
    """The certificates of all checks by file name, and what of the arm none of them shows, in sentences.

    A check that is undecided has none.

    Raises:
        InputError: gain sets of two files have the same name, and so would their certificates.
    """
    made: dict[str, Certificate] = {}
    granted: list[str] = []
    for result in results:
        verdict = whole(result)
        checks = (*result.checks, *(() if result.otherwise is None else (result.otherwise,)))
        own = [verdict, *(_certificate(result, check) for check in checks)]
        own += [*_of_friction(result), *_of_periods(result)]
        for one in own:
            if one is not None and made.setdefault(_file(one), one) is not one:
                raise argument_error(
                    "--certificates", result.name, "names gain sets of two files", "judge one file at a time"
                )
        granted += _premises(result, verdict)
    return made, tuple(dict.fromkeys(granted))


def _premises(result: GateResult, verdict: Certificate | None) -> Iterator[str]:
    """The bounds of gravity that a verdict of an arm takes for granted."""
    statement = None if verdict is None else verdict.statement
    if result.limits.robot and isinstance(statement, GateAccepted) and not statement.gravity:
        for i, k in enumerate(statement.k_g, 1):
            yield f"{result.limits.robot}: no certificate shows |g_{i}| ≤ {decimal_text(k)} N·m for all q"


def _certificate(result: GateResult, check: Check) -> Certificate | None:
    outcome = check.judgement
    if outcome is None or outcome.proof is None:
        return None
    parts = [result.name, check.id, *([] if check.joint is None else [Row(result, check).joint])]
    narrow = check.narrow if isinstance(check, SampledCheck) else ""
    says = f"{result.name}, {Row(result, check).joint}: {narrow or RULES[check.id].formula}"
    about = About(".".join(parts), says, result.m, result.limits.n, PROOF)
    return Certificate(about, outcome.statement, outcome.shown, outcome.grade, outcome.proof)


def _of_friction(result: GateResult) -> Iterator[Certificate]:
    """What is said of dry friction beside the checks."""
    model, gains = result.limits.model, result.gains
    if model is None or not result.explained:
        return
    rows = [(f"held.{model.joints[i]}", HELD, one) for i, one in held(gains, model).items()]
    rest = resting(gains, model, result.limits.room)
    for name, says, one in [*rows, *([] if rest is None else [("rest", REST, rest.judged)])]:
        if one.proof is not None:
            about = About(f"{gains.name}.{name}", f"{gains.name}: {says}", gains.m, model.n, PROOF)
            yield Certificate(about, one.statement, one.shown, one.grade, one.proof)


def running_certificates(result: GateResult) -> Iterator[Certificate]:
    """What was decided of the loop as it is run."""
    runs = (_certificate(result, check) for check in result.checks if check.id in RUNNING)
    yield from (one for one in runs if one is not None)
    yield from _of_periods(result)


def _of_periods(result: GateResult) -> Iterator[Certificate]:
    """What is said of other periods than that of the record, which is undecided."""
    for check in result.checks:
        if isinstance(check, SampledCheck) and (check.judgement is None or check.narrow):
            promises = (("shown", check.up_to), ("from-rest", None if check.narrow else check.from_rest))
            known = [(name, None if one is None else one.shown) for name, one in promises]
            for name, one in (*known, ("unstable", check.refuted)):
                if isinstance(one, JudgedStatement) and one.proof is not None:
                    says = f"{result.name}: what is {name} of its periods"
                    about = About(f"{result.name}.sampled.{name}", says, result.m, result.limits.n, PROOF)
                    yield Certificate(about, one.statement, one.shown, one.grade, one.proof)


def _file(certificate: Certificate) -> str:
    return f"{file_stem(certificate.claim.id)}.json"


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
    """The statement, so far without gravity; ``None`` for an h unknown to the checker."""
    limits, gains = result.limits, result.gains
    torques = {"10", *TORQUES} & set(result.deciding)
    if not is_stated(gains, limits) or (torques and None in limits.torque):
        return None
    k_g = tuple(map(Fraction, limits.gravity))
    its = tuple(statement for statement, _ in _stability(result))
    asked = gate_accepted(gains, limits.model, result.file.bounds, k_g, result.deciding)
    return replace(asked, stability=its)


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
    if shown is None or not isinstance(shown.statement, AllOf) or not isinstance(shown.proof, EveryPart):
        return statement, ()
    (_, slope), *_ = shown.statement.parts
    if not isinstance(slope, GravityOfPotential):  # g of these links is too long to be written out
        return statement, ()
    return replace(statement, gravity=slope.gravity, potential=slope.potential), shown.proof.parts[1:]


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
