"""Polynomials in sines and cosines: bounds from Fourier sums, or angles at which they leave their bounds.

References: ``reyes2019family``, Properties 2.1, 2.2, 2.6, 2.8.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from math import prod

from lyapcheck.check.expressions.domain import Domain
from lyapcheck.check.expressions.expression import Tree, Unsupported, variables
from lyapcheck.check.expressions.grammar import require_expressions
from lyapcheck.check.expressions.normal_form import normal_form
from lyapcheck.check.expressions.text import expression_text, number_text
from lyapcheck.check.numbers.harmonics import harmonics
from lyapcheck.check.numbers.polynomials import root_above
from lyapcheck.check.refusal import Refused, require
from lyapcheck.check.replay import coordinates, require_failure
from lyapcheck.check.statement import OfTerms, Point, Proof, Relation
from lyapcheck.check.verify import Accepted, rule


@dataclass(frozen=True)
class TrigonometricBound(OfTerms):
    """``|f_i(q)| <= bound_i`` for all q, each f_i a polynomial in sines and cosines of q.

    A bound of ``None`` asks only that f_i is bounded.
    """

    entries: tuple[tuple[Tree, Fraction | None], ...]

    def require_well_formed(self) -> None:
        require(len(self.entries) > 0, "entries", "", "must be one or more")
        require_expressions([tree for tree, _ in self.entries])

    def terms(self) -> list[tuple[Tree, Domain]]:
        return [(tree, {}) for tree, _ in self.entries]

    def text(self) -> str:
        parts = [
            f"{expression_text(tree)} is bounded"
            if bound is None
            else f"|{expression_text(tree)}| ≤ {number_text(bound)}"
            for tree, bound in self.entries
        ]
        names = sorted(set().union(*(variables(tree) for tree, _ in self.entries)))
        return f"{'; '.join(parts)}, for all angles{' ' * bool(names)}{', '.join(names)}"


@dataclass(frozen=True)
class FourierBounds(Proof):
    """The mean and the amplitudes of the Fourier sums suffice."""

    rule = "Fourier sums"


@dataclass(frozen=True)
class EntryWitness(Proof):
    """Angles at which one entry leaves its bounds, above (or below, if ``lower``)."""

    rule = "witness of an entry"
    entry: int
    lower: bool
    point: Point
    bits: int = 192


MAX_EXPONENTIALS = 100_000
"""To which an entry may expand."""


@rule(TrigonometricBound, FourierBounds)
def by_bounds(statement: TrigonometricBound, proof: FourierBounds) -> Accepted:
    """Soundness: a Fourier sum lies within the sum of its amplitudes of its mean, and so has some bound."""
    for k, (tree, bound) in enumerate(statement.entries):
        if bound is None:
            require(
                is_bounded(tree), f"entry {k + 1}", "", "must be a polynomial in sines and cosines of angles"
            )
        elif (reached := largest(tree)) > bound:
            raise Refused(f"entry {k + 1}", reached, f"is all that the Fourier sum gives, not {bound}")
    return Accepted("proved", "exact")


@rule(TrigonometricBound, EntryWitness)
def by_entry(statement: TrigonometricBound, proof: EntryWitness) -> Accepted:
    """Soundness: angles at which both sides of what is said of an entry lie in disjoint balls."""
    require(0 <= proof.entry < len(statement.entries), "entry", proof.entry, "does not exist")
    tree, bound = statement.entries[proof.entry]
    if bound is None:
        raise Refused("entry", proof.entry, "has no bound to break")
    statement.require_defined()
    relation = within(tree, bound)[1 if proof.lower else 0]
    require_failure(relation.comparison, coordinates(proof.point, variables(tree)), proof.bits)
    return Accepted("refuted", "enclosure")


def within(tree: Tree, bound: Fraction) -> tuple[Relation, Relation]:
    """f <= bound and −f <= bound."""
    limit = ("num", str(bound))
    return Relation(tree, "<=", limit), Relation(("neg", tree), "<=", limit)


@lru_cache(maxsize=4096)
def extent(tree: Tree) -> tuple[Fraction, Fraction]:
    """The mean of an expression in sin q_i and cos q_i, and by how much it departs from that at most.

    By the normal form in sines and cosines, and the sum of the amplitudes of its harmonics.
    """
    ratio, algebra = normal_form(tree)
    if not ratio.bottom.is_constant():
        raise Unsupported("division by something else than a number")
    n = len(algebra.names)
    places: dict[int | None, int] = {}
    for k, name in enumerate(algebra.names):
        angle = str(algebra.variable(name))
        places |= {algebra.uses.get((kind, angle)): k + shift for kind, shift in (("sin", 0), ("cos", n))}
    terms, count = [], 0
    for exponents, c in ratio.top.to_dict().items():
        powers = [0] * (2 * n)
        for index, power in enumerate(map(int, exponents)):
            if power and index not in places:
                raise Unsupported("what is outside sin and cos of single angles has no bound")
            if power:
                powers[places[index]] = power
        count += prod(1 + power for power in powers)
        if count > MAX_EXPONENTIALS:
            raise Unsupported(f"more than {MAX_EXPONENTIALS} exponentials")
        share = c / ratio.bottom.leading_coefficient()
        terms.append((tuple(powers), Fraction(int(share.p), int(share.q))))
    result = harmonics(terms, n)
    mean = result.pop((0,) * n, (Fraction(0),))[0]
    amplitudes = (root_above(a * a + b * b) if a and b else abs(a + b) for a, b in result.values())
    return mean, sum(amplitudes, Fraction(0))


def largest(tree: Tree) -> Fraction:
    """An upper bound of |f|."""
    mean, swing = extent(tree)
    return abs(mean) + swing


def is_bounded(tree: Tree) -> bool:
    """Whether an expression is plainly a polynomial in sines and cosines of angles: then it is bounded."""
    kind, *rest = tree
    if kind in ("add", "mul", "neg"):
        return all(map(is_bounded, rest))
    if kind == "pow":
        return int(rest[1]) >= 0 and is_bounded(rest[0])
    if kind == "div":
        return is_bounded(rest[0]) and rest[1][0] == "num" and Fraction(rest[1][1]) != 0
    return kind == "num" or (kind in ("sin", "cos") and rest[0][0] == "var")
