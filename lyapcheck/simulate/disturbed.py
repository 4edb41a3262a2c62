"""The closed loop (11) with dry friction added."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING

import casadi as ca
import numpy as np
from flint import fmpq_mpoly

from lyapcheck._types import Array
from lyapcheck.check.numbers.harmonics import harmonics
from lyapcheck.check.numbers.polynomials import root_above
from lyapcheck.robots.plant import Plant
from lyapcheck.robots.trig import to_terms
from lyapcheck.simulate.closed_loop import closed_loop
from lyapcheck.simulate.integrate import Compiled, integrate
from lyapcheck.simulate.task import set_up

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots import RobotModel

CREEP = 1e-3
"""rad/s: dry friction is f tanh(w/creep), so that a joint that should stick creeps."""
TOLERANCE = 1e-8


@dataclass(frozen=True, eq=False)
class DisturbedRun:
    """A motion: ``t`` (N,) in s; ``q``, ``e`` in rad and ``w`` in rad/s, each (N, n); why it ended early."""

    t: Array
    q: Array
    e: Array
    w: Array
    failure: str | None


def disturbed(
    gain_set: GainSet,
    model: RobotModel,
    q_d: Sequence[float],
    q0: Sequence[float] | None = None,
    w0: Sequence[float] | None = None,
    T: float = 5.0,
    *,
    dry: Sequence[float] = (),
    points: int = 1001,
) -> DisturbedRun:
    """Move an arm under its controller against dry friction.

    M(q) ẇ = K_p h(e) − K_v h(w) − B w − C(q, w) w − f tanh(w/creep).

    Args:
        gain_set: the controller.
        model: the arm, uncertain parameters at their nominal values.
        q_d: (n,) goal in rad.
        q0: (n,) start in rad; home if missing.
        w0: (n,) initial rates in rad/s; rest if missing.
        T: seconds.
        dry: (n,) dry friction f in N·m; none if empty.
        points: samples handed back.

    Raises:
        InputError: a task the arm cannot be given.

    Soundness: floating point throughout: evidence, never a proof.

    References: (11) of ``reyes2019family``.
    """
    setup = set_up(gain_set, model, q_d, q0, w0, T=T, eps0=None, points=points)
    loop, n = closed_loop(setup.gains, model), model.n
    from lyapcheck.robots import graph

    w = loop.state[n : 2 * n]
    added = -ca.DM(list(dry) or [0.0] * n) * ca.tanh(w / CREEP)
    acceleration = graph.solve(graph.mass(model, loop.state[:n]), added)
    whole = loop.rate + ca.vertcat(ca.SX.zeros(n), acceleration, 0, 0)
    inputs = [loop.state, loop.goal]
    rate = Compiled(ca.Function("rate", inputs, [ca.densify(whole)]))
    slope = Compiled(ca.Function("slope", inputs, [ca.densify(ca.jacobian(whole, loop.state))]))
    goal, t = np.array(setup.task.q_d), np.linspace(0.0, setup.task.T, points)
    start = np.array([*setup.task.q0, *setup.task.w0, 0.0, 0.0])
    path = integrate(lambda _, y: rate(y, goal), lambda _, y: slope(y, goal), start, t, TOLERANCE)
    q = path.y[:, :n]
    return DisturbedRun(path.t, q, goal - q, path.y[:, n : 2 * n], path.failure)


# --- How large the entries of M and g and the Christoffel symbols of an arm can be, at any angles.
#
# Each is a sum of harmonics a cos(k·q) + b sin(k·q), and at most Σ (a² + b²)^½ in size.


Row = tuple[Fraction, ...]


def mass_sizes(model: Plant) -> tuple[Row, ...]:
    """At least sup |M_ij(q)| for each entry, (n, n), kg·m²; nominal parameters."""
    return tuple(tuple(_size(entry, model.n) for entry in row) for row in model.fixed().mass)


def gravity_sizes(model: Plant) -> Row:
    """At least sup |g_i(q)|, (n,), N·m."""
    return tuple(_size(entry, model.n) for entry in model.fixed().gravity)


def coriolis_squares(model: Plant) -> Row:
    """At least Σ_jk sup |c_ijk(q)|² for each i, so that |(C(q, x) y)_i| is at most its root times ‖x‖ ‖y‖."""
    symbols = model.fixed().christoffel
    return tuple(
        sum((_size(entry, model.n) ** 2 for row in layer for entry in row), Fraction(0)) for layer in symbols
    )


def _size(poly: fmpq_mpoly, n: int) -> Fraction:
    pairs = harmonics(to_terms(poly), n).values()
    return sum(
        (max(abs(a), abs(b)) if not a or not b else root_above(a * a + b * b) for a, b in pairs), Fraction(0)
    )
