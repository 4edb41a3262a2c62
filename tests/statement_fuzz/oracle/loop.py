"""The closed loop (11) and V of (13) as functions of the state, and dV/dt by a step along the motion.

    V = ½ yᵀM(q)y + Σ k_pi U(e_i),   y = w − εΛh(e),   ε = ε₀/(1 + ‖e‖)
    q̇ = w,   ė = −w,   Mẇ = K_p h(e) − K_v h(w) − Bw − C(q, w)w

V is analytic along the motion, so that an imaginary step s gives dV/dt = Im V(x + isẋ)/s without a
difference: no rule of differentiation is used but that of sines and cosines in Christoffel symbols.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from types import ModuleType
from typing import Any

import numpy as np
from mpmath import mp

from tests.statement_fuzz.oracle.arm import DIGITS, Place, Rows, accurately, dot, many, solved, times, turned

FARTHEST = 15.0
"""Where sinh is taken no farther in doubles: h_m is 1 beyond, but for its last digits."""


@dataclass(frozen=True)
class Arithmetic:
    """Functions of real and complex numbers, how a fraction is taken, and a step that leaves no trace."""

    functions: ModuleType | Any
    number: Callable[[Any], Any]
    imaginary: Any

    def h(self, family: str, m: int | None, x: Any) -> Any:
        """h(x)."""
        f = self.functions
        if family == "arctan":
            return f.atan(x)
        if family == "algebraic":
            return x / f.sqrt(1 + x * x)
        if family == "tanh" or m == 1:
            return f.tanh(x)
        s, c = f.sinh(x), f.cosh(x)
        return s ** (2 * m - 1) * c / (1 + s ** (2 * m))  # type: ignore[operator]

    def potential(self, family: str, m: int | None, x: Any) -> Any:
        """U(x), U' = h, U(0) = 0."""
        f = self.functions
        if family == "arctan":
            return x * f.atan(x) - f.log(1 + x * x) / 2
        if family == "algebraic":
            return f.sqrt(1 + x * x) - 1
        if family == "tanh" or m == 1:
            return f.log(f.cosh(x))
        return f.log(1 + f.sinh(x) ** (2 * m)) / (2 * m)  # type: ignore[operator]


def _double(x: Any) -> Any:
    return float(x) if isinstance(x, Fraction) else x


DOUBLES = Arithmetic(np, _double, 1e-100j)


def many_digits() -> Arithmetic:
    """In the digits that are in force."""
    return Arithmetic(mp, many, mp.mpc(0, mp.mpf(10) ** -DIGITS))


@dataclass(frozen=True)
class Loop:
    """One arm under one controller; numbers are fractions, or arrays of doubles."""

    mass: Rows
    viscous: Sequence[Any]
    parameters: Sequence[Any]
    family: str
    m: int | None
    kp: Sequence[Any]
    kv: Sequence[Any]
    eps0: Any
    coupling: Sequence[Any] = ()

    def at(self, q: Sequence[Any], of: Arithmetic) -> Place:
        """The place of angles, which may be complex."""
        f = of.functions
        own = [of.number(p) for p in self.parameters]
        return Place([f.sin(a) for a in q], [f.cos(a) for a in q], own, of.number)

    def energy(self, q: Sequence[Any], e: Sequence[Any], w: Sequence[Any], of: Arithmetic) -> Any:
        """V."""
        h = [of.h(self.family, self.m, x) for x in e]
        eps = of.number(self.eps0) / (1 + of.functions.sqrt(dot(e, e)))
        weights = [of.number(c) for c in self.coupling] or [1] * len(e)
        y = [a - eps * c * b for a, b, c in zip(w, h, weights, strict=True)]
        stored = sum(
            of.number(k) * of.potential(self.family, self.m, x) for k, x in zip(self.kp, e, strict=True)
        )
        return dot(y, times(self.at(q, of).matrix(self.mass), y)) / 2 + stored

    def acceleration(self, q: Sequence[Any], e: Sequence[Any], w: Sequence[Any], of: Arithmetic) -> list[Any]:
        """ẇ without disturbance."""
        return solved(self.at(q, of).matrix(self.mass), self.force(q, e, w, of))

    def force(self, q: Sequence[Any], e: Sequence[Any], w: Sequence[Any], of: Arithmetic) -> list[Any]:
        """Mẇ without disturbance."""
        turning = turned(self.at(q, of).symbols(self.mass), w, w)
        far = [np.clip(x, -FARTHEST, FARTHEST) if of is DOUBLES and self.m else x for x in w]
        return [
            of.number(kp) * of.h(self.family, self.m, a)
            - of.number(kv) * of.h(self.family, self.m, near)
            - of.number(b) * x
            - c
            for kp, kv, b, a, near, x, c in zip(
                self.kp, self.kv, self.viscous, e, far, w, turning, strict=True
            )
        ]

    def rate(self, q: Sequence[Any], e: Sequence[Any], w: Sequence[Any], of: Arithmetic) -> Any:
        """dV/dt; e must not be 0."""
        step, a = of.imaginary, self.acceleration(q, e, w, of)
        moved = self.energy(
            [x + step * v for x, v in zip(q, w, strict=True)],
            [x - step * v for x, v in zip(e, w, strict=True)],
            [x + step * v for x, v in zip(w, a, strict=True)],
            of,
        )
        return moved.imag / step.imag

    def exact_rate(self, q: Sequence[Fraction], e: Sequence[Fraction], w: Sequence[Fraction]) -> Any:
        """dV/dt at one state in many digits."""
        of = many_digits()
        return self.rate(*([many(x) for x in part] for part in (q, e, w)), of)


def positive_mass(loop: Loop, q: Sequence[Fraction]) -> bool:
    """Whether M ≻ 0 at one posture, by leading minors in many digits."""
    rows = accurately(q, loop.parameters).matrix(loop.mass)
    return all(mp.det(mp.matrix([row[:k] for row in rows[:k]])) > 0 for k in range(1, len(rows) + 1))
