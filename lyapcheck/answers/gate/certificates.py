"""What the gate decided, as certificates that ``lyapcheck recheck`` judges again.

One has the verdict on a gain set: the arm with its ranges, its gravity and the gains in one statement,
``GateAccepted``. Against a set that is rejected there is a state at which a motor saturates, else the
condition that fails. There is one for each check as well, which is about numbers alone.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
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
from lyapcheck.check.statement import Proof
from lyapcheck.check.verify import weakest
from lyapcheck.control.conditions import ACCEPTED, REJECTED
from lyapcheck.control.gains import CERTIFICATES, RUNNING
from lyapcheck.control.gravity import steep_postures
from lyapcheck.control.judgement import JudgedStatement, judged_statement
from lyapcheck.errors import argument_error
from lyapcheck.files.decimals import decimal_text
from lyapcheck.files.fields import file_stem
from lyapcheck.promise import Judged, Promise

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
    known = [check.judgement for check in checks if check.judgement is not None]
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
        return one.certificate(about)
    names = [f"{check.id} {Row(result, check).joint}" for check in checks]
    parts = AllOf(tuple((name, outcome.statement) for name, outcome in zip(names, known, strict=True)))
    proofs = [(k, outcome.proof) for k, outcome in enumerate(known) if outcome.proof is not None]
    if result.verdict == REJECTED:
        first, against = next((k, proof) for k, proof in proofs if known[k].verdict == REJECTED)
        return Certificate(about, parts, "refuted", known[first].grade, OnePart(first, against))
    every = EveryPart(tuple(proof for _, proof in proofs))
    return Certificate(about, parts, "proved", weakest(outcome.grade for outcome in known), every)


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
        own = (verdict, *_of_checks(result, checks), *_of_friction(result), *_of_periods(result))
        for one in filter(None, own):
            if made.setdefault(f"{file_stem(one.claim.id)}.json", one) is not one:
                raise argument_error(
                    "--certificates", result.name, "names gain sets of two files", "judge one file at a time"
                )
        statement = None if verdict is None else verdict.statement
        if result.limits.robot and isinstance(statement, GateAccepted) and not statement.gravity:
            granted += [
                f"{result.limits.robot}: no certificate shows |g_{i}| ≤ {decimal_text(k)} N·m for all q"
                for i, k in enumerate(statement.k_g, 1)
            ]
    return made, tuple(dict.fromkeys(granted))


def running_certificates(result: GateResult) -> Iterator[Certificate]:
    """What was decided of the loop as it is run."""
    runs = [check for check in result.checks if check.id in RUNNING]
    return filter(None, (*_of_checks(result, runs), *_of_periods(result)))


Made = Iterator[Certificate | None]
"""``None`` for what was not decided."""


def _of(result: GateResult, name: str, says: str, judged: Judged | None) -> Certificate | None:
    """The certificate of something about a gain set, whose name goes before its own and before the words."""
    if not isinstance(judged, JudgedStatement):
        return None
    own = result.name
    return judged.certificate(About(f"{own}.{name}", f"{own}{says}", result.m, result.limits.n, PROOF))


def _of_checks(result: GateResult, checks: Iterable[Check]) -> Made:
    for check in checks:
        joint = Row(result, check).joint
        name = check.id if check.joint is None else f"{check.id}.{joint}"
        says = f", {joint}: {check.narrow or RULES[check.id].formula}"
        yield _of(result, name, says, check.judgement)


def _of_friction(result: GateResult) -> Made:
    """What is said of dry friction beside the checks."""
    model, gains = result.limits.model, result.gains
    if model is None or not result.explained:
        return
    for i, one in held(gains, model).items():
        yield _of(result, f"held.{model.joints[i]}", f": {HELD}", one)
    if (rest := resting(gains, model, result.limits.room)) is not None:
        yield _of(result, "rest", f": {REST}", rest.shown)


def _of_periods(result: GateResult) -> Made:
    """What is said of other periods than that of the record, which is undecided."""
    for check in result.checks:
        if isinstance(check, SampledCheck) and (check.judgement is None or check.narrow):
            from_rest = None if check.narrow else check.from_rest
            known = {"shown": check.up_to, "from-rest": from_rest, "unstable": check.refuted}
            for name, one in known.items():
                judged = one.shown if isinstance(one, Promise) else one
                yield _of(result, f"sampled.{name}", f": what is {name} of its periods", judged)


def verdict_statement(result: GateResult) -> JudgedStatement | None:
    """What the checker says of the whole verdict; ``None`` where no such statement can be made of it.

    With the gravity of the model; where it does not serve, k_g is a premise.

    Soundness: that of ``lyapcheck.check.verify``.
    """
    limits, gains = result.limits, result.gains
    torques = {"10", *TORQUES} & set(result.deciding)
    if not is_stated(gains, limits) or (torques and None in limits.torque):
        return None
    stability = [
        (known.statement, known.proof)
        for check in result.checks
        if check.id in result.deciding and check.id in CERTIFICATES and (known := check.judgement) is not None
        if known.shown == "proved" and known.proof is not None
    ]
    k_g, bounds = tuple(map(Fraction, limits.gravity)), tuple[Proof, ...]()
    asked = gate_accepted(gains, limits.model, result.file.bounds, k_g, result.deciding)
    asked = replace(asked, stability=tuple(statement for statement, _ in stability))
    shown = None if limits.model is None else shown_gravity(limits.model, k_g)
    if shown is not None and isinstance(shown.statement, AllOf) and isinstance(shown.proof, EveryPart):
        (_, slope), *_ = shown.statement.parts
        if isinstance(slope, GravityOfPotential):  # else g of these links is too long to be written out
            asked = replace(asked, gravity=slope.gravity, potential=slope.potential)
            bounds = shown.proof.parts[1:]
    if result.verdict == REJECTED:
        its = judged_statement(asked, _refutations(result, asked))
        return its if its.shown == "refuted" else None
    proofs = tuple(proof for _, proof in stability)
    its = judged_statement(asked, (GateParts(bounds, digits, proofs) for digits in DIGITS))
    if its.shown != "proved" and proofs and asked.conditions:
        # stability at nominal numbers is no part of a statement over ranges; its check has a certificate
        alone = replace(asked, stability=())
        its = judged_statement(alone, (GateParts(bounds, digits, ()) for digits in DIGITS))
    return its if its.shown == "proved" else None


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
