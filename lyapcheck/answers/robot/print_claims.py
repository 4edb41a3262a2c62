"""What a source prints of C and g, compared with M and the potential: claims about the print, not the arm."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

from flint import fmpq_mpoly

from lyapcheck.answers.robot.judged import DecidedProperty, PropertyQuestion, judged
from lyapcheck.answers.robot.properties import PropertyResult
from lyapcheck.check.kinds.coriolis import CoriolisTorque, RateOfMass
from lyapcheck.check.kinds.gravity import GravityOfPotential
from lyapcheck.check.statement import Monomials, Statement
from lyapcheck.claims.moving_arm import ranges_of
from lyapcheck.claims.procedures import propose
from lyapcheck.claims.search_result import SearchResult
from lyapcheck.files.decimals import decimal_text
from lyapcheck.robots import RobotModel, trig
from lyapcheck.search.inertia import mass_of

SAYS = {
    "C torque": "the printed C(q, q̇)q̇ is that of the Christoffel symbols of M",
    "C rates": "Ṁ(q) = C(q, q̇) + C(q, q̇)ᵀ for the printed C",
    "g": "the printed g(q) is the gradient of the potential",
}


def print_claims(model: RobotModel) -> tuple[PropertyResult, ...]:
    """Same torque? Ṁ = C + Cᵀ? Same gravity? Empty where the source prints neither C nor g."""
    return tuple(map(as_property, judged(model, questions(model))))


def as_property(answer: DecidedProperty) -> PropertyResult:
    """A claim about the print with its decision."""
    name = answer.question.id.removeprefix("printed ")
    return PropertyResult(name, answer.question.says, answer.decision, answer.over)


def questions(model: RobotModel) -> list[PropertyQuestion]:
    """The claims as statements, with what the search proposes."""
    return [
        PropertyQuestion(
            f"printed {name}", SAYS[name], statement, _named(model, propose(statement)), statement
        )
        for name, statement in _statements(model).items()
    ]


def _statements(model: RobotModel) -> dict[str, Statement]:
    printed, ranges = model.printed, ranges_of(model)
    result: dict[str, Statement] = {}
    if printed is None:
        return result
    numbers = _numbers(model)
    if printed.coriolis:
        symbols = printed.symbols(model.ring, numbers, model.n)
        # each printed term has exactly one rate, so that nothing is left without
        C = tuple(tuple((*map(_terms, entry), ()) for entry in row) for row in symbols)
        result["C torque"] = CoriolisTorque(mass_of(model), ranges, C)
        result["C rates"] = RateOfMass(mass_of(model), ranges, C)
    if printed.gravity:
        weights = tuple(map(_terms, printed.weights(model.ring, numbers)))
        result["g"] = GravityOfPotential(weights, _terms(model.potential), ranges)
    return result


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


def _numbers(model: RobotModel) -> dict[str, fmpq_mpoly]:
    """The numbers of the arm as polynomials of its ring."""
    known = {name: trig.constant(model.ring, number.value) for name, number in model.numbers.items()}
    return known | dict(zip(model.parameters, model.ring.gens()[2 * model.n :], strict=True))
