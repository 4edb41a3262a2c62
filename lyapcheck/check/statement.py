"""Statements and proofs as plain data: what all kinds have in common."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction
from typing import ClassVar

from lyapcheck.check.expressions.domain import REALS, Comparison, Domain, Interval
from lyapcheck.check.expressions.expression import Tree
from lyapcheck.check.expressions.signs import require_defined
from lyapcheck.check.refusal import require


@dataclass(frozen=True)
class Relation:
    """``left <= right`` or ``left < right``."""

    left: Tree
    operator: str
    right: Tree

    def __post_init__(self) -> None:
        if self.operator not in ("<=", "<"):
            raise ValueError(f"a relation has <= or <, not {self.operator!r}")

    @property
    def strict(self) -> bool:
        return self.operator == "<"

    @property
    def gap(self) -> Tree:
        """``right - left``, which the relation says is not negative (positive, if strict)."""
        return ("add", self.right, ("neg", self.left))

    @property
    def comparison(self) -> Comparison:
        return self.left, self.operator, self.right

    def __bool__(self) -> bool:
        raise TypeError(
            "a relation is a statement to decide, it has no truth value; write a < b and b < c as two"
        )


class Statement(ABC):
    """Something that is true or false, as plain data; each kind is a subclass in a file of ``kinds``."""

    @abstractmethod
    def require_well_formed(self) -> None:
        """Refuse data that say nothing: unknown operations, undeclared variables, sizes out of reach."""

    @abstractmethod
    def require_defined(self) -> None:
        """Refuse terms that may be without a value somewhere on their domain; see ``Total``, ``OfTerms``."""

    @abstractmethod
    def text(self) -> str:
        """The statement in the words of mathematics, from its data alone."""

    @property
    def granted(self) -> tuple[str, ...]:
        """What a proof of it takes for granted about the world, in sentences."""
        return ()

    @property
    def theorems(self) -> tuple[tuple[str, str], ...]:
        """The theorems that it applies, by name, and where each is proved."""
        return ()

    def decided(self, proof: Proof) -> Iterable[tuple[int, Statement, Proof]]:
        """Which of its parts an accepted proof decides as it decides the whole, each with its own proof."""
        return ()

    def decided_text(self, proof: Proof) -> str:
        """The statement, with what the proof decides of it first."""
        return self.text()

    def attempts(self) -> Iterable[Proof]:
        """Proofs worth trying in turn, where the kind has no search of its own; the rules judge them."""
        return ()


class Total(Statement):
    """A statement of which all terms have values everywhere, or are those of other statements."""

    def require_defined(self) -> None:
        """Nothing to refuse."""


class OfTerms(Statement):
    """A statement with expressions that may be without a value."""

    @abstractmethod
    def terms(self) -> Iterable[tuple[Tree, Domain]]:
        """Its expressions, each with the domain on all of which it must have a value."""

    def require_defined(self) -> None:
        """Refuse terms that may be without a value."""
        for tree, domain in self.terms():
            require_defined(tree, domain)


@dataclass(frozen=True)
class Variable:
    """A real variable; ``low`` bounds it from below, strictly when ``strict``; without it that stays true."""

    name: str
    low: Fraction | None = None
    strict: bool = True

    def __post_init__(self) -> None:
        require(self.strict or self.low is not None, "variable", self.name, "has no end that it could reach")

    @property
    def interval(self) -> Interval:
        return REALS if self.low is None else Interval(self.low, open_low=self.strict)


Point = tuple[tuple[str, Fraction], ...]


class Proof:
    """A proof or a refutation by one rule."""

    rule: ClassVar[str]


@dataclass(frozen=True)
class Witness(Proof):
    """A rational point at which the statement fails, as balls of ``bits`` show."""

    rule = "witness"
    point: Point
    bits: int = 192


class Piece:
    """A part of a proof that is no proof by itself."""

    rule: ClassVar[str]


Ends = tuple[Fraction, Fraction]
Monomials = tuple[tuple[tuple[int, ...], Fraction], ...]
"""Exponents of s1 … sn, c1 … cn and the parameters, with the coefficient."""
Mass = tuple[tuple[Monomials, ...], ...]
"""M(q) by rows."""
