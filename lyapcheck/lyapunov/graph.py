"""V and dV/dt of one arm and family as CasADi functions; gains and ε₀ are inputs.

dV/dt comes in two independent ways: ``rate`` differentiates V along (11) by automatic differentiation, and
``rate_15`` adds the terms of (15) as `lyapcheck.derive` has them.

References: (11), (12), (15) of ``reyes2019family``.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

import casadi as ca

from lyapcheck.family import Family
from lyapcheck.family.base import Arithmetic, graphs
from lyapcheck.lyapunov.along import AtState
from lyapcheck.robots.plant import RobotModel
from lyapcheck.robots.trig import ArmAtAngles


@dataclass(frozen=True)
class LyapunovGraph:
    """CasADi functions of columns (q, e, w, kp, kv, eps0); angles in rad, rates in rad/s.

    Args:
        V: V of (12), J.
        rate: dV/dt along (11) by automatic differentiation, W.
        rate_15: the sum of the terms of (15), W.

    Soundness: float64 without bounds.
    """

    V: ca.Function
    rate: ca.Function
    rate_15: ca.Function


def lyapunov_graph(model: RobotModel, family: Family) -> LyapunovGraph:
    """Build the functions for an arm, at nominal values of its uncertain parameters, and a family."""
    q, e, w, kp, kv = (ca.SX.sym(name, model.n) for name in ("q", "e", "w", "kp", "kv"))
    eps0, at = ca.SX.sym("eps0"), at_symbols(model, q, e, w, kp, kv, family.casadi)

    def function(name: str, value: Any) -> ca.Function:
        inputs = {"q": q, "e": e, "w": w, "kp": kp, "kv": kv, "eps0": eps0}
        return ca.Function(name, [*inputs.values()], [value], [*inputs], [name])

    return LyapunovGraph(
        V=function("V", at.value(eps0)),
        rate=function("rate", _along(at, q, e, w, eps0)),
        rate_15=function("rate_15", at.rate(eps0)),
    )


def at_symbols(
    model: RobotModel,
    q: Any,
    e: Any,
    w: Any,
    kp: Any,
    kv: Any,
    forms: Callable[[Any], Any],
    kink: float = 0.0,
    **moving: Any,
) -> AtState:
    """A state in CasADi symbols.

    Args:
        model: the arm; nominal values of its parameters.
        q: (n,) and so are e, w, kp, kv.
        e: q_d − q.
        w: q̇.
        kp: diagonal of K_p.
        kv: diagonal of K_v.
        forms: the family at a symbol.
        kink: put under the root of ‖e‖, for optimisers that cross e = 0.
        moving: ``speed`` and ``acceleration_d`` of a goal that moves.
    """
    own: Arithmetic = replace(graphs(), lift=_lift, sqrt=lambda x: ca.sqrt(x + kink))
    rows, friction = ca.vertsplit, [float(number.value) for number in model.viscous]
    goal: dict[str, Any] = {name: rows(x) for name, x in moving.items()}
    return AtState(model.fixed(), own, forms, rows(q), rows(e), rows(w), rows(kp), rows(kv), friction, **goal)


def _along(at: AtState, q: Any, e: Any, w: Any, eps0: Any) -> Any:
    """∂V/∂q w − ∂V/∂e w + ∂V/∂w ẇ + ∂V/∂r ṙ, with ẇ from (11) and ṙ = −êᵀw.

    At e = 0 the term in ṙ has the factor h = 0 for both one-sided values of ṙ, so ê = 0 gives the same.
    """
    r = ca.SX.sym("r")
    held = replace(at)
    held.__dict__["r"] = r
    V = held.value(eps0)
    slope, inward, slope_w, kink = (ca.substitute(ca.gradient(V, x), r, at.r) for x in (q, e, w, r))
    along = ca.dot(slope - inward, w) + ca.dot(slope_w, ca.vertcat(*at.acceleration()))
    return along - kink * ca.dot(ca.vertcat(*at.unit), w)


# --- The model as CasADi expressions.


def at_angles(model: RobotModel, q: ca.SX) -> ArmAtAngles:
    """The arm at a column q of joint angles in rad, at nominal values."""
    of = graphs()
    turns = [of.sin(x) for x in ca.vertsplit(q)], [of.cos(x) for x in ca.vertsplit(q)]
    return model.at(*turns, _lift)


def _lift(value: Fraction) -> ca.SX:
    return ca.SX(float(value))


def matrix(rows: list[list[ca.SX]]) -> ca.SX:
    """The matrix of some rows."""
    return ca.vertcat(*[ca.horzcat(*row) for row in rows])
