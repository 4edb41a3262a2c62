"""Properties 2.1–2.8 of an arm, claims about what its source prints, and bounds of its constants."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

from flint import fmpq_mpoly

from lyapcheck.answers.check import ProofResult
from lyapcheck.asked import bound_of_constant, over_ranges
from lyapcheck.certificate import Certificate
from lyapcheck.check.certificate import About
from lyapcheck.check.kinds.chain import NoTorque, OfLinks
from lyapcheck.check.kinds.coriolis import CoriolisTorque, RateOfMass
from lyapcheck.check.kinds.gravity import GravityOfPotential
from lyapcheck.check.kinds.inertia import HarmonicSizes, PostureWitness
from lyapcheck.check.statement import Monomials, Statement
from lyapcheck.claims.decision import Decision, Judged, decided, undecided
from lyapcheck.claims.handover import Key
from lyapcheck.claims.procedures import propose
from lyapcheck.claims.search_result import SearchResult, broken, entries, failing, shown
from lyapcheck.claims.statements import Missing
from lyapcheck.constants import ConstantResult, rounded, witness_of
from lyapcheck.constants.storage import Bound, end_of
from lyapcheck.files.decimals import decimal_text
from lyapcheck.promise import Promise, promised
from lyapcheck.robots import Number, RobotModel, trig
from lyapcheck.robots.dynamics import Chain
from lyapcheck.robots.printed import Terms, polynomial
from lyapcheck.verdicts import Grade, Verdict

IDS = tuple(f"2.{k}" for k in range(1, 9))
FRICTION = "2.7"
"""The property of B, whose statement has no ranges; the others are about M, C and g."""
_STATE_IT = "state it in an arm file that names this URDF"
SAYS = {
    "C torque": "the printed C(q, q̇)q̇ is that of the Christoffel symbols of M",
    "C rates": "Ṁ(q) = C(q, q̇) + C(q, q̇)ᵀ for the printed C",
    "g": "the printed g(q) is the gradient of the potential",
}


@dataclass(frozen=True)
class PropertyQuestion:
    """A statement in words and as data, with what a search proposes, and what was asked."""

    id: str
    says: str
    statement: Statement
    finding: SearchResult
    asked: Statement


@dataclass(frozen=True)
class PropertyResult:
    """One property with what was found out about it.

    Args:
        over: the promise that it holds for all values of the ranges; none where that is not shown.
        certificate: none where the checker has accepted none.
    """

    id: str
    statement: str
    finding: Decision
    over: Promise | None = None
    certificate: Certificate | None = None

    @property
    def verdict(self) -> Verdict:
        """The verdict."""
        return self.finding.verdict

    @property
    def word(self) -> str:
        """The verdict as answers say it."""
        return self.finding.word


def certificates(model: RobotModel, questions: Iterable[PropertyQuestion]) -> dict[Key, Certificate]:
    """What a fresh process of the checker is to judge."""
    return {
        (row.id, None): Certificate(
            About(row.id, row.says, None, model.n, model.name),
            row.statement,
            row.finding.verdict.value,
            row.finding.grade.label,
            row.finding.proof,
        )
        for row in questions
        if row.finding.proof is not None
    }


def answered(
    model: RobotModel,
    questions: Iterable[PropertyQuestion],
    made: Mapping[Key, Certificate],
    judged: Mapping[Key, Judged],
) -> list[PropertyResult]:
    """The decisions of that process, in order."""
    answers = []
    for row in questions:
        decision = decided(row.finding, judged.get((row.id, None)), row.asked)
        over = about_ranges(row.asked, decision, model.parameters.values(), model)
        accepted = None if decision.certificate is None else made[row.id, None]
        answers.append(PropertyResult(row.id, row.says, decision, over, accepted))
    return answers


def about_ranges(
    stated: Statement | Missing, decision: Decision, numbers: Iterable[Number], model: RobotModel
) -> Promise | None:
    """The promise that what is proved holds for all values of the ranges, where it does.

    Args:
        stated: what was asked.
        decision: on it.
        numbers: of the arm that it is about.
        model: the arm.
    """
    if decision.promise is None or not isinstance(stated, Statement):
        return None
    if not any(number.ranged for number in numbers):
        return decision.promise
    asked = over_ranges(stated, model)
    return None if asked is None else promised(asked, decision.promise.shown)[0]


def properties(
    model: RobotModel, result: ProofResult
) -> tuple[tuple[PropertyResult, ...], Mapping[str, Certificate]]:
    """The eight properties as they are decided, and their certificates by file name.

    Friction that nobody has stated is not 0: then 2.7 is open, whatever follows for 0.
    """
    rows = {}
    for row in result.claims:
        numbers = model.viscous if row.id == FRICTION else model.parameters.values()
        over = about_ranges(row.stated, row.decision, numbers, model)
        rows[row.id] = PropertyResult(row.id, row.statement, row.decision, over)
    made = dict(result.certificates)
    missing = _without_friction(model, assumed=True)
    if missing:
        finding = undecided(f"no viscous friction is known of {missing}; {_STATE_IT}", "reading of the file")
        rows[FRICTION] = PropertyResult(FRICTION, rows[FRICTION].statement, finding)
        made.pop("2.7.json", None)
    elif none := _without_friction(model, assumed=False):
        reason = f"the viscous friction of {none} is 0 in the file; where that means unknown, {_STATE_IT}"
        rows[FRICTION] = replace(rows[FRICTION], finding=replace(rows[FRICTION].finding, reason=reason))
    return tuple(rows[name] for name in IDS), made


def _without_friction(model: RobotModel, assumed: bool) -> str:
    """The joints whose viscous friction is 0 because nobody stated it, or because the file says so."""
    rows = zip(model.joints, model.viscous, strict=True)
    return ", ".join(joint for joint, number in rows if number.value == 0 and number.assumed is assumed)


def print_questions(model: RobotModel) -> Iterator[PropertyQuestion]:
    """Same torque? Ṁ = C + Cᵀ? Same gravity? Nothing where the source prints neither C nor g."""
    printed, ranges = model.printed, model.ranges
    stated: dict[str, Statement] = {}
    if printed is None:
        return
    # the numbers of the arm as polynomials of its ring
    numbers = {name: trig.constant(model.ring, number.value) for name, number in model.numbers.items()}
    numbers |= dict(zip(model.parameters, model.ring.gens()[2 * model.n :], strict=True))
    joints = range(model.n)

    def terms(own: Terms) -> Monomials:
        return _terms(polynomial(own, model.ring, numbers))

    if printed.coriolis:
        # each printed term has exactly one rate, so that nothing is left without
        C = tuple(
            tuple((*(terms(printed.coriolis.get((i, j, k), ())) for k in joints), ()) for j in joints)
            for i in joints
        )
        stated["C torque"] = CoriolisTorque(model.mass_terms, ranges, C)
        stated["C rates"] = RateOfMass(model.mass_terms, ranges, C)
    if printed.gravity:
        weights = tuple(map(terms, printed.gravity))
        stated["g"] = GravityOfPotential(weights, _terms(model.potential), ranges)
    for name, statement in stated.items():
        finding = _named(model, propose(statement))
        yield PropertyQuestion(f"printed {name}", SAYS[name], statement, finding, statement)


def _terms(polynomial: fmpq_mpoly) -> Monomials:
    return tuple(trig.to_terms(polynomial))


def _named(model: RobotModel, finding: SearchResult) -> SearchResult:
    """The uncertain numbers of a witness by their names."""
    if finding.witness is None:
        return finding
    names = {f"p{k + 1}": name for k, name in enumerate(model.parameters)}
    point = {
        names.get(name, name): decimal_text(Fraction(value)) if name in names else value
        for name, value in finding.witness["point"].items()
    }
    return replace(finding, witness={**finding.witness, "point": point})


# --- Ends of the constants that certificates show: one at a posture, the other for all angles.


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
