"""Quadratic forms in sizes with constants for coefficients, and statements that they are positive.

A symmetric matrix is positive definite if and only if its leading principal minors are positive (Sylvester).
They are polynomials; the pivots of LDLᵀ are their quotients, say the same, and are harder to decide. For one
that depends on a small ε₀ and on s in (0, 1], each minor is asked for every small enough ε₀ at once.

References: ``khalil2002nonlinear``, section 4.1.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction

from lyapcheck.check.expressions.expression import Tree, substitute, variables
from lyapcheck.check.expressions.grammar import require_expressions
from lyapcheck.check.kinds.for_small import ForSmall
from lyapcheck.check.kinds.implies import Implies
from lyapcheck.check.refusal import require
from lyapcheck.check.replay import require_distinct
from lyapcheck.check.statement import Relation, Statement, Variable
from lyapcheck.check.systems.facts import constants_of
from lyapcheck.check.systems.system import System

ZERO: Tree = ("num", "0")
SHARE, DISTANCE = "s", "norm_e"
EPS0 = "eps0"
MAX_SIZES = 4


@dataclass(frozen=True)
class Form:
    """xᵀQx + lᵀy in sizes x and y: the upper half of Q row by row, and l with its sizes."""

    sizes: tuple[str, ...]
    entries: tuple[Tree, ...]
    linear: tuple[tuple[str, Tree], ...] = ()

    def require_well_formed(self) -> None:
        """Refuse sizes given twice, another number of entries, and coefficients that are no expressions."""
        require_distinct("sizes", [*self.sizes, *self.names])
        n = len(self.sizes)
        require(n <= MAX_SIZES, "sizes", n, f"must be at most {MAX_SIZES}")
        require(len(self.entries) == n * (n + 1) // 2, "entries", len(self.entries), "do not fit the sizes")
        require_expressions(self.coefficients)

    @property
    def names(self) -> tuple[str, ...]:
        """The sizes of the linear part."""
        return tuple(name for name, _ in self.linear)

    @property
    def coefficients(self) -> tuple[Tree, ...]:
        """All of them."""
        return (*self.entries, *(tree for _, tree in self.linear))

    @property
    def tree(self) -> Tree:
        """The form as an expression."""
        terms: list[Tree] = [("mul", tree, ("var", name)) for name, tree in self.linear]
        for i, row in enumerate(self.rows):
            for j, entry in enumerate(row):
                if j >= i and entry != ZERO:
                    square: tuple[Tree, ...] = (("pow", ("var", self.sizes[i]), 2),)
                    both = (("var", self.sizes[i]), ("var", self.sizes[j]))
                    terms.append(("mul", *((entry, *square) if i == j else (("num", "2"), entry, *both))))
        return ("add", *terms) if terms else ZERO

    @property
    def rows(self) -> list[list[Tree]]:
        """Q."""
        n, entries = len(self.sizes), iter(self.entries)
        upper = {(i, j): next(entries) for i in range(n) for j in range(i, n)}
        return [[upper[min(i, j), max(i, j)] for j in range(n)] for i in range(n)]

    def positive(self) -> Iterator[tuple[str, Tree]]:
        """What must be positive for the form to be positive definite in its sizes, by name."""
        for k in range(1, len(self.sizes) + 1):
            yield f"minor {k}", determinant([row[:k] for row in self.rows[:k]])
        for name, tree in self.linear:
            yield f"coefficient of {name}", tree


def determinant(rows: list[list[Tree]]) -> Tree:
    """The determinant along the first row."""
    if len(rows) == 1:
        return rows[0][0]
    terms: list[Tree] = []
    for j, entry in enumerate(rows[0]):
        cofactor = ("mul", entry, determinant([[*row[:j], *row[j + 1 :]] for row in rows[1:]]))
        terms.append(("neg", cofactor) if j % 2 else cofactor)
    return ("add", *terms)


def is_positive(system: System, tree: Tree, where: tuple[Relation, ...], small: bool) -> Statement:
    """That an expression in constants, ε₀ and s is positive for all constants that meet the conditions.

    With ``small`` ε₀ may be as small as need be, and is not one of the constants.
    """
    used = variables(tree).union(*(variables(one.gap) for one in where))
    known = constants_of(system)
    if small and EPS0 in used:
        over = tuple(known[name] for name in sorted(used - {EPS0, SHARE}))
        unit = (SHARE,) if SHARE in used else ()
        return ForSmall(EPS0, over, where, Relation(ZERO, "<", tree), unit)
    far = {SHARE: ("div", ("num", "1"), ("add", ("num", "1"), ("var", DISTANCE)))}
    known |= {DISTANCE: Variable(DISTANCE, Fraction(0), strict=False)}
    used = (used - {SHARE}) | ({DISTANCE} if SHARE in used else set())
    over = tuple(known[name] for name in sorted(used))
    return Implies(over, where, Relation(ZERO, "<", substitute(tree, far)))
