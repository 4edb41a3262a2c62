"""What a source prints of C and g, compared with M and the potential: claims about the print, not the arm."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import product
from typing import Any

from flint import arb, fmpq, fmpq_mpoly

from lyapcheck.check.numbers.enclosure import Enclosure, ball_of
from lyapcheck.files import decimal_text
from lyapcheck.robot_report.properties import Finding, Property
from lyapcheck.robots import RobotModel, trig
from lyapcheck.robots.printed_torques import PrintedTorques
from lyapcheck.verdicts import Grade, Verdict

SAYS = {
    "C torque": "the printed C(q, q̇)q̇ is that of the Christoffel symbols of M",
    "C rates": "Ṁ(q) = C(q, q̇) + C(q, q̇)ᵀ for the printed C",
    "g": "the printed g(q) is the gradient of the potential",
}
_METHOD = "comparison of polynomials in normal form"
Difference = tuple[str, str, fmpq_mpoly, fmpq_mpoly]
"""Where, the rates at which it shows, and the two sides, the printed one first."""


def print_claims(model: RobotModel) -> tuple[Property, ...]:
    """Same torque? Ṁ = C + Cᵀ? Same gravity? Empty where the source prints neither C nor g."""
    printed = model.printed
    if printed is None:
        return ()
    numbers = _numbers(model)
    found: dict[str, Iterator[Difference]] = {}
    if printed.coriolis:
        symbols = printed.symbols(model.ring, numbers, model.n)
        found = {"C torque": _torques(model, symbols), "C rates": _rates(model, symbols)}
    if printed.gravity:
        found["g"] = _weights(model, printed, numbers)
    return tuple(Property(name, SAYS[name], _judged(model, rows)) for name, rows in found.items())


def _torques(model: RobotModel, symbols: Any) -> Iterator[Difference]:
    """c_ijk + c_ikj is the factor of q̇_j q̇_k; twice the factor of q̇_j² where j = k."""
    for i, j, k in product(range(model.n), repeat=3):
        if j <= k:
            here = symbols[i][j][k] + symbols[i][k][j]
            yield f"row {i + 1}", f"w{j + 1} w{k + 1}", here, 2 * model.christoffel[i][j][k]


def _rates(model: RobotModel, symbols: Any) -> Iterator[Difference]:
    for i, j, k in product(range(model.n), repeat=3):
        if i <= j:
            sum_of_both = symbols[i][j][k] + symbols[j][i][k]
            yield f"entry {i + 1}{j + 1}", f"w{k + 1}", sum_of_both, trig.derivative(model.mass[i][j], k)


def _weights(
    model: RobotModel, printed: PrintedTorques, numbers: Mapping[str, fmpq_mpoly]
) -> Iterator[Difference]:
    for i, weight in enumerate(printed.weights(model.ring, numbers)):
        yield f"g{i + 1}", "", weight, model.gravity[i]


def _judged(model: RobotModel, rows: Iterator[Difference]) -> Finding:
    for where, rates, printed, derived in rows:
        if printed != derived:
            factor = f" (the factor of {rates})" if rates else ""
            return Finding(
                Verdict.REFUTED,
                Grade.EXACT,
                _METHOD,
                f"they differ in {where}{factor}",
                _witness(model, printed, derived),
            )
    return Finding(Verdict.PROVED, Grade.EXACT, _METHOD)


def _witness(model: RobotModel, printed: fmpq_mpoly, derived: fmpq_mpoly) -> dict[str, Any]:
    """Angles, and ends of the ranges of uncertain numbers, at which the two sides are certainly apart."""
    for step in range(1, 100):
        angles = [fmpq(step * (2 * i + 1), 2 * i + 2) for i in range(model.n)]
        balls = [arb(angle) for angle in angles]
        ends = {name: number.bounds[step % 2] for name, number in model.parameters.items()}
        chosen = {name: ball_of(end) for name, end in ends.items()}
        values = model.point([x.sin() for x in balls], [x.cos() for x in balls], ball_of, chosen)
        left, right = (trig.evaluate(side, values, ball_of) for side in (printed, derived))
        if not left.overlaps(right):
            sides = [list(Enclosure.from_arb(side).decimals(12)) for side in (left, right)]
            point = {f"q{i + 1}": str(angle) for i, angle in enumerate(angles)}
            told = {name: decimal_text(end) for name, end in ends.items()}
            return {"point": point | told, "left": sides[0], "operator": "=", "right": sides[1]}
    raise ArithmeticError("different trigonometric polynomials agree at a hundred states")


def _numbers(model: RobotModel) -> dict[str, fmpq_mpoly]:
    """The numbers of the arm as polynomials of its ring."""
    known = {name: trig.constant(model.ring, number.value) for name, number in model.numbers.items()}
    return known | dict(zip(model.parameters, model.ring.gens()[2 * model.n :], strict=True))
