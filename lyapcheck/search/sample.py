"""dV/dt over many sampled states at once, as the quadratic in ε₀ that it is.

    dV/dt = −a₀ + a₁ ε₀ + a₂ ε₀²,   s = 1/(1 + ‖e‖)
    a₀ = wᵀBw + wᵀK_v h(w)
    a₁ = s [wᵀ(H'M − s ê(Mh)ᵀ − C(q,h))w − hᵀK_p h + hᵀ(Bw + K_v h(w))]
    a₂ = s² [hᵀC(q,h)w + s (êᵀw) hᵀMh − hᵀM(h'∘w)]

so the smallest ε₀ at which a given state has dV/dt = 0 is a root, not a search.

References: ``reyes2019family`` (15).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import cast

import numpy as np

from lyapcheck._types import Array
from lyapcheck.search.controlled_arm import ControlledArm

_STEPS = 6
"""Fixed-point steps towards the worst w."""
_LARGE_ERROR = 0.3
"""rad; for m >= 2 h' has its peak beyond, and hardly anything happens below."""


@dataclass(frozen=True)
class States:
    """Many states: q, e in rad and w in rad/s, each of shape (count, n)."""

    q: Array
    e: Array
    w: Array

    def take(self, chosen: Array) -> States:
        """The states at the given indices."""
        return States(self.q[chosen], self.e[chosen], self.w[chosen])

    def scaled(self, factor: Array | float) -> States:
        """The same states with every rate multiplied."""
        return States(self.q, self.e, self.w * factor)


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
    family, w = controlled.family, states.w
    h, dh, hw = family.h(states.e), family.dh(states.e), family.h(w)
    s, along = _nearness(states.e)
    mass = controlled.numeric.mass(states.q)
    coriolis = controlled.numeric.coriolis(states.q, h)
    mw, mh, cw = _times(mass, w), _times(mass, h), _times(coriolis, w)
    ew = _dot(along, w)
    damping = controlled.viscous * w + controlled.kv * hw
    fast = _dot(dh * w, mw) - s * ew * _dot(h, mw) - _dot(w, cw)
    slow = _dot(h, damping) - _dot(h, controlled.kp * h)
    last = _dot(h, cw) + s * ew * _dot(h, mh) - _dot(mh, dh * w)
    return Quadratic(_dot(w, damping), s * (fast + slow), s * s * last)


def fastest_directions(controlled: ControlledArm, q: Array, e: Array) -> tuple[Array, Array]:
    """The 1/ε₀ that fast states refute at each (q, e), and the directions of w that do so.

        1/ε₀ = λmax(B^(−½) S B^(−½)) / (1 + r),   S = sym(H'M − ê(Mh)ᵀ/(1 + r) − C(q,h))

    with B replaced by B + K_v for the linear function; directions are of unit length.
    """
    h, dh = controlled.family.h(e), controlled.family.dh(e)
    s, along = _nearness(e)
    mass = controlled.numeric.mass(q)
    form = dh[:, :, None] * mass - controlled.numeric.coriolis(q, h)
    form -= s[:, None, None] * along[:, :, None] * _times(mass, h)[:, None, :]
    scale = 1 / np.sqrt(controlled.fast_damping)
    symmetric = (form + np.swapaxes(form, 1, 2)) / 2 * scale[:, None] * scale
    values, vectors = np.linalg.eigh(symmetric)
    directions = vectors[:, :, -1] * scale
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    return np.asarray(s * values[:, -1]), directions


def sample(controlled: ControlledArm, count: int, seed: int) -> States:
    """Random states: q on the torus, ‖w‖ log-uniform, half of the w in the fastest direction.

    In every other pair of states |e_i| is uniform up to 2.5 rad, where h and h' do all they do; in the rest
    it is log-uniform from 0.001 to 10 rad.

    Args:
        controlled: gains and arm.
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

    With D = diag(h(w_i)/w_i) held, dV/dt is a quadratic in w with the maximum ½ ε Y⁻¹Xᵀh wherever Y ≻ 0.
    Where no ε₀ is refuted yet, it is twice the 4 k_p/(b + k_v) at which one joint fails near the origin.
    """
    family = controlled.family
    now = quadratic(controlled, states).reciprocal()
    s, along = _nearness(states.e)
    slowest = np.max((controlled.viscous + controlled.kv) / controlled.kp) / 8
    eps = s / np.maximum(now, slowest)
    h, dh = family.h(states.e), family.dh(states.e)
    mass, coriolis = controlled.numeric.mass(states.q), controlled.numeric.coriolis(states.q, h)
    mh = _times(mass, h)
    damping = controlled.viscous + controlled.kv * family.secant(states.w)
    form = dh[:, :, None] * mass - coriolis - s[:, None, None] * along[:, :, None] * mh[:, None, :]
    Y = damping[:, :, None] * np.eye(controlled.n) - eps[:, None, None] * (form + np.swapaxes(form, 1, 2)) / 2
    balance = damping * h - eps[:, None] * _times(np.swapaxes(form, 1, 2), h)
    safe = np.abs(np.linalg.det(Y)) > 1e-12
    Y = np.where(safe[:, None, None], Y, np.eye(controlled.n))
    moved = States(states.q, states.e, eps[:, None] / 2 * np.linalg.solve(Y, balance[:, :, None])[:, :, 0])
    better = safe & (quadratic(controlled, moved).reciprocal() > now)
    return States(states.q, states.e, np.where(better[:, None], moved.w, states.w))


def spread(states: States, merit: Array, count: int) -> Array:
    """Indices of ``count`` promising states from different corners of the state space.

    A corner is a pattern of large positive, small and large negative e_i and of the signs of sin q and cos q,
    and its mirror image counts as the same. The best state of every corner comes before the second best of
    any, so that many good states in one valley do not hide another valley.
    """
    corners = _corners(states)
    order = np.argsort(-merit, kind="stable")
    grouped = order[np.argsort(corners[order], kind="stable")]
    _, first, members = np.unique(corners[grouped], return_index=True, return_counts=True)
    rank = np.arange(len(grouped)) - np.repeat(first, members)
    return np.asarray(grouped[np.lexsort((-merit[grouped], rank))][:count])


def _corners(states: States) -> Array:
    """A number for the corner that each state lies in."""
    size = np.where(np.abs(states.e) > _LARGE_ERROR, np.sign(states.e), 0).astype(int)
    errors = size @ 3 ** np.arange(size.shape[1])
    turned = states.q[:, 1:]
    mirror = np.where(errors < 0, -1, 1)[:, None]
    quarters = (mirror * np.sin(turned) > 0) + 2 * (np.cos(turned) > 0)
    return np.asarray(np.abs(errors) * 4 ** turned.shape[1] + quarters @ 4 ** np.arange(turned.shape[1]))


def size(controlled: ControlledArm, eps0: float, states: States) -> Array:
    """‖z‖² = ε‖h(e)‖² + ‖w‖², by which dV/dt is made comparable between slow and fast states."""
    h = controlled.family.h(states.e)
    return eps0 * _nearness(states.e)[0] * _dot(h, h) + _dot(states.w, states.w)


def _nearness(e: Array) -> tuple[Array, Array]:
    """s = 1/(1 + ‖e‖) and ê, which is 0 at e = 0."""
    r = np.linalg.norm(e, axis=1)
    return 1 / (1 + r), e / np.where(r > 0, r, 1.0)[:, None]


def _dot(x: Array, y: Array) -> Array:
    return cast("Array", np.einsum("ki,ki->k", x, y))


def _times(rows: Array, x: Array) -> Array:
    return cast("Array", np.einsum("kij,kj->ki", rows, x))
