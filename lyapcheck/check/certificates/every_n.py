"""Identities in vectors and matrices for every n, as statements, and the counterexample to one."""

from __future__ import annotations

from dataclasses import dataclass

from lyapcheck.check.certificates.proofs import Point, Proof
from lyapcheck.check.certificates.statements import Statement
from lyapcheck.check.functions import Tree


@dataclass(frozen=True)
class Given:
    """``A x = equals`` for a matrix A and a vector x."""

    matrix: str
    vector: str
    equals: Tree


@dataclass(frozen=True)
class EveryN(Statement):
    """``left = right`` for every n >= 1, all numbers, vectors of Rⁿ and n × n matrices (``check.letters``).

    ``symmetric`` names the matrices with Aᵀ = A. The letters are functions of time with the derivatives
    ``rates``, pairs (letter, derivative), and ``given`` holds; apart from that they are free.
    """

    left: Tree
    right: Tree
    symmetric: tuple[str, ...] = ()
    rates: tuple[tuple[Tree, Tree], ...] = ()
    given: tuple[Given, ...] = ()


@dataclass(frozen=True)
class EntriesWitness(Proof):
    """An n and rational entries at which all that is given holds and both sides differ."""

    rule = "entries"
    n: int
    point: Point


@dataclass(frozen=True)
class BoundEveryN(Statement):
    """``left <= right`` for every n, from bounds of norms; ``left`` is as in :class:`EveryN`.

    ``norms`` says of some letters together that the product of their norms is at most an expression, the norm
    of a number being its size. ``least`` says that a number is at least an expression. The variables of these
    expressions and of ``right``, and the numbers among the letters of ``left``, are >= 0.
    """

    left: Tree
    right: Tree
    symmetric: tuple[str, ...]
    rates: tuple[tuple[Tree, Tree], ...]
    given: tuple[Given, ...]
    norms: tuple[tuple[tuple[Tree, ...], Tree], ...]
    least: tuple[tuple[Tree, Tree], ...]

    @property
    def terms(self) -> EveryN:
        """``left = 0`` with the same letters."""
        return EveryN(self.left, ("num", "0"), self.symmetric, self.rates, self.given)


@dataclass(frozen=True)
class Cover:
    """How one term is bounded: which ``norms`` cover its letters, or which ``least`` is its one word."""

    norms: tuple[int, ...]
    least: int | None = None


@dataclass(frozen=True)
class CoveredTerms(Proof):
    """A cover of each term of ``left`` in words, the terms in the order of their exponents."""

    rule = "covered terms"
    covers: tuple[Cover, ...]
