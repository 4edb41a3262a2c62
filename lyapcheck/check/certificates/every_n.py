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
