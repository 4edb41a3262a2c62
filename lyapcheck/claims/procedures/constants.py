"""Relations between numbers, in balls of growing precision or exactly; numbers as texts print them.

References: ``reyes2019family``, Section 4.
"""

from __future__ import annotations

from fractions import Fraction
from itertools import product

from flint import ctx

from lyapcheck.check.expressions.domain import holds
from lyapcheck.check.expressions.expression import ball, variables
from lyapcheck.check.kinds.constant import (
    Agrees,
    Constant,
    Corners,
    ExactNumbers,
    OutsideRounding,
    PrintedInputs,
    SeparateBalls,
    at_corner,
    at_printed,
    exact_truth,
    over_all,
    printed_range,
)
from lyapcheck.check.numbers.polynomials import Enclosure, ball_of
from lyapcheck.check.statement import Proof, Relation
from lyapcheck.claims.procedures.search import Sides, witness_data
from lyapcheck.claims.search_result import (
    SearchResult,
    between,
    broken,
    failing,
    procedure,
    shown,
    still_open,
)

METHOD = "relation between numbers"
PRECISIONS = (128, 512, 2048)


@procedure(Constant)
def find_constant(statement: Constant) -> SearchResult:
    """Decide a relation between numbers."""
    return find_relation(statement.relation, METHOD)


def find_relation(relation: Relation, method: str) -> SearchResult:
    """Compare both sides exactly, or in balls of growing precision."""
    exact = exact_truth(relation)
    if exact is not None:
        return _found(relation, exact, ExactNumbers(), f"{method}: exact arithmetic", PRECISIONS[0])
    for bits in PRECISIONS:
        with ctx.workprec(bits):
            truth = holds(relation.comparison, {})
        if truth is not None:
            return _found(relation, truth, SeparateBalls(bits), f"{method}: balls of {bits} bits", bits)
    return still_open(
        f"both sides agree to {PRECISIONS[-1]} bits; if they are equal, state it as an identity", method
    )


def _found(relation: Relation, truth: bool, proof: Proof, method: str, bits: int) -> SearchResult:
    if truth:
        return shown(proof, method)
    with ctx.workprec(bits):
        left, right = (Enclosure.from_arb(ball(side)) for side in (relation.left, relation.right))
    return broken(proof, method, witness_data((relation.comparison, {}, Sides(left, right))))


# --- Printed numbers: whether a result that a text prints agrees with the numbers it prints beside it.
#
# A number printed as 0.5934 stands for some real in [0.59335, 0.59345]. The printed result agrees if some
# choice of inputs within their half units gives a result within its half unit; it disagrees if none does.


PRINTED = "arithmetic on printed numbers"
BITS = 128


@procedure(Agrees)
def find_agrees(statement: Agrees) -> SearchResult:
    """Compare the formula at the printed inputs, over all their roundings and at the corners of these."""
    target, exact = printed_range(statement.printed), at_printed(statement, BITS)
    computed = {"computed": between(exact, 8), "printed": statement.printed}
    if target.lower <= exact.lower and exact.upper <= target.upper:
        return shown(PrintedInputs(BITS), f"{PRINTED}: the printed inputs give it", **computed)
    whole = over_all(statement, BITS)
    if whole.upper < target.lower or whole.lower > target.upper:
        method = f"{PRINTED}: no inputs within their rounding give it"
        return broken(OutsideRounding(BITS), method, _sides_printed(statement, exact, target))
    # A corner of the roundings with a result below the printed one, and one above
    all_ends = list(product((0, 1), repeat=len(statement.inputs)))
    values = [(ends, at_corner(statement, ends, BITS)) for ends in all_ends]
    below = next((ends for ends, value in values if value.upper <= target.upper), None)
    above = next((ends for ends, value in values if value.lower >= target.lower), None)
    corners = None if below is None or above is None else Corners(below, above, BITS)
    if corners is not None:
        return shown(corners, f"{PRINTED}: within the rounding of the inputs", **computed)
    return still_open(
        "the rounding of the inputs leaves it open; use more digits of the inputs", PRINTED, **computed
    )


def _sides_printed(statement: Agrees, exact: Enclosure, target: Enclosure) -> dict[str, object]:
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
