"""Printed numbers: whether a result that a text prints agrees with the numbers it prints beside it.

A number printed as 0.5934 stands for some real in [0.59335, 0.59345]. The printed result agrees if some
choice of inputs within their half units gives a result within its half unit; it disagrees if none does.

References: ``reyes2019family``, Section 4.
"""

from __future__ import annotations

from decimal import Decimal
from fractions import Fraction
from itertools import product

from flint import arb, ctx

from lyapcheck.check.enclosure import Enclosure, ball_of
from lyapcheck.check.functions import ball, variables
from lyapcheck.claims.decision import Decision, proved, refuted, undecided
from lyapcheck.claims.statements import Agrees
from lyapcheck.verdicts import Grade

METHOD = "arithmetic on printed numbers"
BITS = 128


def decide_agrees(statement: Agrees) -> Decision:
    """Decide whether a printed number agrees with a formula in printed numbers.

    Soundness: ``proved`` if the exact printed inputs give a result inside the half unit, or if two corners of
    the inputs' ranges lie on either side of it (the formula is continuous there); ``refuted`` if the formula,
    enclosed over the whole ranges, stays outside.
    """
    inputs = {name: Fraction(text) for name, text in statement.inputs}
    ranges = {name: printed_range(text) for name, text in statement.inputs}
    target = printed_range(statement.printed)
    with ctx.workprec(BITS):
        exact = Enclosure.from_arb(ball(statement.formula, {k: ball_of(v) for k, v in inputs.items()}))
        whole = Enclosure.from_arb(ball(statement.formula, {k: r.to_arb() for k, r in ranges.items()}))
        corners = [
            _corner(statement, ends) for ends in product(*((r.lower, r.upper) for r in ranges.values()))
        ]
    computed = {"computed": list(exact.decimals(8)), "printed": statement.printed}
    if target.lower <= exact.lower and exact.upper <= target.upper:
        return proved(Grade.ENCLOSURE, f"{METHOD}: the printed inputs give it", **computed)
    if whole.upper < target.lower or whole.lower > target.upper:
        return refuted(
            Grade.ENCLOSURE,
            f"{METHOD}: no inputs within their rounding give it",
            _witness(statement, exact, target),
        )
    if any(c.upper <= target.upper for c in corners) and any(c.lower >= target.lower for c in corners):
        return proved(Grade.ENCLOSURE, f"{METHOD}: within the rounding of the inputs", **computed)
    return undecided(
        "the rounding of the inputs leaves it open; use more digits of the inputs", METHOD, **computed
    )


def printed_range(text: str) -> Enclosure:
    """The reals that round to a printed number: half a unit of its last place to both sides."""
    value, places = Fraction(text), Decimal(text).as_tuple().exponent
    half = Fraction(10) ** int(places) / 2
    return Enclosure(value - half, value + half)


def _corner(statement: Agrees, ends: tuple[Fraction, ...]) -> Enclosure:
    values: dict[str, arb] = {
        name: ball_of(end) for (name, _), end in zip(statement.inputs, ends, strict=True)
    }
    return Enclosure.from_arb(ball(statement.formula, values))


def _witness(statement: Agrees, exact: Enclosure, target: Enclosure) -> dict[str, object]:
    return {
        "point": dict(statement.inputs),
        "left": list(exact.decimals(12)),
        "operator": "=",
        "right": list(target.decimals(12)),
        "printed": statement.printed,
        **_needed(statement, target),
    }


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
    return {f"{name} that gives it": list(value.decimals(6))}
