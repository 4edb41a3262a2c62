"""A proof of stability that a search proposes, and whether the checker accepts it."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import TYPE_CHECKING

from lyapcheck.check.kinds.decreasing import LargerKv, PositiveAndDecreasing, statement_of
from lyapcheck.computing import shared_between
from lyapcheck.control.judgement import JudgedStatement, judged_statement

if TYPE_CHECKING:
    from lyapcheck.check.kinds.chain_decreasing import ChainDecreasing
    from lyapcheck.check.kinds.decreasing import BoxTree
    from lyapcheck.check.kinds.inertia import Bisection, Links, MassAtCorners
    from lyapcheck.check.kinds.link_bounds import LinkBounds
    from lyapcheck.check.loop.closed_loop import ClosedLoop
    from lyapcheck.check.statement import Proof, Statement

    RateData = BoxTree | LinkBounds
    """What may show dV/dt < 0."""


@dataclass(frozen=True)
class DecreaseProof:
    """A closed loop, and the data by which M ≻ 0 and dV/dt < 0 are to be shown for it.

    ``kv`` is a larger K_v if the data are for that; ``judged`` is what the checker says, where it was asked.
    """

    loop: ClosedLoop
    by: RateData
    inertia: Bisection | Links | MassAtCorners
    kv: tuple[Fraction, ...] = field(default=(), kw_only=True)
    judged: JudgedStatement | None = field(default=None, kw_only=True, compare=False)

    @property
    def eps0(self) -> Fraction:
        """ε₀."""
        return self.loop.eps0

    @property
    def coupling(self) -> tuple[Fraction, ...]:
        """Diagonal of Λ; empty for (13)."""
        return self.loop.coupling

    @property
    def boxes(self) -> int:
        """How many boxes the data consist of."""
        return self.by.tree.count(".")

    @property
    def statement(self) -> Statement:
        """What is proved."""
        return statement_of(self.loop)

    @property
    def certificate(self) -> Proof:
        """The proof as certificates bring it forward."""
        proof = PositiveAndDecreasing(self.inertia, self.by)
        return LargerKv(self.kv, proof) if self.kv else proof

    def for_smaller(self, kv: tuple[Fraction, ...]) -> DecreaseProof:
        """The same for a K_v of which no entry is larger."""
        return replace(self, loop=replace(self.loop, kv=kv), kv=self.kv or self.loop.kv, judged=None)

    def accepted(self, jobs: int = 1) -> DecreaseProof | None:
        """The same with the verdict of the checker, in so many processes; ``None`` where it refuses."""
        with shared_between(jobs):
            judged = judged_statement(self.statement, [self.certificate])
        return replace(self, judged=judged) if judged.shown == "proved" else None


@dataclass(frozen=True)
class ChainProof:
    """The same of links whose M(q) is too long to be written out, judged by the checker."""

    statement: ChainDecreasing
    certificate: Proof
    judged: JudgedStatement
    coupling: tuple[Fraction, ...] = ()
    boxes: int = 0

    @property
    def eps0(self) -> Fraction:
        """ε₀."""
        return self.statement.eps0
