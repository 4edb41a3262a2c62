"""Printed numbers: whether a result that a text prints agrees with the numbers it prints beside it.

A number printed as 0.5934 stands for some real in [0.59335, 0.59345]. The printed result agrees if some
choice of inputs within their half units gives a result within its half unit; it disagrees if none does.

References: ``reyes2019family``, Section 4.
"""

from __future__ import annotations

from fractions import Fraction
from itertools import product

from flint import ctx

from lyapcheck.check.expressions.expression import ball, variables
from lyapcheck.check.kinds.constant import (
    Agrees,
    Corners,
    OutsideRounding,
    PrintedInputs,
    at_corner,
    at_printed,
    over_all,
    printed_range,
)
from lyapcheck.check.numbers.polynomials import Enclosure, ball_of
from lyapcheck.claims.search_result import (
    SearchResult,
    between,
    broken,
    failing,
    procedure,
    shown,
    still_open,
)

METHOD = "arithmetic on printed numbers"
BITS = 128


@procedure(Agrees)
def find_agrees(statement: Agrees) -> SearchResult:
    """Compare the formula at the printed inputs, over all their roundings and at the corners of these."""
    target, exact = printed_range(statement.printed), at_printed(statement, BITS)
    computed = {"computed": between(exact, 8), "printed": statement.printed}
    if target.lower <= exact.lower and exact.upper <= target.upper:
        return shown(PrintedInputs(BITS), f"{METHOD}: the printed inputs give it", **computed)
    whole = over_all(statement, BITS)
    if whole.upper < target.lower or whole.lower > target.upper:
        method = f"{METHOD}: no inputs within their rounding give it"
        return broken(OutsideRounding(BITS), method, _witness(statement, exact, target))
    # A corner of the roundings with a result below the printed one, and one above
    all_ends = list(product((0, 1), repeat=len(statement.inputs)))
    values = [(ends, at_corner(statement, ends, BITS)) for ends in all_ends]
    below = next((ends for ends, value in values if value.upper <= target.upper), None)
    above = next((ends for ends, value in values if value.lower >= target.lower), None)
    corners = None if below is None or above is None else Corners(below, above, BITS)
    if corners is not None:
        return shown(corners, f"{METHOD}: within the rounding of the inputs", **computed)
    return still_open(
        "the rounding of the inputs leaves it open; use more digits of the inputs", METHOD, **computed
    )


def _witness(statement: Agrees, exact: Enclosure, target: Enclosure) -> dict[str, object]:
    sides = failing(dict(statement.inputs), exact, "=", target)
    return sides | {"printed": statement.printed} | _needed(statement, target)


def _needed(statement: Agrees, target: Enclosure) -> dict[str, object]:
    """The value of one input that would give the printed result, when the result is proportional to it."""
    name = statement.solve_for
    if name is None:
        return {}
    kind, *factors = statement.formula
    rest = [factor for factor in factors if factor != ("var", name)]
    if kind != "mul" or len(rest) != len(factors) - 1 or any(name in variables(factor) for factor in rest):
        return {}
    at_one = ("mul", ("num", "1"), *rest)
    others = {key: ball_of(Fraction(text)) for key, text in statement.inputs if key != name}
    with ctx.workprec(BITS):
        value = Enclosure.from_arb(target.to_arb() / ball(at_one, others))
    return {f"{name} that gives it": between(value, 6)}
