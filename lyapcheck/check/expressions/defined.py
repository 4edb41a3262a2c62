"""The one judgement of definedness: whether every term of an expression has a value over a whole domain.

Expressions are partial functions of real variables:

    a / b     has a value where a and b have one and b ≠ 0
    √a        where a has one and a ≥ 0           ln a         where a > 0
    tan a     where cos a ≠ 0                      asin, acos   where −1 ≤ a ≤ 1
    aᵏ        where a has one, also for k = 0 (then it is 1)
    all else  where its parts have one

so a part without a value leaves the whole without one, whatever it is multiplied by. A statement is true only
if all its terms have values on its whole domain, and false only by a point at which they have.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from fractions import Fraction
from typing import Any

from lyapcheck.check.expressions.domain import Domain
from lyapcheck.check.expressions.expression import LEAVES, Tree, nodes, substitute
from lyapcheck.check.expressions.grammar import Remembered
from lyapcheck.check.expressions.signs import MINUS, ZERO, never
from lyapcheck.check.expressions.text import expression_text
from lyapcheck.check.refusal import Refused

ONE: Tree = ("num", "1")
_DEFINED = Remembered()
Condition = Callable[[list[Any], Domain], bool]


class Undefined(Refused):
    """A term of a statement is not shown to have a value over the whole domain."""


def _within_one(rest: list[Any], domain: Domain) -> bool:
    sides = (("add", ONE, rest[0]), ("add", ONE, ("neg", rest[0])))
    return all(never(side, MINUS, domain) for side in sides)


CONDITIONS: dict[str, Condition] = {
    "div": lambda rest, domain: never(rest[1], ZERO, domain),
    "sqrt": lambda rest, domain: never(rest[0], MINUS, domain),
    "log": lambda rest, domain: never(rest[0], MINUS | ZERO, domain),
    "tan": lambda rest, domain: never(("cos", rest[0]), ZERO, domain),
    "asin": _within_one,
    "acos": _within_one,
}
"""The operations that do not always have a value, each with what gives it one."""


def undefined_term(tree: Tree, domain: Domain) -> Tree | None:
    """A part of an expression that is not shown to have a value over the whole domain; ``None`` if all are.

    Soundness: the conditions of all parts are shown one by one, each on the supposition that what is inside
        of it has a value; what is innermost supposes nothing.
    """
    for node in nodes(tree):
        condition = CONDITIONS.get(node[0])
        if condition is not None and not condition(list(node[1:]), domain):
            return tuple(node)
    return None


def require_defined(tree: Tree, domain: Domain) -> None:
    """Refuse an expression with a part that may be without a value."""
    if tree[0] in LEAVES or (not domain and tree in _DEFINED):
        return
    term = undefined_term(tree, domain)
    if term is None and not domain and len(tree) > 2:
        _DEFINED.add(tree)
    if term is not None:
        raise Undefined(
            "term",
            expression_text(term),
            "is not shown to have a value over the whole domain; restrict the domain, or write it without",
        )


def require_defined_at(tree: Tree, point: Mapping[str, Fraction]) -> None:
    """Refuse a point at which a part of an expression is not shown to have a value."""
    numbers = {name: ("num", str(value)) for name, value in point.items()}
    require_defined(substitute(tree, numbers), {})
