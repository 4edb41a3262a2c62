"""Identities: equal normal forms, or a point at which both sides differ.

References: ``geddes1992algorithms``, chapter 3.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from itertools import groupby
from math import prod

from flint import arb

from lyapcheck.check.expressions.domain import REALS, Comparison, Interval
from lyapcheck.check.expressions.expression import Tree, variables
from lyapcheck.check.expressions.grammar import require_expressions
from lyapcheck.check.expressions.normal_form import is_zero
from lyapcheck.check.expressions.text import expression_text
from lyapcheck.check.kinds.inertia import PostureWitness, require_posture
from lyapcheck.check.loop.field import value_at
from lyapcheck.check.numbers.balls import to_arb
from lyapcheck.check.numbers.harmonics import Uncertain
from lyapcheck.check.refusal import require
from lyapcheck.check.replay import Pointwise, domain_of, range_text, require_distinct
from lyapcheck.check.statement import Ends, Proof, Total, Variable
from lyapcheck.check.verify import Accepted, rule


@dataclass(frozen=True)
class Identity(Pointwise):
    """``left = right`` for all values of the variables; those not in ``variables`` are real numbers."""

    left: Tree
    right: Tree
    variables: tuple[Variable, ...] = ()

    def require_well_formed(self) -> None:
        require_expressions((self.left, self.right))
        named = [variable.name for variable in self.variables]
        require_distinct("variables", named)
        for name in named:
            require(name in self.names, "variables", name, "does not occur")

    @property
    def names(self) -> set[str]:
        return variables(self.left) | variables(self.right)

    @property
    def ranges(self) -> dict[str, Interval]:
        """Real numbers, unless it is said otherwise."""
        return dict.fromkeys(self.names, REALS) | domain_of(self.variables)

    @property
    def at_points(self) -> tuple[tuple[()], Comparison]:
        return (), (self.left, "=", self.right)

    def text(self) -> str:
        sides = f"{expression_text(self.left)} = {expression_text(self.right)}"
        free = sorted(self.names - {variable.name for variable in self.variables})
        over = ", ".join(
            filter(None, [f"{', '.join(free)} in R" if free else "", range_text(self.variables)])
        )
        return f"{sides} for all {over}" if over else sides


@dataclass(frozen=True)
class NormalForm(Proof):
    """Both sides have the same normal form over ℚ."""

    rule = "normal form"


@rule(Identity, NormalForm)
def by_normal_form(statement: Identity, proof: NormalForm) -> Accepted:
    """Soundness: equal normal forms are equal functions, wherever both sides are defined."""
    require(is_zero(gap_of(statement)), "normal form", "", "that of the difference is not zero")
    return Accepted("proved", "exact")


def gap_of(statement: Identity) -> Tree:
    """The difference of both sides."""
    return ("add", statement.right, ("neg", statement.left))


# --- Polynomials of an arm that should be the same for all angles and parameters.
#
# The form as a sum of harmonics is unique: two polynomials are one function exactly where it agrees.

Gap = tuple[str, tuple[int, ...], Uncertain]
"""Where, the joints whose rates it has as factors, counted from 0, and the difference of both sides there."""


class Compared(Total):
    """A statement that differences vanish; those of one place are added up, each times its rates."""

    parameters: tuple[Ends, ...]

    @property
    @abstractmethod
    def joints(self) -> int:
        """How many there are."""

    @abstractmethod
    def gaps(self) -> Iterator[Gap]:
        """The differences, those of one place one after the other."""


@dataclass(frozen=True)
class SameHarmonics(Proof):
    """The harmonics of every difference vanish."""

    rule = "comparison of harmonics"


@dataclass(frozen=True)
class MovingPosture(PostureWitness):
    """A posture with rates x at which one difference is not 0, by balls."""

    rule = "moving posture"


@rule(Compared, SameHarmonics)
def by_harmonics(statement: Compared, proof: SameHarmonics) -> Accepted:
    """Soundness: the form as harmonics is unique, and so is that as a polynomial of rates."""
    for place, _, gap in statement.gaps():
        require(not gap, place, "", "is not the same on both sides")
    return Accepted("proved", "exact")


@rule(Compared, MovingPosture)
def by_posture(statement: Compared, proof: MovingPosture) -> Accepted:
    """Soundness: the difference at one place lies in a ball without 0."""
    n = statement.joints
    require_posture(proof, n, statement.parameters)
    require(len(proof.x) == n, "x", len(proof.x), f"must have {n} entries")
    result = any(not value.contains(0) for _, value in differences(statement, proof))
    require(result, "posture", "", "does not show a difference")
    return Accepted("refuted", "enclosure")


def differences(statement: Compared, at: MovingPosture) -> Iterator[tuple[str, arb]]:
    """The difference at each place in balls."""
    for place, rows in groupby(statement.gaps(), key=lambda gap: gap[0]):
        value = arb(0)
        for _, rates, gap in rows:
            rate = prod((at.x[k] for k in rates), start=Fraction(1))
            value += to_arb(rate) * value_at(gap, at.q, at.parameters)
        yield place, value
