"""Implications between polynomials, shown by an identity  (1 + σ)·C = Σ μ_k σ_k H_k.

C is the gap of the conclusion. H_k are gaps of hypotheses, or 1. μ_k are monomials that are never negative.
σ and σ_k are zᵀ L D Lᵀ z: z are monomials, L has ones on its diagonal and 0 above it, and D ≥ 0 is diagonal.
If H_k ≥ 0 and −H_k ≥ 0 are both hypotheses, they are an equation, and μ_k σ_k may be any polynomial.
Monomials are of variables and of sines and cosines; both sides are compared with cos² = 1 − sin².

References: ``putinar1993positive``, ``parrilo2003semidefinite``.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from flint import fmpq, fmpq_mpoly

from lyapcheck.check.expressions.normal_form import product
from lyapcheck.check.expressions.signs import PLUS
from lyapcheck.check.kinds.implies import Exponents, Implies, Monomial, Signs, signs_of
from lyapcheck.check.numbers.polynomials import rational
from lyapcheck.check.refusal import require
from lyapcheck.check.statement import Proof
from lyapcheck.check.verify import Accepted, rule

MOST_MONOMIALS, MOST_DEGREE = 200, 64
"""Of all vectors together, and of a monomial."""


@dataclass(frozen=True)
class Squares:
    """``Σ d_k (z_k + Σ_{i>k} L_ik z_i)²``; ``lower`` has the entries of L below its diagonal, row by row."""

    monomials: tuple[Monomial, ...]
    lower: tuple[tuple[Fraction, ...], ...]
    diagonal: tuple[Fraction, ...]


@dataclass(frozen=True)
class Product:
    """``monomial · squares · gap of a hypothesis``, or without that gap."""

    hypothesis: int | None
    monomial: Monomial
    squares: Squares


@dataclass(frozen=True)
class SumOfSquares(Proof):
    """``(1 + lift) · gap of the conclusion = Σ products``."""

    rule = "sum of squares"
    lift: Squares
    products: tuple[Product, ...]


@rule(Implies, SumOfSquares)
def by_squares(statement: Implies, proof: SumOfSquares) -> Accepted:
    """Soundness: take a point of the domain at which every hypothesis holds, in the generators of ``Signs``.

    There μ_k ≥ 0 by the bounds of its variables, σ_k ≥ 0 as D ≥ 0, and H_k ≥ 0. So (1 + σ)C ≥ 0, and C ≥ 0
    as 1 + σ ≥ 1. If μ_k > 0, H_k > 0 (it is 1, or strict) and σ_k > 0 for one k, then C > 0.
    A term of an equation is 0, whatever its factors are. A sine and a cosine are real numbers with
    cos² + sin² = 1; nothing else is used of them.
    For D > 0, σ_k = 0 only if Lᵀz = 0, that is z = 0. This is so nowhere if a monomial of z is positive, as 1
    is. If z has each variable by itself it can be so at the origin alone, which is no such point if a
    variable is positive or a hypothesis without sines fails there.
    """
    signs = signs_of(statement)
    conclusion, *hypotheses = gaps_of(signs)
    size = sum(len(one.monomials) for one in (proof.lift, *(term.squares for term in proof.products)))
    require(size <= MOST_MONOMIALS, "monomials", size, f"must be at most {MOST_MONOMIALS}")
    rest = product(conclusion, squares_of(signs, proof.lift)[0] + 1)
    strict = False
    for term in proof.products:
        gap, positive, equation = signs.ring.constant(1), True, False
        if term.hypothesis is not None:
            k = term.hypothesis
            require(0 <= k < len(hypotheses), "hypothesis", k, "does not exist")
            gap, positive = hypotheses[k], statement.hypotheses[k].strict
            equation = -gap in hypotheses
        over = exponents_of(signs, term.monomial)
        require(equation or signs.monomial_is(over, False), "monomial", term.monomial, "may be negative")
        value, definite = squares_of(signs, term.squares, equation)
        rest -= product(value * signs.ring.from_dict({over: fmpq(1)}), gap)
        strict = strict or (positive and definite and not equation and signs.monomial_is(over, True))
    require(
        signs.algebra.reduced(rest) == 0, "sum of squares", "", "is not the conclusion: both sides differ"
    )
    require(strict or not statement.conclusion.strict, "conclusion", "", "is not shown to be strict")
    return Accepted("proved", "exact")


def gaps_of(signs: Signs) -> list[fmpq_mpoly]:
    """The gaps of the conclusion and of the hypotheses; refused unless they are polynomials over ℚ."""
    tops, known = [signs.conclusion, *(top for top, _ in signs.hypotheses)], letters_of(signs)
    used = {i for top in tops for exponents in top.monoms() for i, e in enumerate(exponents) if e}
    plain = used <= known and all(bottom.is_constant() for bottom in signs.bottoms)
    require(plain, "relations", "", "are not all between polynomials over the rational numbers")
    return [top / bottom.leading_coefficient() for top, bottom in zip(tops, signs.bottoms, strict=True)]


def letters_of(signs: Signs) -> set[int]:
    """The generators that are variables, sines or cosines: each has a value wherever its argument has one."""
    circular = {i for (name, _), i in signs.algebra.uses.items() if name in ("sin", "cos")}
    return {*range(len(signs.algebra.names))} | circular


def squares_of(signs: Signs, squares: Squares, any_sign: bool = False) -> tuple[fmpq_mpoly, bool]:
    """The sum of squares, weights ≥ 0 or of any sign; whether it is positive wherever all hypotheses hold."""
    n, d, count = len(squares.monomials), squares.diagonal, len(signs.algebra.names)
    require(len(d) == n, "diagonal", len(d), f"must have {n} entries")
    shape = [len(row) for row in squares.lower]
    require(shape == list(range(n)), "lower", shape, "must have rows of 0, 1, 2, … entries, one a monomial")
    fits = any_sign or all(weight >= 0 for weight in d)
    require(fits, "diagonal", min(d, default=0), "must not be negative")
    z = [exponents_of(signs, monomial) for monomial in squares.monomials]
    terms = [signs.ring.from_dict({exponents: fmpq(1)}) for exponents in z]
    result = signs.ring.constant(0)
    for k, weight in enumerate(d):
        below = ((i, squares.lower[i][k]) for i in range(k + 1, n))
        row = sum((terms[i] * rational(entry) for i, entry in below if entry), terms[k])
        result += row * row * rational(weight)
    alone = {e.index(1) for e in z if sum(e) == 1}
    origin: Exponents = (0,) * signs.ring.nvars()
    plain = (one for one in signs.hypotheses if not any(any(e[count:]) for e in one[0].monoms()))
    at_origin = ((gap.to_dict().get(origin, 0), strict) for gap, strict in plain)
    excluded = any(value < 0 or (strict and value == 0) for value, strict in at_origin)
    excluded = excluded or any(own == PLUS for _, own in signs.bounds.values())
    apart = excluded and alone >= set(range(count))
    nowhere_0 = apart or any(signs.monomial_is(e, True) for e in z)
    return result, nowhere_0 and all(weight > 0 for weight in d)


def exponents_of(signs: Signs, monomial: Monomial) -> Exponents:
    """The exponents of a monomial in variables, sines and cosines, of a degree within reach."""
    result = signs.exponents(monomial)
    require(sum(result) <= MOST_DEGREE, "degree", sum(result), f"must be at most {MOST_DEGREE}")
    used = {i for i, e in enumerate(result) if e}
    require(used <= letters_of(signs), "monomial", monomial, "must be of variables, sines and cosines alone")
    return result
