"""States at which dV/dt is large: many sampled ones, and where CasADi and IPOPT climb from the best of them.

    dV/dt = −a₀ + a₁ ε₀ + a₂ ε₀²

so the smallest ε₀ at which a given state has dV/dt = 0 is a root, not a search.

Soundness: none; what is found is a candidate for `lyapcheck.check.loop.states`.

References: ``reyes2019family`` (15).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from lyapcheck._types import Array
from lyapcheck.lyapunov import graph
from lyapcheck.lyapunov.along import AtState
from lyapcheck.lyapunov.graph import at_symbols, lyapunov_graph
from lyapcheck.search.controlled_arm import ControlledArm

_STEPS = 6
"""Fixed-point steps towards the worst w."""
MANY = 10_000
"""States from which a compiled loop is used where there is a compiler."""
_LARGE_ERROR = 0.3
"""rad; for m >= 2 h' has its peak beyond, and hardly anything happens below."""


@dataclass(frozen=True)
class States:
    """Many states: q, e in rad and w in rad/s, each of shape (count, n)."""

    q: Array
    e: Array
    w: Array

    def take(self, chosen: NDArray[Any]) -> States:
        """The states at the given indices."""
        return States(self.q[chosen], self.e[chosen], self.w[chosen])

    def scaled(self, factors: Sequence[float]) -> States:
        """The same states with every rate multiplied, by one factor after the other."""
        q, e = (np.tile(part, (len(factors), 1)) for part in (self.q, self.e))
        return States(q, e, np.vstack([self.w * factor for factor in factors]))


@dataclass(frozen=True)
class Quadratic:
    """a₀, a₁, a₂ of dV/dt = −a₀ + a₁ ε₀ + a₂ ε₀² at each state, W."""

    a0: Array
    a1: Array
    a2: Array

    def at(self, eps0: float) -> Array:
        """dV/dt for one ε₀."""
        return -self.a0 + eps0 * (self.a1 + eps0 * self.a2)

    def reciprocal(self) -> Array:
        """The largest 1/ε₀ with dV/dt >= 0; 0 where no ε₀ > 0 has it."""
        with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
            b1, b2 = self.a1 / self.a0, self.a2 / self.a0
            root = (b1 + np.sqrt(b1 * b1 + 4 * b2)) / 2
        return np.where(np.isfinite(root) & (root > 0), root, 0.0)


def quadratic(controlled: ControlledArm, states: States) -> Quadratic:
    """The coefficients of dV/dt in ε₀ at each state."""
    return Quadratic(*controlled.lyapunov.coefficients(states.q, states.e, states.w, MANY))


def fastest_directions(controlled: ControlledArm, q: Array, e: Array) -> tuple[Array, Array]:
    """The 1/ε₀ that fast states refute at each (q, e), and the directions of w that do so.

        1/ε₀ = λmax(B^(−½) sym F B^(−½)),   a₁ = wᵀ F w + …

    with B replaced by B + K_v for the linear function; directions are of unit length.
    """
    symmetric = _symmetric(controlled.lyapunov.at_columns(q, e, np.zeros_like(e)))
    scale = 1 / np.sqrt(controlled.fast_damping)
    values, vectors = np.linalg.eigh(symmetric * scale[:, None] * scale)
    directions = vectors[:, :, -1] * scale
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    return np.asarray(values[:, -1]), directions


def sample(controlled: ControlledArm, count: int, seed: int) -> States:
    """Random states: q on the torus, ‖w‖ log-uniform, half of the w in the fastest direction.

    In every other pair of states |e_i| is uniform up to 2.5 rad, where h and h' do all they do; in the rest
    it is log-uniform from 0.001 to 10 rad.

    Args:
        count: how many states.
        seed: of the random numbers; the same seed gives the same states.
    """
    random = np.random.default_rng(seed)
    shape = (count, controlled.n)
    order = np.arange(count)[:, None]
    q = random.uniform(-np.pi, np.pi, shape)
    e = np.where(order % 4 < 2, random.uniform(0, 2.5, shape), 10 ** random.uniform(-3, 1, shape))
    e *= random.choice([-1.0, 1.0], shape)
    directions = fastest_directions(controlled, q, e)[1] * random.choice([-1.0, 1.0], (count, 1))
    free = random.normal(size=shape)
    free /= np.linalg.norm(free, axis=1, keepdims=True)
    chosen = np.where(order % 2 == 0, directions, free)
    return States(q, e, chosen * 10 ** random.uniform(-2, 5, (count, 1)))


def slow_sample(controlled: ControlledArm, count: int, seed: int) -> States:
    """Random states whose w is the worst for their (q, e), as far as fixed-point steps find it.

    They start with ‖w‖ between a hundredth and a hundred times ‖h(e)‖; see `worst_rates`.
    """
    random = np.random.default_rng((seed, 1))
    states = sample(controlled, count, seed)
    w = random.normal(size=states.w.shape)
    length = np.linalg.norm(controlled.family.h(states.e), axis=1, keepdims=True)
    w *= length * 10 ** random.uniform(-2, 2, (count, 1)) / np.linalg.norm(w, axis=1, keepdims=True)
    result = States(states.q, states.e, w)
    for _ in range(_STEPS):
        result = worst_rates(controlled, result)
    return result


def worst_rates(controlled: ControlledArm, states: States) -> States:
    """The states with w moved to where dV/dt is largest at the ε₀ refuted now, if that refutes a smaller one.

    With D = diag(h(w_i)/w_i) held, −dV/dt is wᵀYw − 2 bᵀw and a number, Y = B + K_v D − ε₀ sym F and b = ½ (ε
    (B + K_v D) h + ε₀² ∂a₂/∂w), largest at Y⁻¹b wherever Y ≻ 0. Where no ε₀ is refuted yet, it is twice the
    4 k_p/(b + k_v) at which one joint fails near the origin.
    """
    now = quadratic(controlled, states).reciprocal()
    slowest = np.max((controlled.viscous + controlled.kv) / controlled.kp) / 8
    eps0 = 1 / np.maximum(now, slowest)
    at = controlled.lyapunov.at_columns(states.q, states.e, states.w)
    damping = controlled.viscous + controlled.kv * controlled.family.secant(states.w)
    Y = damping[:, :, None] * np.eye(controlled.n) - eps0[:, None, None] * _symmetric(at)
    near = (eps0 * at.near)[:, None] * damping * _rows(at.h, len(now))
    middle = (near + (eps0 * eps0)[:, None] * _rows(at.slope(), len(now))) / 2
    safe = np.abs(np.linalg.det(Y)) > 1e-12
    Y = np.where(safe[:, None, None], Y, np.eye(controlled.n))
    moved = States(states.q, states.e, np.linalg.solve(Y, middle[:, :, None])[:, :, 0])
    better = safe & (quadratic(controlled, moved).reciprocal() > now)
    return States(states.q, states.e, np.where(better[:, None], moved.w, states.w))


def spread(states: States, merit: Array, count: int) -> Array:
    """Indices of ``count`` promising states from different corners of the state space.

    A corner is a pattern of large positive, small and large negative e_i and of the signs of sin q and cos q,
    and its mirror image counts as the same. The best state of every corner comes before the second best of
    any, so that many good states in one valley do not hide another valley.
    """
    # A number for the corner that each state lies in
    size = np.where(np.abs(states.e) > _LARGE_ERROR, np.sign(states.e), 0).astype(int)
    errors = size @ 3 ** np.arange(size.shape[1])
    turned = states.q[:, 1:]
    mirror = np.where(errors < 0, -1, 1)[:, None]
    quarters = (mirror * np.sin(turned) > 0) + 2 * (np.cos(turned) > 0)
    corners = np.asarray(np.abs(errors) * 4 ** turned.shape[1] + quarters @ 4 ** np.arange(turned.shape[1]))
    order = np.argsort(-merit, kind="stable")
    grouped = order[np.argsort(corners[order], kind="stable")]
    _, first, members = np.unique(corners[grouped], return_index=True, return_counts=True)
    rank = np.arange(len(grouped)) - np.repeat(first, members)
    return np.asarray(grouped[np.lexsort((-merit[grouped], rank))][:count])


def fast(at: AtState, scales: Array | None = None) -> Array:
    """F of each state, (count, n, n); with Λh(e) in place of h(e) if a diagonal of Λ is given."""
    count = np.size(at.near)
    return np.stack([_rows(row, count) for row in at.fast(None if scales is None else list(scales))], axis=1)


def _symmetric(at: AtState) -> Array:
    rows = fast(at)
    return (rows + np.swapaxes(rows, 1, 2)) / 2


def _rows(columns: Sequence[Any], count: int) -> Array:
    """Columns, some of them perhaps numbers, as rows of states."""
    return np.stack([np.broadcast_to(x, count) for x in columns], axis=1)


# --- Programs, all smooth, all started from the best of many sampled states.
#
#    fast     max over (q, e, v) of the 1/ε₀ that the state w = t v, t → ∞, refutes: a generalised eigenvalue
#    level    the same at e = 0, where ‖e‖ has a kink and an optimiser that comes from outside stays behind
#    finite   max over (q, e, w) of the 1/ε₀ at which dV/dt = 0 at the state itself
#    slow     the same over (q, e, u) with w = ‖h(e)‖u, which reaches states near the origin and weak gains


_OPTIONS: dict[str, Any] = {
    "print_time": False,
    "error_on_fail": False,
    "ipopt": {"print_level": 0, "sb": "yes", "max_iter": 60, "tol": 1e-10, "acceptable_tol": 1e-8},
}
_LONGEST_ERROR = 30.0
"""Largest |e_i| searched, rad: beyond it 1/(1 + ‖e‖) is small."""
SAME = 1e-6
"""How far two ways to dV/dt may differ, as a share of its terms."""
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


def symbols_of(controlled: ControlledArm) -> AtState:
    """The state as CasADi symbols, of which the programs are made."""
    q, e, w = (ca.SX.sym(name, controlled.n) for name in "qew")
    gains = ca.DM(controlled.kp), ca.DM(controlled.kv)
    return at_symbols(controlled.fixed, q, e, w, *gains, controlled.family.casadi, kink=1e-24)


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
    at, n, bound = symbols_of(controlled), controlled.n, ranges_of_state(controlled.n, 2.0)
    w = ca.vertcat(*at.w)
    fastest = ca.bilin(graph.matrix(at.fast()), w, w) / ca.dot(w, ca.DM(controlled.fast_damping) * w)
    if level:
        bound[n : 2 * n], starts = 0.0, States(starts.q, np.zeros_like(starts.e), starts.w)
    ends = Program(ca.vertcat(*at.q, *at.e, w), fastest, bound).climb(_stack(starts))
    q, e, _ = _parts(ends, n)
    return States(q, e, fastest_directions(controlled, q, e)[1])


def finite_states(controlled: ControlledArm, starts: States) -> States:
    """Where the finite program ends from each start."""
    at = symbols_of(controlled)
    program = _reciprocal_program(ca.vertcat(*at.q, *at.e, *at.w), at.coefficients(), controlled.n)
    first = quadratic(controlled, starts).reciprocal()
    return States(*_parts(program.climb(_with(starts, first)), controlled.n))


def slow_states(controlled: ControlledArm, starts: States, radius: float) -> States:
    """Where the slow program ends from each start, with |e_i| up to ``radius``.

    A small reach finds the worst direction in which the origin can be left; where h'(0) > 0 all smaller
    multiples of such a state are about as bad.
    """
    at, n = symbols_of(controlled), controlled.n
    d, u = ca.SX.sym("d", n), ca.SX.sym("u", n)
    unit = radius / _LONGEST_ERROR
    lengths = _length(controlled.family.h(starts.e))[:, None]
    e = unit * d
    w = ca.sqrt(ca.sumsqr(controlled.family.casadi(e).h) + 1e-300) * u
    inner = ca.substitute(at.coefficients(), [ca.vertcat(*at.e), ca.vertcat(*at.w)], [e, w])
    program = _reciprocal_program(ca.vertcat(*at.q, d, u), inner, n)
    first = quadratic(controlled, starts).reciprocal()
    result = program.climb(_with(States(starts.q, starts.e / unit, starts.w / lengths), first))
    ends = result[:, n : 2 * n] * unit
    return States(result[:, :n], ends, result[:, 2 * n : 3 * n] * _length(controlled.family.h(ends))[:, None])


def _reciprocal_program(variables: Any, coefficients: Sequence[Any], n: int) -> Program:
    """Max y with −a₀y² + a₁y + a₂ >= 0, y = 1/ε₀."""
    y, (a0, a1, a2) = ca.SX.sym("y"), coefficients
    failing = y * y - (a1 / a0) * y - a2 / a0
    bound = np.append(ranges_of_state(n, _FASTEST), 1e6)
    return Program(ca.vertcat(variables, y), y, bound, failing)


def _with(states: States, first: Array) -> Array:
    return np.hstack([_stack(states), first[:, None]])


def _length(rows: Array) -> Array:
    return np.asarray(np.maximum(np.linalg.norm(rows, axis=1), 1e-150))


def ranges_of_state(n: int, rate: float) -> Array:
    """How far each angle, error and rate may go."""
    return np.repeat([2 * np.pi, _LONGEST_ERROR, rate], n)


def _stack(states: States) -> Array:
    return np.hstack([states.q, states.e, states.w])


def _parts(rows: Array, n: int) -> tuple[Array, Array, Array]:
    return rows[:, :n], rows[:, n : 2 * n], rows[:, 2 * n : 3 * n]
