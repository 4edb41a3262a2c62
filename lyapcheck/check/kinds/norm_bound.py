"""Bounds ``‖(f(x_1), …, f(x_n))‖ <= c · ‖x‖^k`` for every x in Rⁿ, reduced to one variable.

- k = 0: the worst x repeats one worst entry, so the bound holds if and only if |f(t)| <= c/√n for every t.
- k = 1: put all but one entry to 0 and the bound needs |f(t)| <= c|t|; squared and summed over the entries,
  that also gives it.

References: ``reyes2019family`` (7), (8).
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from lyapcheck.check.expressions.domain import REALS, Comparison, Domain, Interval
from lyapcheck.check.expressions.expression import Tree, substitute
from lyapcheck.check.expressions.grammar import require_expressions
from lyapcheck.check.expressions.text import expression_text
from lyapcheck.check.kinds.constant import Constant
from lyapcheck.check.kinds.for_all import ForAll
from lyapcheck.check.refusal import Refused, require
from lyapcheck.check.replay import Pointwise
from lyapcheck.check.statement import Proof, Relation
from lyapcheck.check.verify import Accepted, all_proved, require_proved, rule


@dataclass(frozen=True)
class NormBound(Pointwise):
    """``‖(f(x_1), …, f(x_n))‖ <= bound · ‖x‖^power`` for every x in Rⁿ; f an expression in the variable x."""

    component: Tree
    n: int
    bound: Tree
    power: int = 0

    def require_well_formed(self) -> None:
        require(1 <= self.n <= MAX_JOINTS, "n", self.n, f"must be from 1 to {MAX_JOINTS}")
        require(self.power in (0, 1), "power", self.power, "must be 0 or 1")
        require_expressions([self.component], ["x"])
        require_expressions([self.bound], [])

    @property
    def ranges(self) -> dict[str, Interval]:
        return dict.fromkeys(entries(self), REALS)

    @property
    def at_points(self) -> tuple[tuple[()], Comparison]:
        return (), vector_relation(self).comparison

    def terms(self) -> list[tuple[Tree, Domain]]:
        return [(self.component, {}), (self.bound, {})]

    def text(self) -> str:
        size = self.bound if self.power == 0 else ("mul", self.bound, ("var", "‖x‖"))
        entry, bound = expression_text(self.component), expression_text(size)
        return f"‖({entry})ᵢ‖ ≤ {bound} for all x in R^{self.n}, x = xᵢ in the i-th entry"


@dataclass(frozen=True)
class Supremum(Proof):
    """The bound is no smaller than √n times the supremum that γ_m or ρ_m is by definition."""

    rule = "supremum"
    numbers: Proof


@dataclass(frozen=True)
class EqualEntries(Proof):
    """All entries equal is the worst case: f(t) <= c/√n and −f(t) <= c/√n for every t."""

    rule = "equal entries"
    above: Proof
    below: Proof


@dataclass(frozen=True)
class OneEntry(Proof):
    """One entry alone is the worst case: |f(t)| <= c|t|, as four inequalities (see the rule)."""

    rule = "one entry"
    parts: tuple[Proof, ...]


MAX_JOINTS = 100
SUPREMUM_OF = {"h": "gamma", "dh": "rho"}
X: Tree = ("var", "x")


@rule(NormBound, Supremum)
def by_supremum(statement: NormBound, proof: Supremum) -> Accepted:
    """Soundness: γ_m = sup |h_m| and ρ_m = sup |h_m'| by definition, so each entry is at most that."""
    relation = supremum_relation(statement)
    if relation is None:
        raise Refused("component", statement.component[0], "is neither h_m(x) nor h_m'(x)")
    return Accepted("proved", require_proved(Constant(relation), proof.numbers, "√n times the supremum"))


@rule(NormBound, EqualEntries)
def by_equal_entries(statement: NormBound, proof: EqualEntries) -> Accepted:
    """Soundness: ‖f(x)‖² is a sum of n squares, each at most c²/n."""
    require(statement.power == 0, "power", statement.power, "must be 0")
    parts = [("one sign", part) for part in uniform_parts(statement)]
    return all_proved(parts, (proof.above, proof.below), "parts")


@rule(NormBound, OneEntry)
def by_one_entry(statement: NormBound, proof: OneEntry) -> Accepted:
    """Soundness: ‖f(x)‖² is a sum of squares f(x_i)² <= c² x_i²."""
    require(statement.power == 1, "power", statement.power, "must be 1")
    return all_proved([("one sign", part) for part in linear_parts(statement)], proof.parts, "parts")


def supremum_relation(statement: NormBound) -> Relation | None:
    """√n times the supremum against the bound; ``None`` unless f is h_m(x) or h_m'(x) itself and k = 0."""
    kind = statement.component[0]
    if kind not in SUPREMUM_OF or statement.component[2] != X or statement.power != 0:
        return None
    own = (SUPREMUM_OF[kind], statement.component[1])
    return Relation(("mul", _root(statement), own), "<=", statement.bound)


def uniform_parts(statement: NormBound) -> tuple[ForAll, ForAll]:
    """f(t) <= c/√n and −f(t) <= c/√n for every t."""
    f, c = statement.component, ("div", statement.bound, _root(statement))
    return ForAll(Relation(f, "<=", c)), ForAll(Relation(("neg", f), "<=", c))


def linear_parts(statement: NormBound) -> tuple[ForAll, ...]:
    """±f(t) <= c t for t >= 0 and ±f(t) <= −c t for t <= 0; f(0) = 0 is among them."""
    f, zero = statement.component, Fraction(0)
    line: Tree = ("mul", statement.bound, X)
    return tuple(
        ForAll(Relation(side, "<=", slope), low, high)
        for low, high, slope in ((zero, None, line), (None, zero, ("neg", line)))
        for side in (f, ("neg", f))
    )


def vector_relation(statement: NormBound) -> Relation:
    """The claim written out in x1, …, xn."""
    names = entries(statement)
    squares = [("pow", substitute(statement.component, {"x": ("var", name)}), 2) for name in names]
    left: Tree = ("sqrt", ("add", *squares))
    if statement.power == 0:
        return Relation(left, "<=", statement.bound)
    size: Tree = ("sqrt", ("add", *(("pow", ("var", name), 2) for name in names)))
    return Relation(left, "<=", ("mul", statement.bound, size))


def entries(statement: NormBound) -> list[str]:
    """The names x1, …, xn."""
    return [f"x{i + 1}" for i in range(statement.n)]


def _root(statement: NormBound) -> Tree:
    return ("sqrt", ("num", str(statement.n)))
