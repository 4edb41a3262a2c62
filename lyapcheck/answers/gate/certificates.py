"""What the gate decided, as certificates that ``lyapcheck recheck`` judges again.

One has the verdict on a gain set: the arm with its ranges, its gravity and the gains in one statement. There
is one for each check as well, which is about numbers alone.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from lyapcheck.answers.gate.friction import held, resting
from lyapcheck.answers.gate.statement import verdict_statement
from lyapcheck.answers.gate.words import RULES, Row
from lyapcheck.answers.running import SampledCheck
from lyapcheck.certificate import Certificate
from lyapcheck.check.certificate import About
from lyapcheck.check.kinds.all_of import AllOf, EveryPart, OnePart
from lyapcheck.check.kinds.gate_accepted import GateAccepted
from lyapcheck.check.statement import Proof
from lyapcheck.check.verify import weakest
from lyapcheck.control.conditions import ACCEPTED, REJECTED
from lyapcheck.control.gains import RUNNING
from lyapcheck.control.judgement import JudgedStatement
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


@dataclass
class GateCertificates:
    """Certificates by file name, and what of the arm none of them shows, in sentences."""

    certificates: dict[str, Certificate] = field(default_factory=dict)
    granted: list[str] = field(default_factory=list)


def certificates(results: Sequence[GateResult]) -> GateCertificates:
    """The certificates of all checks; one that is undecided has none.

    Raises:
        InputError: gain sets of two files have the same name, and so would their certificates.
    """
    made = GateCertificates()
    for result in results:
        verdict = whole(result)
        checks = (*result.checks, *(() if result.otherwise is None else (result.otherwise,)))
        own = [verdict, *(_certificate(result, check) for check in checks)]
        own += [*_of_friction(result), *_of_periods(result)]
        for one in own:
            if one is not None and made.certificates.setdefault(_file(one), one) is not one:
                raise argument_error(
                    "--certificates", result.name, "names gain sets of two files", "judge one file at a time"
                )
        made.granted += _premises(result, verdict)
    made.granted = list(dict.fromkeys(made.granted))
    return made


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
    rest = resting(gains, model)
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
