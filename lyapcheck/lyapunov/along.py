"""V and dV/dt at a state, written once for arrays and for recorded code.

References: (12), (15) of ``reyes2019family``, the latter in the form of `lyapcheck.lyapunov.quadratic`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Protocol

from lyapcheck.lyapunov import quadratic
from lyapcheck.robots.plant import Plant

Vector = Sequence[Any]


class Forms(Protocol):
    """The functions that the formulas need beyond + − ·, elementwise in one arithmetic."""

    def sin(self, x: Any) -> Any:
        """sin x."""

    def cos(self, x: Any) -> Any:
        """cos x."""

    def sqrt(self, x: Any) -> Any:
        """√x."""

    def ratio(self, a: Any, b: Any) -> Any:
        """a/b for b ≥ 0, and 0 where b = 0."""

    def h(self, x: Any) -> Any:
        """h(x) of the family."""

    def dh(self, x: Any) -> Any:
        """h'(x)."""

    def potential(self, x: Any) -> Any:
        """U(x)."""


@dataclass(frozen=True, eq=False)
class LyapunovFunction:
    """What V and dV/dt are made of besides the state.

    Args:
        model: the arm, without uncertain parameters.
        forms: the arithmetic and the family.
        kp: diagonal of K_p, N·m.
        kv: diagonal of K_v, N·m.
        viscous: diagonal of B, N·m·s/rad.
        eps0: ε₀.
    """

    model: Plant
    forms: Forms
    kp: Vector
    kv: Vector
    viscous: Vector
    eps0: Any

    def value(self, q: Vector, e: Vector, w: Vector) -> Any:
        """V = ½ (w − ε h)ᵀ M (w − ε h) + Σ k_pi U(e_i)."""
        of = self.forms
        eps = self.eps0 * self._shrink(e)[1]
        M = self.model.mass_at(*self._turns(q), float)
        y = [a - eps * of.h(x) for a, x in zip(w, e, strict=True)]
        kinetic = quadratic.dot(y, [quadratic.dot(row, y) for row in M])
        return 0.5 * kinetic + quadratic.dot(self.kp, [of.potential(x) for x in e])

    def rate(self, q: Vector, e: Vector, w: Vector) -> Any:
        """dV/dt = −ε hᵀ K_p h − (w − ε h)ᵀ (B w + K_v h(w) + ε S w)."""
        of, (r, shrink) = self.forms, self._shrink(e)
        eps, h = self.eps0 * shrink, [of.h(x) for x in e]
        S = self._coupling(q, e, h, r, shrink)
        damped = [b * x + k * of.h(x) for b, k, x in zip(self.viscous, self.kv, w, strict=True)]
        Xw = [d + eps * quadratic.dot(row, w) for d, row in zip(damped, S, strict=True)]
        y = [a - eps * b for a, b in zip(w, h, strict=True)]
        corner = quadratic.dot(h, [k * b for k, b in zip(self.kp, h, strict=True)])
        return -(eps * corner + quadratic.dot(y, Xw))

    def _coupling(self, q: Vector, e: Vector, h: Vector, r: Any, shrink: Any) -> list[list[Any]]:
        of, turns = self.forms, self._turns(q)
        M, Ch = self.model.mass_at(*turns, float), self.model.coriolis_at(*turns, h, float)
        return quadratic.coupling(M, Ch, h, [of.dh(x) for x in e], [of.ratio(x, r) for x in e], shrink)

    def _turns(self, q: Vector) -> tuple[list[Any], list[Any]]:
        return [self.forms.sin(x) for x in q], [self.forms.cos(x) for x in q]

    def _shrink(self, e: Vector) -> tuple[Any, Any]:
        """r = ‖e‖ and 1/(1 + r)."""
        r = self.forms.sqrt(quadratic.dot(e, e))
        return r, 1.0 / (1.0 + r)
