"""V, dV/dt and the motion at a state of (11), in any arithmetic: arrays, graphs, or a loop being written.

What they are made of besides the arm and the family comes from `lyapcheck.derive`.

References: (6), (11), (12), (15) of ``reyes2019family``.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from lyapcheck.derive.evaluate import function, values_of
from lyapcheck.family.arithmetic import Arithmetic
from lyapcheck.family.base import Forms
from lyapcheck.robots.chain import solve_definite
from lyapcheck.robots.dynamics import ArmAtAngles
from lyapcheck.robots.plant import Plant

Vector = Sequence[Any]
FormsAt = Callable[[Any], Forms]


@dataclass(frozen=True, eq=False)
class AtState:
    """One state, or columns of them, with its controller.

    Args:
        model: the arm.
        of: the arithmetic.
        forms: h, h' and U at a value of it.
        q: n angles, rad.
        e: q_d − q, rad.
        w: q̇, rad/s.
        kp: diagonal of K_p, N·m.
        kv: diagonal of K_v, N·m.
        viscous: diagonal of B, N·m·s/rad.
        uncertain: parameters of the arm by name; nominal where missing.
    """

    model: Plant
    of: Arithmetic
    forms: FormsAt
    q: Vector
    e: Vector
    w: Vector
    kp: Vector
    kv: Vector
    viscous: Vector
    uncertain: Mapping[str, Any] | None = None

    def value(self, eps0: Any) -> Any:
        """V of (12), J."""
        U = {"U": [x.potential for x in self.at_e], "w": self.w, "kp": self.kp}
        return self._of("value", U | {"M": self.mass, "h": self.h}, epsilon_0=eps0)[0]

    def coefficients(self) -> list[Any]:
        """a₀, a₁, a₂ of dV/dt = −a₀ + a₁ ε₀ + a₂ ε₀², W."""
        gains = {"kp": self.kp, "kv": self.kv, "b": self.viscous, "g": self.hw, "w": self.w}
        return self._of("rate", self._terms | gains)

    def rate(self, eps0: Any) -> Any:
        """dV/dt along (11), W."""
        a0, a1, a2 = self.coefficients()
        return (a1 + a2 * eps0) * eps0 - a0

    def fast(self, scales: Vector | None = None) -> list[list[Any]]:
        """F, (n, n), with a₁ = wᵀ F w + …: what decides for fast states; not symmetric.

        It is linear in h and h' together; with ``scales`` these are Λh and Λh', Λ their diagonal.
        """
        known, n = self._terms, self.model.n
        if scales is not None:
            h, d = ([k * x for k, x in zip(scales, known[name], strict=True)] for name in "hd")
            known = known | {"h": h, "d": d, "G": self.arm.coriolis(h)}
        entries = self._of("fast", known)
        return [entries[i * n : (i + 1) * n] for i in range(n)]

    def slope(self) -> list[Any]:
        """∂a₂/∂w, n."""
        return self._of("slope", self._terms)

    def acceleration(self) -> list[Any]:
        """ẇ = M⁻¹ (K_p h − K_v h(w) − B w − C(q, w) w), rad/s²."""
        gains = {"kp": self.kp, "kv": self.kv, "b": self.viscous, "h": self.h, "g": self.hw, "w": self.w}
        names = self.of.names
        C = [names(row) for row in self.arm.coriolis(self.w)]
        return solve_definite(self.mass, names(self._of("force", gains | {"C": C})), names)

    def damping(self) -> Any:
        """wᵀBw + wᵀK_v h(w), what the energy loses, W."""
        rows = zip(self.viscous, self.kv, self.w, self.hw, strict=True)
        return total(b * w * w + k * w * f for b, k, w, f in rows)

    def torque(self) -> list[Any]:
        """τ = K_p h − K_v h(w) + g, N·m."""
        rows = zip(self.kp, self.h, self.kv, self.hw, self.arm.gravity(), strict=True)
        return [kp * f - kv * v + g for kp, f, kv, v, g in rows]

    def _of(self, name: str, letters: Mapping[str, Any], **numbers: Any) -> list[Any]:
        values = {"s": self.near} | numbers
        for letter, known in letters.items():
            values |= values_of(letter, known)
        return function(self.model.n, name)(self.of.names, **values)

    @cached_property
    def _terms(self) -> dict[str, Any]:
        G = [self.of.names(row) for row in self.arm.coriolis(self.h)]
        return {"M": self.mass, "G": G, "h": self.h, "d": [x.dh for x in self.at_e], "n": self.unit}

    @cached_property
    def arm(self) -> ArmAtAngles:
        """The arm at these angles."""
        of = self.of
        turns = [of.sin(x) for x in self.q], [of.cos(x) for x in self.q]
        return self.model.at(*turns, of.lift, self.uncertain, of.name)

    @cached_property
    def mass(self) -> list[list[Any]]:
        """M(q), kg·m²."""
        rows, n = self.arm.mass(), self.model.n
        upper = [(i, j) for i in range(n) for j in range(i, n)]
        named = dict(zip(upper, self.of.names([rows[i][j] for i, j in upper]), strict=True))
        return [[named[min(i, j), max(i, j)] for j in range(n)] for i in range(n)]

    @cached_property
    def at_e(self) -> list[Forms]:
        """The family at e."""
        return [self.forms(x) for x in self.e]

    @cached_property
    def h(self) -> list[Any]:
        """h(e)."""
        return [x.h for x in self.at_e]

    @cached_property
    def hw(self) -> list[Any]:
        """h(w)."""
        return [self.forms(x).h for x in self.w]

    @cached_property
    def r(self) -> Any:
        """‖e‖."""
        return self.of.sqrt(total(x * x for x in self.e))

    @cached_property
    def near(self) -> Any:
        """1/(1 + ‖e‖)."""
        return self.of.name(1.0 / (1.0 + self.r))

    @cached_property
    def unit(self) -> list[Any]:
        """e/‖e‖, and 0 at e = 0."""
        inverse = self.of.name(1.0 / self.of.where(self.r > 0.0, self.r, 1.0))
        return self.of.names([x * inverse for x in self.e])


def total(terms: Any) -> Any:
    """The sum of one term or more."""
    first, *rest = terms
    for term in rest:
        first = first + term
    return first
