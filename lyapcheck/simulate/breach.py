"""The first promise that a run breaks, with the state that broke it."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from fractions import Fraction

import numpy as np
from flint import arb

from lyapcheck._types import Array
from lyapcheck.check.kinds.inertia import dot
from lyapcheck.check.loop.states import State, rate
from lyapcheck.check.numbers.balls import precision, to_arb
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.simulate.run import Breach, Motion, Row, Sample
from lyapcheck.simulate.task import Setup

RATE_NOISE = 1e-12
"""dV/dt below this share of its largest size is not worth a look in balls."""
ROUNDING = 1e-12
"""How far a torque may be above its bound, relative to it."""
V_NOISE = 1e-9
"""How far V may rise between samples, relative to its largest value, before it counts as a rise."""
LEAST_ENERGY = 1e-9
"""J: below this, energies are the integrator's absolute tolerance and not the arm's."""
CANDIDATES = 100
"""Samples that are judged in balls before a promise counts as kept."""
Monitor = Callable[[Setup, Motion], Breach | None]
"""What was run, and its motion, to the first breach of one promise."""


def noise_of(V: Array) -> float:
    """J, how far V may rise between two samples before it counts as a rise."""
    return V_NOISE * max(float(np.max(np.abs(V))), LEAST_ENERGY)


def first_breach(setup: Setup, run: Motion, monitors: Sequence[Monitor]) -> Breach | None:
    """The earliest breach that any monitor finds."""
    result = [breach for monitor in monitors if (breach := monitor(setup, run)) is not None]
    return min(result, key=lambda breach: breach.index, default=None)


def rate_monitor(setup: Setup, run: Motion) -> Breach | None:
    """dV/dt ≤ 0 at every sample, with the run's ε₀; with ε₀ = 0 it holds by (14) and nothing is looked at."""
    if run.eps0 == 0.0:
        return None
    high = np.flatnonzero(run.dV > RATE_NOISE * np.max(np.abs(run.dV)))
    for i in high[:CANDIDATES].tolist():
        if rises(setup.controlled, run.eps0, run.sample(i)):
            return run.broken(f"dV/dt ≤ 0 for ε₀ = {run.eps0:g}", i, run.dV[i], 0.0, "W", True)
    return None


def fall_monitor(setup: Setup, run: Motion) -> Breach | None:
    """V does not rise between samples by more than the run's own error."""
    up = np.flatnonzero(np.diff(run.V) > noise_of(run.V))
    if not up.size:
        return None
    i = int(up[0]) + 1
    return run.broken(f"V falls for ε₀ = {run.eps0:g}", i, run.V[i], run.V[i - 1], "J", False)


def limit_monitor(setup: Setup, run: Motion) -> Breach | None:
    """Each |τ_i| is at most what the motor can give, where that is known."""
    result = []
    for joint, number in enumerate(setup.model.torque_limit):
        most, size = math.inf if number is None else float(number.value), np.abs(run.tau[:, joint])
        promise = f"|τ| of {run.joints[joint]} within the motor's limit"
        for i in np.flatnonzero(size > most)[:CANDIDATES].tolist():
            if number is not None and exceeds(setup.controlled, joint, number.value, run.sample(i)):
                result.append(run.broken(promise, i, size[i], most, "N·m", True))
                break
    return min(result, key=lambda breach: breach.index, default=None)


def joint_monitor(name: str, bounds: Sequence[float] | None) -> Monitor:
    """Each |τ_i| is at most a bound, of which no more than rounding is forgiven."""

    def monitor(setup: Setup, run: Motion) -> Breach | None:
        if bounds is None:
            return None
        beyond = np.argwhere(np.abs(run.tau) > np.array(bounds) * (1 + ROUNDING))
        if not beyond.size:
            return None
        i, joint = beyond[0].tolist()
        promise = f"|τ| of {run.joints[joint]} within {name}"
        return run.broken(promise, i, abs(run.tau[i, joint]), bounds[joint], "N·m", False)

    return monitor


def bound_monitor(name: str, bound: float | None) -> Monitor:
    """‖τ‖ is at most a bound, of which no more than rounding is forgiven."""
    most = math.inf if bound is None else bound * (1 + ROUNDING)

    def monitor(setup: Setup, run: Motion) -> Breach | None:
        norm = np.linalg.norm(run.tau, axis=1)
        beyond = np.flatnonzero(norm > most)
        if not beyond.size:
            return None
        i = int(beyond[0])
        return run.broken(f"‖τ‖ within {name}", i, norm[i], most, "N·m", False)

    return monitor


# --- What a run passes through, judged again in balls: dV/dt and the torque at one exact state.
#
# The doubles of a sample are exact rationals, so what is found here holds of that state, however the
# simulation came to it.
#
# References: ``reyes2019family`` (6), (11), (12), (21); ``johansson2017arb``.


BITS = (128, 256, 512)
"""Precisions that are tried one after the other."""


def rises(controlled: ControlledArm, eps0: float, at: Sample) -> bool:
    """Whether dV/dt > 0 at the sample is proved.

    With a moving goal dV/dt is that of (11) plus −ε (w − εh)ᵀ C(q, q̇_d) h.

    Soundness: ``True`` is a proof about the state; ``False`` says nothing.
    """
    exact = Fraction(eps0)
    state = State(_exact(at.q), _exact(at.e), _exact(at.w))
    return _proved(
        lambda bits: (
            rate(controlled.arm, controlled.controller, exact, state, bits)
            + reference_term(controlled, eps0, at)
        )
    )


def exceeds(controlled: ControlledArm, joint: int, limit: Fraction, at: Sample) -> bool:
    """Whether |τ_i| of (6), or of (21) for a moving goal, is proved to be larger than a limit in N·m.

    Soundness: as `rises`.
    """
    return _proved(lambda bits: abs(torques(controlled, at)[joint]) - to_arb(limit))


def torques(controlled: ControlledArm, at: Sample) -> list[arb]:
    """τ = K_p h(e) − K_v h(w) + M q̈_d + C(q, q̇) q̇_d + g + B q̇_d in balls of the current precision, N·m."""
    model, functions = controlled.fixed, controlled.controller.functions
    sines, cosines = _turns(at)
    w, speed, acceleration = _balls(at.w), _moving(at.speed, at), _moving(at.acceleration, at)
    rates = [a + b for a, b in zip(w, speed, strict=True)]
    mass = model.at(sines, cosines, to_arb).mass()
    coriolis = model.at(sines, cosines, to_arb).coriolis(rates)
    gravity = model.at(sines, cosines, to_arb).gravity()
    unit = 180 / arb.pi() if controlled.per_degree else arb(1)
    result = []
    for i, (e, x) in enumerate(zip(_balls(at.e), w, strict=True)):
        spring = to_arb(controlled.gains.kp[i]) * unit * functions.h(e)
        damper = to_arb(controlled.gains.kv[i]) * unit * functions.h(x)
        lead = dot(mass[i], acceleration) + dot(coriolis[i], speed)
        result.append(spring - damper + lead + gravity[i] + to_arb(model.viscous[i].value) * speed[i])
    return result


def reference_term(controlled: ControlledArm, eps0: float, at: Sample) -> arb:
    """−ε (w − εh)ᵀ C(q, q̇_d) h in a ball, W: what a moving goal adds to dV/dt of (11)."""
    if not any(at.speed):
        return arb(0)
    e, w = _balls(at.e), _balls(at.w)
    h = [controlled.controller.functions.h(x) for x in e]
    eps = to_arb(Fraction(eps0)) / (1 + dot(e, e).sqrt())
    y = [a - eps * b for a, b in zip(w, h, strict=True)]
    coriolis = controlled.fixed.at(*_turns(at), to_arb).coriolis(_balls(at.speed))
    return -eps * dot(y, [dot(row, h) for row in coriolis])


def _proved(value: Callable[[int], arb]) -> bool:
    """Whether a number is positive, with as many bits as that takes."""
    for bits in BITS:
        with precision(bits):
            result = value(bits)
        if result > 0:
            return True
        if result < 0:
            return False
    return False


def _exact(row: Row) -> tuple[Fraction, ...]:
    return tuple(map(Fraction, row))


def _balls(row: Row) -> list[arb]:
    return [arb(x) for x in row]


def _moving(row: Row, at: Sample) -> list[arb]:
    return _balls(row or (0.0,) * len(at.q))


def _turns(at: Sample) -> tuple[list[arb], list[arb]]:
    angles = _balls(at.q)
    return [x.sin() for x in angles], [x.cos() for x in angles]
