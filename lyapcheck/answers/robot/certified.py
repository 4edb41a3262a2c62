"""Ends of the constants of an arm that certificates show: one at a posture, the other for all angles."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

from lyapcheck.answers.robot.properties import PropertyQuestion, PropertyResult
from lyapcheck.asked import bound_of_constant
from lyapcheck.check.kinds.chain import NoTorque, OfLinks
from lyapcheck.check.kinds.inertia import HarmonicSizes, PostureWitness
from lyapcheck.check.statement import Statement
from lyapcheck.claims.search_result import SearchResult, broken, entries, failing, shown
from lyapcheck.constants import ConstantResult, rounded, witness_of
from lyapcheck.constants.storage import Bound, end_of
from lyapcheck.files.decimals import decimal_text
from lyapcheck.robots import RobotModel
from lyapcheck.robots.dynamics import Chain
from lyapcheck.verdicts import Grade

SYMBOLS = {"lambda_min": "λmin(M)", "lambda_max": "λmax(M)"}


@dataclass(frozen=True)
class CertifiedBounds:
    """Both ends as certificates show them; none where there is none."""

    lower: Fraction | None = None
    upper: Fraction | None = None


def bound_questions(model: RobotModel, constants: Sequence[ConstantResult]) -> Iterator[PropertyQuestion]:
    """Bounds of the constants of an arm at nominal parameters, two a constant at most."""
    nominal = model.fixed()
    for constant in constants:
        found, ends, sign = constant.shown, constant.enclosure, _sign(constant.name)
        if found is not None:
            result = shown(found.proof, found.proof.rule)
            yield _question(nominal, constant.name, found.statement, found.bound, result)
        seen = ends.lower if sign > 0 else ends.upper
        # a little to the safe side of what the posture shows
        inner = max(rounded(seen * (1 - sign * Fraction(1, 10**6)), -sign), Fraction(0))
        if inner > 0 or sign < 0:
            state = [Fraction(x).limit_denominator(10**7) for x in constant.state]
            along = isinstance(found.statement, OfLinks) if found else isinstance(nominal.dynamics, Chain)
            statement = bound_of_constant(constant.name, nominal, inner, along)
            at = PostureWitness(tuple(state[: model.n]), (), tuple(state[model.n :]))
            witness = witness_of(statement, at)
            where = entries(q=witness.q, x=witness.x)
            result = broken(witness, "a posture", failing(where, seen, "≤" if sign > 0 else ">", inner))
            yield _question(nominal, constant.name, statement, inner, result, inside=True)


def _sign(name: str) -> int:
    """1 where the bound for all angles is from above."""
    return -1 if name == "lambda_min" else 1


def certified(answers: Sequence[PropertyResult], positive: bool) -> dict[str, CertifiedBounds]:
    """The ends that the checker has accepted, by the name of the constant.

    Args:
        answers: to ``bound_questions``.
        positive: whether M ≻ 0 is proved: only then ‖M‖ > b, which the refutation of ‖M‖ ≤ b comes to, is a
            statement about λmax(M).
    """
    result: dict[str, CertifiedBounds] = {}
    for answer in answers:
        name, _, side = answer.id.rpartition(".")
        if answer.certificate is None or (name == "lambda_max" and side == "lower" and not positive):
            continue
        statement = answer.certificate.statement
        assert isinstance(statement, Bound)
        value = end_of(statement)
        known = result.get(name, CertifiedBounds())
        result[name] = replace(known, lower=value) if side == "lower" else replace(known, upper=value)
    return result


def _question(
    nominal: RobotModel,
    name: str,
    statement: Statement,
    value: Fraction,
    finding: SearchResult,
    inside: bool = False,
) -> PropertyQuestion:
    """A bound; what is asked is about the arm and the number as it is printed."""
    grade = Grade.EXACT if isinstance(finding.proof, (HarmonicSizes, NoTorque)) else Grade.ENCLOSURE
    printed, above = decimal_text(value), _sign(name) > 0
    words = f"{SYMBOLS.get(name, name)} {'<=' if above else '>'} {printed}"
    asked = bound_of_constant(name, nominal, Fraction(printed), isinstance(statement, OfLinks))
    side = "upper" if above != inside else "lower"
    return PropertyQuestion(f"{name}.{side}", words, statement, replace(finding, grade=grade), asked)
