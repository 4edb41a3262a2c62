"""dV/dt < 0 at every state but the origin: by a tree of boxes, and against it by one state.

References: ``reyes2019family`` (11), (12), (15).
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Self

from lyapcheck.check.expressions.domain import Domain
from lyapcheck.check.expressions.expression import Tree
from lyapcheck.check.expressions.grammar import require_expressions
from lyapcheck.check.expressions.text import diagonal_text, expression_text, number_text
from lyapcheck.check.judgement import TORQUE
from lyapcheck.check.kinds.constant import Constant
from lyapcheck.check.kinds.inertia import (
    DECREASING,
    MassAbove,
    PostureWitness,
    law_text,
    mass_text,
    require_mass,
    require_one_a_joint,
    require_within,
)
from lyapcheck.check.loop import ClosedLoop, RateProof, at_parameters
from lyapcheck.check.loop.schur import proves
from lyapcheck.check.loop.states import Arm, Controller, State, confirms_positive
from lyapcheck.check.numbers.members import member
from lyapcheck.check.refusal import require
from lyapcheck.check.statement import Ends, Mass, OfTerms, Proof, Relation, Statement, Total
from lyapcheck.check.verify import Accepted, require_proved, rule, verify, weakest

# --- What statements about the closed loop (11) of every arm in some ranges, under one controller, share.
#
# References: ``reyes2019family`` (6), (11).


@dataclass(frozen=True)
class OfLoop(Statement):
    """A statement for every arm in the ranges.

    ``mass`` is M(q), kg·m²; ``viscous`` the range of each diagonal entry of B, N·m·s/rad; ``parameters`` the
    range of each parameter in M; ``family`` and ``m`` name h; ``kp`` and ``kv`` are in N·m.
    """

    mass: Mass
    viscous: tuple[Ends, ...]
    parameters: tuple[Ends, ...]
    family: str
    m: int | None
    kp: tuple[Fraction, ...]
    kv: tuple[Fraction, ...]

    def require_well_formed(self) -> None:
        require_mass(self.mass, self.parameters)
        require_one_a_joint(self, len(self.mass), "viscous", "kp", "kv")
        for low, high in self.viscous:
            require(low <= high, "range", f"[{low}, {high}]", "is empty")

    @property
    def granted(self) -> tuple[str, ...]:
        exact = all(low == high for low, high in (*self.parameters, *self.viscous))
        arm = (
            "exactly this M(q), C by Christoffel symbols, and exactly this B"
            if exact
            else "this M(q), C by Christoffel symbols, and B, whose ranges hold its numbers, constant in time"
        )
        return f"the robot is (1) with {arm}", TORQUE

    @property
    def mass_positive(self) -> MassAbove:
        return MassAbove(self.mass, self.parameters, Fraction(0))

    @classmethod
    def about(cls, loop: ClosedLoop, **rest: Any) -> Self:
        """The statement about the arm and gains of a closed loop, with the other fields of its kind."""
        return cls(
            mass=loop.arm.mass,
            viscous=loop.friction,
            parameters=loop.parameters,
            family=loop.family,
            m=loop.m,
            kp=loop.kp,
            kv=loop.kv,
            **rest,
        )

    def loop(self, eps0: Fraction, coupling: tuple[Fraction, ...] = ()) -> ClosedLoop:
        return ClosedLoop(
            arm=Arm(self.mass, tuple(low for low, _ in self.viscous)),
            family=self.family,
            m=self.m,
            kp=self.kp,
            kv=self.kv,
            eps0=eps0,
            parameters=self.parameters,
            viscous=self.viscous,
            coupling=coupling,
        )

    def law_text(self, beside: str = ", K_v") -> str:
        return law_text(self.viscous, self.family, self.m, self.kp, self.kv, beside)


@dataclass(frozen=True)
class Decreasing(OfLoop, Total):
    """M(q) ≻ 0, and dV/dt < 0 along (11) at every state but the origin, for every arm in the ranges.

    V of (13) is then positive definite and radially unbounded, so that the origin is globally asymptotically
    stable by Lyapunov's direct method (``kelly2005control``, chapter 2).

    ``eps0`` is ε₀; ``coupling`` is the diagonal of Λ in y = w − εΛh, empty for (13).
    """

    eps0: Fraction
    coupling: tuple[Fraction, ...]

    def require_well_formed(self) -> None:
        super().require_well_formed()
        if self.coupling:
            require_one_a_joint(self, len(self.mass), "coupling")

    def text(self) -> str:
        weights = f", Λ = {diagonal_text(self.coupling)}" if self.coupling else ""
        loop = f"{self.law_text()}, ε₀ = {number_text(self.eps0)}{weights}"
        return f"{DECREASING}: for {loop} and {mass_text(self.mass, self.parameters)}"

    @property
    def closed_loop(self) -> ClosedLoop:
        return self.loop(self.eps0, coupling=self.coupling)


@dataclass(frozen=True)
class BoxTree(RateProof):
    """A tree of boxes of (q, e): in preorder, a digit for the side that is cut, a dot for a leaf."""

    rule = "tree of boxes"
    tree: str

    def require_shown(self, loop: ClosedLoop) -> None:
        boxes = f"of {self.tree.count('.')} boxes"
        require(proves(loop, self.tree), "tree", boxes, "has a box on which P ≻ 0 is not shown")


@dataclass(frozen=True)
class PositiveAndDecreasing(Proof):
    """A proof of M(q) ≻ 0, and boxes or bounds by which dV/dt < 0."""

    rule = "M positive and V decreasing"
    inertia: Proof
    rate: RateProof


@dataclass(frozen=True)
class StateWitness(Proof):
    """An arm within the ranges and a state of it at which dV/dt > 0."""

    rule = "state"
    viscous: tuple[Fraction, ...]
    parameters: tuple[Fraction, ...]
    q: tuple[Fraction, ...]
    e: tuple[Fraction, ...]
    w: tuple[Fraction, ...]


@rule(Decreasing, PositiveAndDecreasing)
def by_both(statement: Decreasing, proof: PositiveAndDecreasing) -> Accepted:
    """Soundness: M ≻ 0 by a proof of its own, dV/dt < 0 by ``lyapcheck.check.loop``."""
    positive = require_proved(statement.mass_positive, proof.inertia, "M ≻ 0")
    loop = statement.closed_loop
    require(loop.admissible, "gains, friction or ε₀", "", "K_p, K_v, B, K̃ and ε₀ must be positive, M = Mᵀ")
    proof.rate.require_shown(loop)
    return Accepted("proved", weakest([positive, "enclosure"]))


@rule(Decreasing, PostureWitness)
def by_posture(statement: Decreasing, proof: PostureWitness) -> Accepted:
    """Soundness: M(q) is not positive definite at one posture of one arm within the ranges."""
    result = verify(statement.mass_positive, proof)
    require(result.verdict == "refuted", "M ≻ 0", result.verdict, "must be refuted")
    return result


@rule(Decreasing, StateWitness)
def by_state(statement: Decreasing, proof: StateWitness) -> Accepted:
    """Soundness: dV/dt > 0 in balls, by the plain chain rule, at one state of one arm within the ranges."""
    require(not statement.coupling, "coupling", statement.coupling, "must be empty: the state is of (13)")
    require_within("viscous", proof.viscous, statement.viscous)
    require_within("parameters", proof.parameters, statement.parameters)
    mass = tuple(
        tuple(at_parameters(entry, 2 * len(statement.mass), proof.parameters) for entry in row)
        for row in statement.mass
    )
    controller = Controller(member(statement.family, statement.m), statement.kp, statement.kv)
    state = State(proof.q, proof.e, proof.w)
    rises = confirms_positive(Arm(mass, proof.viscous), controller, statement.eps0, state)
    require(rises, "state", "", "does not show dV/dt > 0")
    return Accepted("refuted", "enclosure")


def statement_of(loop: ClosedLoop) -> Decreasing:
    """What has to be proved of a closed loop."""
    return Decreasing.about(loop, eps0=loop.eps0, coupling=loop.coupling)


# --- Whether a bound on K_v is needed for dV/dt < 0: against it, gains that break it and have dV/dt < 0.
#
# References: ``reyes2019family`` (19).


@dataclass(frozen=True)
class DampingBelow(OfLoop, OfTerms):
    """For all κ > 0 and ε₀ > 0: where dV/dt < 0 at every state but the origin, κ λmax(K_v) < bound.

    The gains are K_p and κ K_v, and V is (13).
    """

    bound: Tree

    def with_damping(self, factor: Fraction, eps0: Fraction) -> Decreasing:
        kv = tuple(factor * k for k in self.kv)
        arm = (self.mass, self.viscous, self.parameters)
        return Decreasing(*arm, self.family, self.m, self.kp, kv, eps0, ())

    def below(self, factor: Fraction) -> Constant:
        return Constant(Relation(("num", str(factor * max(self.kv))), "<", self.bound))

    def require_well_formed(self) -> None:
        super().require_well_formed()
        require(all(k > 0 for k in self.kv), "kv", self.kv, "must be positive")
        require_expressions([self.bound], [])

    def terms(self) -> list[tuple[Tree, Domain]]:
        return [(self.bound, {})]

    def text(self) -> str:
        return (
            "for all κ > 0 and ε₀ > 0: if M(q) ≻ 0 and dV/dt < 0 at every state but the origin, for "
            f"{self.law_text(' and κ K_v with K_v')}, then "
            f"κ·{number_text(max(self.kv))} < {expression_text(self.bound)}; "
            f"{mass_text(self.mass, self.parameters)}"
        )


@dataclass(frozen=True)
class DampingAbove(Proof):
    """κ and ε₀ with dV/dt < 0 everywhere (``decreasing``) while κ λmax(K_v) < bound fails (``numbers``)."""

    rule = "damping above the bound"
    factor: Fraction
    eps0: Fraction
    numbers: Proof
    decreasing: Proof


@rule(DampingBelow, DampingAbove)
def by_gains(statement: DampingBelow, proof: DampingAbove) -> Accepted:
    """Soundness: one κ and one ε₀, with a proof that dV/dt < 0 and a refutation of the bound."""
    require(proof.factor > 0, "factor", proof.factor, "must be positive")
    numbers = verify(statement.below(proof.factor), proof.numbers)
    require(numbers.verdict == "refuted", "bound", numbers.verdict, "must be refuted")
    decreasing = require_proved(
        statement.with_damping(proof.factor, proof.eps0), proof.decreasing, "dV/dt < 0"
    )
    return Accepted("refuted", weakest([numbers.grade, decreasing]))
