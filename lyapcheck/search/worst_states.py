"""Worst-case states by CasADi and IPOPT from many starts.

Programs, all smooth, all started from the best of many sampled states:

    fast     max over (q, e, v) of the 1/ε₀ that the state w = t v, t → ∞, refutes: a generalised eigenvalue
    level    the same at e = 0, where ‖e‖ has a kink and an optimiser that comes from outside stays behind
    finite   max over (q, e, w) of the 1/ε₀ at which dV/dt = 0 at the state itself
    slow     the same over (q, e, u) with w = ‖h(e)‖u, which reaches states near the origin and weak gains
    resisting  max over (q, e, v) of 1 − vᵀP(λ)v/vᵀBv, for weights λ = ε₀Λ; see `lyapcheck.search.weights`

Soundness: none; what is found is a candidate for `lyapcheck.check.loop.states`.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import casadi as ca
import numpy as np

from lyapcheck._types import Array
from lyapcheck.lyapunov import graph
from lyapcheck.lyapunov.graph import at_symbols, lyapunov_graph
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.search.sample import States, fastest_directions, quadratic

_OPTIONS: dict[str, Any] = {
    "print_time": False,
    "error_on_fail": False,
    "ipopt": {"print_level": 0, "sb": "yes", "max_iter": 60, "tol": 1e-10, "acceptable_tol": 1e-8},
}
_LONGEST_ERROR = 30.0
"""Largest |e_i| searched, rad: beyond it 1/(1 + ‖e‖) is small."""
SAME = 1e-6
"""How far two ways to dV/dt may differ, as a share of its terms."""
SOFTEST = 1e-12
"""N·m, of K_p Λ⁻¹ − ¼ L K_v: what is no larger resists at every state."""
_FASTEST = 1e4
"""Largest |w_i| of the finite program, rad/s: beyond it the fast program is as good."""


@dataclass(frozen=True, eq=False)
class Program:
    """Maximise ``objective`` over ``variables`` within ±``bound`` and with ``constraint`` <= 0."""

    variables: Any
    objective: Any
    bound: Array
    constraint: Any = None
    parameters: Any = None

    @cached_property
    def _solver(self) -> Any:
        problem = {"x": self.variables, "f": -self.objective}
        problem |= {} if self.constraint is None else {"g": self.constraint}
        problem |= {} if self.parameters is None else {"p": self.parameters}
        return ca.nlpsol("solver", "ipopt", problem, _OPTIONS)

    def climb(self, starts: Array, parameters: Array | None = None) -> Array:
        """Where IPOPT ends from each start, (starts, variables), for values of the parameters."""
        given: dict[str, Any] = {"lbx": -self.bound, "ubx": self.bound}
        given |= {} if self.constraint is None else {"lbg": -np.inf, "ubg": 0.0}
        given |= {} if parameters is None else {"p": parameters}
        ends = [np.asarray(self._solver(x0=start, **given)["x"]).ravel() for start in starts]
        return np.array(ends).reshape(len(starts), len(self.bound))


@dataclass(frozen=True)
class Expressions:
    """The state as symbols, and what the programs are made of, all as CasADi expressions."""

    q: Any
    e: Any
    w: Any
    a0: Any
    a1: Any
    a2: Any
    fast: Any
    """wᵀFw."""


def expressions(controlled: ControlledArm) -> Expressions:
    """a₀, a₁, a₂ of dV/dt and wᵀFw, all that is left of a₁ for fast states, as CasADi expressions."""
    n, forms = controlled.n, controlled.family.casadi
    q, e, w = (ca.SX.sym(name, n) for name in "qew")
    gains = ca.DM(controlled.kp), ca.DM(controlled.kv)
    at = at_symbols(controlled.fixed, q, e, w, *gains, forms, kink=1e-24)
    a0, a1, a2 = at.coefficients()
    return Expressions(q, e, w, a0, a1, a2, ca.bilin(graph.matrix(at.fast()), w, w))


class Disagreement(RuntimeError):
    """Two ways to dV/dt give different numbers: one of the two is wrong, and no search may go on."""


def require_one_rate(controlled: ControlledArm, states: States) -> None:
    """Hold the dV/dt of samples against what CasADi gets from V alone, by automatic differentiation.

    Raises:
        Disagreement: they differ by more than rounding.
    """
    known = quadratic(controlled, states)
    eps0 = 1.0 / max(float(np.max(known.reciprocal())), 1e-3)
    graph, columns = lyapunov_graph(controlled.fixed, controlled.family), (states.q, states.e, states.w)
    derived = graph.rate(*(x.T for x in columns), controlled.kp, controlled.kv, eps0).full().ravel()
    size = np.abs(known.a0) + eps0 * (np.abs(known.a1) + eps0 * np.abs(known.a2))
    if not np.all(np.abs(derived - known.at(eps0)) <= SAME * size):
        raise Disagreement(f"{controlled.gains.name}: V by automatic differentiation has another dV/dt")


def fast_states(controlled: ControlledArm, starts: States, level: bool = False) -> States:
    """Where the fast program ends from each start, or the level one, with e held at 0; w has unit length."""
    x, n, bound = expressions(controlled), controlled.n, _bound(controlled.n, 2.0)
    damping = ca.dot(x.w, ca.DM(controlled.fast_damping) * x.w)
    if level:
        bound[n : 2 * n], starts = 0.0, States(starts.q, np.zeros_like(starts.e), starts.w)
    ends = Program(ca.vertcat(x.q, x.e, x.w), x.fast / damping, bound).climb(_stack(starts))
    q, e, _ = _parts(ends, n)
    return States(q, e, fastest_directions(controlled, q, e)[1])


def finite_states(controlled: ControlledArm, starts: States) -> States:
    """Where the finite program ends from each start."""
    x = expressions(controlled)
    bound = _bound(controlled.n, _FASTEST)
    first = quadratic(controlled, starts).reciprocal()
    return States(*_parts(_reciprocal_program(x, bound).climb(_with(starts, first)), controlled.n))


def slow_states(controlled: ControlledArm, starts: States, radius: float) -> States:
    """Where the slow program ends from each start, with |e_i| up to ``radius``.

    A small reach finds the worst direction in which the origin can be left; where h'(0) > 0 all smaller
    multiples of such a state are about as bad.
    """
    x, n = expressions(controlled), controlled.n
    d, u = ca.SX.sym("d", n), ca.SX.sym("u", n)
    unit = radius / _LONGEST_ERROR
    lengths = _length(controlled.family.h(starts.e))[:, None]
    e = unit * d
    w = ca.sqrt(ca.sumsqr(controlled.family.casadi(e).h) + 1e-300) * u
    inner = ca.substitute([x.a0, x.a1, x.a2], [x.e, x.w], [e, w])
    program = _reciprocal_program(
        replace(x, e=d, w=u, a0=inner[0], a1=inner[1], a2=inner[2]), _bound(n, _FASTEST)
    )
    first = quadratic(controlled, starts).reciprocal()
    result = program.climb(_with(States(starts.q, starts.e / unit, starts.w / lengths), first))
    ends = result[:, n : 2 * n] * unit
    return States(result[:, :n], ends, result[:, 2 * n : 3 * n] * _length(controlled.family.h(ends))[:, None])


def resisting_program(controlled: ControlledArm) -> Program:
    """The resisting program over (q, e, v); its parameters are λ."""
    n, B = controlled.n, ca.DM(controlled.viscous)
    q, e, v, weights = (ca.SX.sym(name, n) for name in ("q", "e", "v", "weights"))
    gains = ca.DM(controlled.kp), ca.DM(controlled.kv)
    at = at_symbols(controlled.fixed, q, e, v, *gains, controlled.family.casadi, kink=1e-24)
    F = graph.matrix(at.fast(ca.vertsplit(weights)))
    x = B * v - F.T @ v
    largest = float(controlled.family.constants().L.upper) / 4 * gains[1]
    compliance = 1 / ca.fmax(gains[0] / weights - largest, SOFTEST)
    top = ca.bilin(F, v, v) + at.near / 4 * ca.dot(compliance, x * x)
    return Program(ca.vertcat(q, e, v), top / ca.dot(v, B * v), _bound(n, 2.0), parameters=weights)


def _reciprocal_program(x: Expressions, bound: Array) -> Program:
    """Max y with −a₀y² + a₁y + a₂ >= 0, y = 1/ε₀."""
    y = ca.SX.sym("y")
    failing = y * y - (x.a1 / x.a0) * y - x.a2 / x.a0
    return Program(ca.vertcat(x.q, x.e, x.w, y), y, np.append(bound, 1e6), failing)


def _with(states: States, first: Array) -> Array:
    return np.hstack([_stack(states), first[:, None]])


def _length(rows: Array) -> Array:
    return np.asarray(np.maximum(np.linalg.norm(rows, axis=1), 1e-150))


def _bound(n: int, rate: float) -> Array:
    return np.repeat([2 * np.pi, _LONGEST_ERROR, rate], n)


def _stack(states: States) -> Array:
    return np.hstack([states.q, states.e, states.w])


def _parts(rows: Array, n: int) -> tuple[Array, Array, Array]:
    return rows[:, :n], rows[:, n : 2 * n], rows[:, 2 * n : 3 * n]
