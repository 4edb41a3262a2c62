"""What statements about the closed loop (11) of every arm in some ranges, under one controller, share.

References: ``reyes2019family`` (6), (11).
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Self

from lyapcheck.check.expressions.text import diagonal_text, number_text
from lyapcheck.check.judgement import TORQUE
from lyapcheck.check.kinds.inertia import Mass, MassAbove, mass_text, require_mass
from lyapcheck.check.loop.closed_loop import ClosedLoop
from lyapcheck.check.loop.states import Arm
from lyapcheck.check.refusal import require
from lyapcheck.check.statement import Ends, Statement


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
        """A square M, one number a joint, no range that is empty."""
        require_mass(self.mass, self.parameters)
        self.require_one_a_joint("viscous", "kp", "kv")
        for low, high in self.viscous:
            require(low <= high, "range", f"[{low}, {high}]", "is empty")

    def require_one_a_joint(self, *subjects: str) -> None:
        """Refuse fields of another length than the number of joints."""
        n = len(self.mass)
        for subject in subjects:
            size = len(getattr(self, subject))
            require(size == n, subject, size, f"must be {n}, one a joint")

    @property
    def granted(self) -> tuple[str, ...]:
        """What ties the numbers to a robot under the controller (6)."""
        exact = all(low == high for low, high in (*self.parameters, *self.viscous))
        arm = (
            "exactly this M(q), C by Christoffel symbols, and exactly this B"
            if exact
            else "this M(q), C by Christoffel symbols, and B, whose ranges hold its numbers, constant in time"
        )
        return f"the robot is (1) with {arm}", TORQUE

    @property
    def mass_positive(self) -> MassAbove:
        """M(q) ≻ 0."""
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
        """The closed loop at one ε₀; see its ``coupling``."""
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

    def gains_text(self, kv: str = ", K_v") -> str:
        """``B = …, h = …, K_p = …, K_v = …``."""
        friction = ", ".join(map(_ends_text, self.viscous))
        function = self.family if self.m is None else f"{self.family}_{self.m}"
        return (
            f"B = diag({friction}), h = {function}, "
            f"K_p = {diagonal_text(self.kp)}{kv} = {diagonal_text(self.kv)}"
        )

    def mass_text(self) -> str:
        """M(q) and the ranges of its parameters."""
        return mass_text(self.mass, self.parameters)


def _ends_text(ends: Ends) -> str:
    low, high = map(number_text, ends)
    return low if low == high else f"{low} … {high}"
