"""V, dV/dt and Q of one arm and family as CasADi functions; gains and ε₀ are inputs.

dV/dt comes in two independent ways: ``rate`` differentiates V along (11) by automatic differentiation, and
``rate_15`` adds the printed terms of (15).

References: (11), (12), (15) of ``reyes2019family``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import casadi as ca

from lyapcheck.family import Family
from lyapcheck.lyapunov import quadratic
from lyapcheck.robots import graph
from lyapcheck.robots.graph import matrix
from lyapcheck.robots.plant import Plant


@dataclass(frozen=True)
class LyapunovGraph:
    """CasADi functions of columns (q, e, w, kp, kv, eps0); angles in rad, rates in rad/s.

    Args:
        V: V of (12), J.
        rate: dV/dt along (11) by automatic differentiation, W.
        rate_15: the sum of the terms of (15), W.
        Q: the (2n, 2n) matrix with dV/dt = −zᵀQz, z = [√ε h; w].
        fast: the (n, n) matrix Y at D = 0, for fast states.

    Soundness: float64 without bounds.
    """

    V: ca.Function
    rate: ca.Function
    rate_15: ca.Function
    Q: ca.Function
    fast: ca.Function


@dataclass(frozen=True)
class _State:
    """The symbols of a state and of the controller, and what all functions share."""

    model: Plant
    family: Family
    q: Any
    e: Any
    w: Any
    kp: Any
    kv: Any
    eps0: Any

    @property
    def inputs(self) -> list[Any]:
        """The arguments of every function."""
        return [self.q, self.e, self.w, self.kp, self.kv, self.eps0]

    @property
    def r(self) -> Any:
        """‖e‖."""
        return ca.sqrt(ca.sumsqr(self.e))

    @property
    def e_hat(self) -> Any:
        """e/‖e‖, and 0 at e = 0, without a division by zero on either branch."""
        r = self.r
        return self.e / ca.if_else(r > 0, r, 1)

    @property
    def eps(self) -> Any:
        """ε₀/(1 + ‖e‖)."""
        return self.eps0 / (1 + self.r)

    @property
    def viscous(self) -> Any:
        """The diagonal of B."""
        return ca.DM([float(number.value) for number in self.model.viscous])

    def function(self, name: str, value: Any) -> ca.Function:
        """A CasADi function of the state and the controller."""
        return ca.Function(name, self.inputs, [value], ["q", "e", "w", "kp", "kv", "eps0"], [name])


def lyapunov_graph(model: Plant, family: Family) -> LyapunovGraph:
    """Build the functions for an arm, at nominal values of its uncertain parameters, and a family."""
    q, e, w, kp, kv = (ca.SX.sym(name, model.n) for name in ("q", "e", "w", "kp", "kv"))
    state = _State(model.fixed(), family, q, e, w, kp, kv, ca.SX.sym("eps0"))
    return LyapunovGraph(
        V=state.function("V", _value(state, state.r)),
        rate=state.function("rate", _rate(state)),
        rate_15=state.function("rate_15", _rate_15(state)),
        Q=state.function("Q", _form(state, family.casadi(state.w).secant)),
        fast=state.function("fast", _fast(state, ca.DM.zeros(model.n))),
    )


def _value(s: _State, r: Any) -> Any:
    """(13) with ‖e‖ given, so that its kink at e = 0 can be differentiated by hand."""
    forms = s.family.casadi(s.e)
    y = s.w - s.eps0 / (1 + r) * forms.h
    return ca.bilin(graph.mass(s.model, s.q), y, y) / 2 + ca.dot(s.kp, forms.potential)


def _rate(s: _State) -> Any:
    """∂V/∂q w − ∂V/∂e w + ∂V/∂w ẇ + ∂V/∂r ṙ, with ẇ from (11) and ṙ = −êᵀw.

    At e = 0 the term in ṙ has the factor h = 0 for both one-sided values of ṙ, so ê = 0 gives the same.
    """
    r = ca.SX.sym("r")
    V = _value(s, r)
    slope = ca.substitute(ca.gradient(V, s.q), r, s.r)
    inward = ca.substitute(ca.gradient(V, s.e), r, s.r)
    slope_w = ca.substitute(ca.gradient(V, s.w), r, s.r)
    kink = ca.substitute(ca.gradient(V, r), r, s.r)
    along = ca.dot(slope - inward, s.w)
    return along + ca.dot(slope_w, _acceleration(s)) - kink * ca.dot(s.e_hat, s.w)


def _acceleration(s: _State) -> Any:
    """ẇ = M⁻¹ (K_p h(e) − K_v h(w) − B w − C(q,w) w)."""
    C = graph.coriolis(s.model, s.q, s.w)
    torque = s.kp * s.family.casadi(s.e).h - s.kv * s.family.casadi(s.w).h - s.viscous * s.w - C @ s.w
    return graph.solve(graph.mass(s.model, s.q), torque)


def _rate_15(s: _State) -> Any:
    """The eleven terms of (15), in printed order."""
    forms, hw, w, eps = s.family.casadi(s.e), s.family.casadi(s.w).h, s.w, s.eps
    h, dhw, near = forms.h, forms.dh * w, ca.dot(s.e_hat, w) / (1 + s.r)
    M, C = graph.mass(s.model, s.q), graph.coriolis(s.model, s.q, w)
    terms = [
        -ca.dot(w, s.kv * hw),
        -ca.dot(w, s.viscous * w),
        eps * ca.bilin(M, dhw, w),
        -eps * near * ca.bilin(M, h, w),
        -eps * ca.bilin(C.T, h, w),
        -eps * ca.dot(h, s.kp * h),
        eps * ca.dot(h, s.viscous * w),
        eps * ca.dot(h, s.kv * hw),
        eps**2 / 2 * ca.bilin(C + C.T, h, h),
        eps**2 * near * ca.bilin(M, h, h),
        -(eps**2) * ca.bilin(M, dhw, h),
    ]
    return sum(terms[1:], terms[0])


def _form(s: _State, D: Any) -> Any:
    """Q with h(w) = D w."""
    damped, S = _damped(s, D), _coupling(s)
    X, Y = quadratic.x_matrix(damped, S, s.eps), quadratic.y_matrix(damped, S, s.eps)
    return matrix(quadratic.quadratic_form(_entries(s.kp), X, Y, ca.sqrt(s.eps)))


def _fast(s: _State, D: Any) -> Any:
    """Y with a given D."""
    return matrix(quadratic.y_matrix(_damped(s, D), _coupling(s), s.eps))


def _damped(s: _State, D: Any) -> list[Any]:
    return quadratic.damping(_entries(s.viscous), _entries(s.kv), _entries(D))


def _coupling(s: _State) -> list[list[Any]]:
    forms = s.family.casadi(s.e)
    M, Ch = graph.mass(s.model, s.q), graph.coriolis(s.model, s.q, forms.h)
    h, dh, e_hat = (_entries(x) for x in (forms.h, forms.dh, s.e_hat))
    return quadratic.coupling(_rows(M), _rows(Ch), h, dh, e_hat, 1 / (1 + s.r))


def _entries(column: Any) -> list[Any]:
    return [column[i] for i in range(column.numel())]


def _rows(matrix: Any) -> list[list[Any]]:
    return [[matrix[i, j] for j in range(matrix.size2())] for i in range(matrix.size1())]
