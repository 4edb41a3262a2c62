"""V and dV/dt at one exact state in balls, by the plain chain rule along (11), and what they confirm.

    V = ½ yᵀM(q)y + Σ k_pi U(e_i),   y = w − εh,   h = (h(e_i)),   ε = ε₀/(1 + ‖e‖)
    dV/dt = yᵀ(Mẇ − M(dε/dt h + ε dh/dt)) + ½ yᵀṀy − Σ k_pi h(e_i) w_i
    q̇ = w,   ė = −w,   Mẇ = K_p h − K_v h(w) − Bw − C(q,w)w,   C(q,w)w = Ṁw − ½ (∂/∂q)(wᵀMw)

Neither Christoffel symbols nor the cancellations that lead to (15) nor the quadratic form of the certificates
are used, so a state confirmed here stands on its own.

References: ``reyes2019family`` (11), (13).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction

from flint import arb

from lyapcheck.check.numbers.balls import precision, to_arb
from lyapcheck.check.numbers.members import Functions

Vector = tuple[Fraction, ...]
Term = tuple[tuple[int, ...], Fraction]
"""Exponents of (s1 … sn, c1 … cn) and the coefficient of one monomial."""
_BITS = (128, 256, 512, 1024)
"""Precisions that are tried one after the other."""


@dataclass(frozen=True)
class Arm:
    """M(q) as rows of entries, each a sum of terms in kg·m², and the diagonal of B in N·m·s/rad."""

    mass: tuple[tuple[tuple[Term, ...], ...], ...]
    viscous: Vector

    @property
    def n(self) -> int:
        return len(self.viscous)


@dataclass(frozen=True)
class Controller:
    """τ = K_p h(e) − K_v h(w) + g(q); gains in N·m, or per degree for ``per_degree`` (e and w in rad)."""

    functions: Functions
    kp: Vector
    kv: Vector
    per_degree: bool = False


@dataclass(frozen=True)
class State:
    """Angles q and errors e in rad, rates w in rad/s; q and e are independent, for every q_d at once."""

    q: Vector
    e: Vector
    w: Vector


def value(arm: Arm, controller: Controller, eps0: Fraction, state: State, bits: int = 128) -> arb:
    """A ball that contains V at the state, in J."""
    with precision(bits):
        at = _Point(arm, controller, eps0, state)
        stored = _sum(k * at.functions.potential(e) for k, e in zip(at.kp, at.e, strict=True))
        return _dot(at.y, _times(at.mass, at.y)) / 2 + stored


def rate(arm: Arm, controller: Controller, eps0: Fraction, state: State, bits: int = 128) -> arb:
    """A ball that contains dV/dt along (11) at the state, in W.

    Soundness: contains dV/dt of the arm whose M is given by the terms; gravity has cancelled in (11). At
        e = 0, where ‖e‖ has no derivative, h = 0 makes the term with dε/dt vanish.

    References: ``reyes2019family`` (11), (12).
    """
    with precision(bits):
        at = _Point(arm, controller, eps0, state)
        dh = [-at.functions.dh(e) * w for e, w in zip(at.e, at.w, strict=True)]
        shift = [at.eps_rate * h + at.eps * change for h, change in zip(at.h, dh, strict=True)]
        torque = [a - b for a, b in zip(at.inertia_times_acceleration(), _times(at.mass, shift), strict=True)]
        stored = _sum(k * h * w for k, h, w in zip(at.kp, at.h, at.w, strict=True))
        return _dot(at.y, torque) + _dot(at.y, _times(at.mass_rate, at.y)) / 2 - stored


def confirms_positive(arm: Arm, controller: Controller, eps0: Fraction, state: State) -> bool:
    """Whether dV/dt > 0 at the state is proved, with as many bits as that takes.

    ``True`` refutes "dV/dt < 0 away from the origin" for this ε₀. ``False`` says nothing: it is the answer
    also at the origin, for ε₀ <= 0, and for a state of another number of joints.
    """
    sizes = {arm.n, *map(len, (controller.kp, controller.kv, state.q, state.e, state.w))}
    if len(sizes) != 1 or not any((*state.e, *state.w)) or eps0 <= 0:
        return False
    for bits in _BITS:
        result = rate(arm, controller, eps0, state, bits)
        if result > 0:
            return True
        if result < 0:
            return False
    return False


class _Point:
    """Everything that V and dV/dt share, at the current precision."""

    def __init__(self, arm: Arm, controller: Controller, eps0: Fraction, state: State) -> None:
        self.functions = controller.functions
        self.q, self.e, self.w = ([to_arb(x) for x in part] for part in (state.q, state.e, state.w))
        unit = 180 / arb.pi() if controller.per_degree else arb(1)
        self.kp, self.kv = ([to_arb(k) * unit for k in gains] for gains in (controller.kp, controller.kv))
        self.viscous = [to_arb(b) for b in arm.viscous]
        self.h = [self.functions.h(x) for x in self.e]
        sines, cosines = [x.sin() for x in self.q], [x.cos() for x in self.q]
        self.mass = [[polynomial(entry, sines, cosines) for entry in row] for row in arm.mass]
        self.slopes = [
            [[slope(entry, k, sines, cosines) for entry in row] for row in arm.mass] for k in range(arm.n)
        ]
        self.mass_rate = [
            [_sum(self.slopes[k][i][j] * self.w[k] for k in range(arm.n)) for j in range(arm.n)]
            for i in range(arm.n)
        ]
        # dε/dt = ε₀ (eᵀw/r)/(1 + r)² is put at 0 where e = 0 (see `rate`)
        r, self.eps_rate = _dot(self.e, self.e).sqrt(), arb(0)
        self.eps = to_arb(eps0) / (1 + r)
        if any(state.e):
            self.eps_rate = self.eps * _dot(self.e, self.w) / (r * (1 + r))
        self.y = [w - self.eps * h for w, h in zip(self.w, self.h, strict=True)]

    def inertia_times_acceleration(self) -> list[arb]:
        coriolis = _times(self.mass_rate, self.w)
        forces = []
        for i, w in enumerate(self.w):
            torque = self.kp[i] * self.h[i] - self.kv[i] * self.functions.h(w) - self.viscous[i] * w
            forces.append(torque - coriolis[i] + _dot(self.w, _times(self.slopes[i], self.w)) / 2)
        return forces


def polynomial(terms: Sequence[Term], sines: Sequence[arb], cosines: Sequence[arb]) -> arb:
    """The value of a sum of terms in the sines and cosines."""
    generators = [*sines, *cosines]
    return _sum(to_arb(coefficient) * _monomial(powers, generators) for powers, coefficient in terms)


def slope(terms: Sequence[Term], k: int, sines: Sequence[arb], cosines: Sequence[arb]) -> arb:
    """The derivative of a sum of terms with respect to q_k by the product rule: sin' = cos, cos' = −sin."""
    n, generators, result = len(sines), [*sines, *cosines], arb(0)
    for powers, coefficient in terms:
        for index, inner in ((k, cosines[k]), (n + k, -sines[k])):
            if powers[index]:
                lower = tuple(p - (i == index) for i, p in enumerate(powers))
                result += to_arb(coefficient) * powers[index] * _monomial(lower, generators) * inner
    return result


def _monomial(powers: Sequence[int], generators: Sequence[arb]) -> arb:
    result = arb(1)
    for power, generator in zip(powers, generators, strict=True):
        for _ in range(power):
            result *= generator
    return result


def _sum(parts: Iterable[arb]) -> arb:
    return sum(parts, arb(0))


def _dot(x: Sequence[arb], y: Sequence[arb]) -> arb:
    return _sum(a * b for a, b in zip(x, y, strict=True))


def _times(rows: Sequence[Sequence[arb]], x: Sequence[arb]) -> list[arb]:
    return [_dot(row, x) for row in rows]
