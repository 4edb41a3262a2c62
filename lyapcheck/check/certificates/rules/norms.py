"""Bounds ``‖(f(x_1), …, f(x_n))‖ <= c · ‖x‖^k`` for every x in Rⁿ, reduced to one variable.

- k = 0: the worst x repeats one worst entry, so the bound holds if and only if |f(t)| <= c/√n for every t.
- k = 1: put all but one entry to 0 and the bound needs |f(t)| <= c|t|; squared and summed over the entries,
  that also gives it.

References: ``reyes2019family`` (7), (8).
"""

from __future__ import annotations

from fractions import Fraction

from lyapcheck.check.certificates.proofs import EqualEntries, OneEntry, Supremum, Witness
from lyapcheck.check.certificates.refusal import require
from lyapcheck.check.certificates.rules.replay import coordinates, require_failure
from lyapcheck.check.certificates.statements import Constant, ForAll, NormBound, Relation
from lyapcheck.check.certificates.verify import Accepted, require_proved, rule, weakest
from lyapcheck.check.functions import CONSTANTS, Tree

SUPREMUM_OF = {"h": "gamma", "dh": "rho"}
X: Tree = ("var", "x")


@rule(NormBound, Witness)
def by_witness(statement: NormBound, proof: Witness) -> Accepted:
    """Soundness: a vector, with both norms in disjoint balls."""
    point = coordinates(proof.point, entries(statement))
    require_failure(vector_relation(statement).comparison, point, proof.bits)
    return Accepted("refuted", "enclosure")


@rule(NormBound, Supremum)
def by_supremum(statement: NormBound, proof: Supremum) -> Accepted:
    """Soundness: γ_m = sup |h_m| and ρ_m = sup |h_m'| by definition, so each entry is at most that."""
    relation = supremum_relation(statement)
    if relation is None:
        require(False, "component", statement.component[0], "is neither h_m(x) nor h_m'(x)")
        raise AssertionError
    return Accepted("proved", require_proved(Constant(relation), proof.numbers, "√n times the supremum"))


@rule(NormBound, EqualEntries)
def by_equal_entries(statement: NormBound, proof: EqualEntries) -> Accepted:
    """Soundness: ‖f(x)‖² is a sum of n squares, each at most c²/n."""
    require(statement.power == 0, "power", statement.power, "must be 0")
    pairs = zip(uniform_parts(statement), (proof.above, proof.below), strict=True)
    return Accepted("proved", weakest([require_proved(part, own, "one sign") for part, own in pairs]))


@rule(NormBound, OneEntry)
def by_one_entry(statement: NormBound, proof: OneEntry) -> Accepted:
    """Soundness: ‖f(x)‖² is a sum of squares f(x_i)² <= c² x_i²."""
    require(statement.power == 1, "power", statement.power, "must be 1")
    parts = linear_parts(statement)
    require(len(proof.parts) == len(parts), "parts", len(proof.parts), f"must be {len(parts)}")
    pairs = zip(parts, proof.parts, strict=True)
    return Accepted("proved", weakest([require_proved(part, own, "one sign") for part, own in pairs]))


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
    squares = [("pow", substitute(statement.component, "x", ("var", name)), 2) for name in names]
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


def substitute(tree: Tree, name: str, by: Tree) -> Tree:
    """An expression with a variable replaced by another expression."""
    if tree[0] == "var":
        return by if tree[1] == name else tree
    if tree[0] == "num" or tree[0] in CONSTANTS:
        return tree
    return (tree[0], *(substitute(part, name, by) if isinstance(part, tuple) else part for part in tree[1:]))
