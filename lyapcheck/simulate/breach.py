"""The first promise that a run breaks, with the state that broke it."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

import numpy as np
from flint import arb

from lyapcheck._types import Array
from lyapcheck.check.loop.states import State, rate
from lyapcheck.check.numbers.balls import precision, to_arb
from lyapcheck.family.base import arrays
from lyapcheck.lyapunov.along import AtState
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.simulate.run import Breach, Motion, Sample
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


def noise_of(V: Array) -> float:
    """J, how far V may rise between two samples before it counts as a rise."""
    return V_NOISE * max(float(np.max(np.abs(V))), LEAST_ENERGY)


def first_breach(found: Iterable[Breach | None]) -> Breach | None:
    """The earliest of some breaches."""
    result = [breach for breach in found if breach is not None]
    return min(result, key=lambda breach: breach.index, default=None)


def first_above(
    run: Motion, promise: str, signal: Array, limit: Array, unit: str, forgiven: float | Array
) -> Breach | None:
    """The first sample at which a signal (N,) is above its limit (N,) by more than is forgiven."""
    beyond = np.flatnonzero(signal > limit + forgiven)
    if not beyond.size:
        return None
    i = int(beyond[0])
    return run.broken(promise, i, signal[i], limit[i], unit, False)


def rise_of_rate(setup: Setup, run: Motion) -> Breach | None:
    """dV/dt ≤ 0 at every sample, with the run's ε₀; with ε₀ = 0 it holds by (14) and nothing is looked at."""
    if run.eps0 == 0.0:
        return None
    high = np.flatnonzero(run.dV > RATE_NOISE * np.max(np.abs(run.dV)))
    for i in high[:CANDIDATES].tolist():
        if rises(setup.controlled, run.eps0, run.sample(i)):
            return run.broken(f"dV/dt ≤ 0 for ε₀ = {run.eps0:g}", i, run.dV[i], 0.0, "W", True)
    return None


def rise_of_V(run: Motion) -> Breach | None:
    """V does not rise between samples by more than the run's own error."""
    before = np.append(np.inf, run.V[:-1])
    return first_above(run, f"V falls for ε₀ = {run.eps0:g}", run.V, before, "J", noise_of(run.V))


def beyond_limits(setup: Setup, run: Motion) -> Breach | None:
    """Each |τ_i| is at most what the motor can give, where that is known."""
    result = []
    for joint, number in enumerate(setup.model.torque_limit):
        most, size = math.inf if number is None else float(number.value), np.abs(run.tau[:, joint])
        promise = f"|τ| of {run.joints[joint]} within the motor's limit"
        for i in np.flatnonzero(size > most)[:CANDIDATES].tolist():
            if number is not None and exceeds(setup.controlled, joint, number.value, run.sample(i)):
                result.append(run.broken(promise, i, size[i], most, "N·m", True))
                break
    return first_breach(result)


def beyond_bounds(run: Motion, name: str, bounds: Sequence[float] | None) -> Breach | None:
    """Each |τ_i| is at most a bound, of which no more than rounding is forgiven."""
    return first_breach(
        first_above(
            run,
            f"|τ| of {joint} within {name}",
            np.abs(run.tau[:, i]),
            np.full(len(run.tau), bounds[i]),
            "N·m",
            bounds[i] * ROUNDING,
        )
        for i, joint in enumerate(run.joints if bounds is not None else ())
        if bounds is not None
    )


def beyond_norm(run: Motion, name: str, bound: float | None) -> Breach | None:
    """‖τ‖ is at most a bound, of which no more than rounding is forgiven."""
    most = math.inf if bound is None else bound * (1 + ROUNDING)
    norm = np.linalg.norm(run.tau, axis=1)
    return first_above(run, f"‖τ‖ within {name}", norm, np.full(norm.size, most), "N·m", 0.0)


# --- What a run passes through, judged again in balls: dV/dt and the torque at one exact state.
#
# The doubles of a sample are exact rationals, so what is found here holds of that state, however the
# simulation came to it.
#
# References: ``reyes2019family`` (6), (11), (12), (21); ``johansson2017arb``.


BITS = (128, 256, 512)
"""Precisions that are tried one after the other."""
BALLS = replace(arrays(), sin=arb.sin, cos=arb.cos, sqrt=arb.sqrt, lift=to_arb)
"""What torques ask of it; the other functions of NumPy take no balls."""


@dataclass(frozen=True)
class InBalls:
    """h of a ball."""

    h: arb


def at_balls(controlled: ControlledArm, at: Sample) -> AtState:
    """A sample in balls of the current precision; gains per radian."""
    unit = 180 / arb.pi() if controlled.per_degree else arb(1)
    kp, kv = ([to_arb(k) * unit for k in row] for row in (controlled.gains.kp, controlled.gains.kv))
    q, e, w, speed, acceleration = ([arb(x) for x in row] for row in vars(at).values())
    viscous, h = [to_arb(x.value) for x in controlled.fixed.viscous], controlled.controller.functions.h
    goal: dict[str, Any] = {"speed": speed, "acceleration_d": acceleration}
    return AtState(controlled.fixed, BALLS, lambda x: InBalls(h(x)), q, e, w, kp, kv, viscous, **goal)


def rises(controlled: ControlledArm, eps0: float, at: Sample) -> bool:
    """Whether dV/dt > 0 at the sample is proved.

    Soundness: ``True`` is a proof about the state; ``False`` says nothing.
    """
    exact, state = Fraction(eps0), State(*(tuple(map(Fraction, row)) for row in (at.q, at.e, at.w)))

    def value(bits: int) -> arb:
        still = rate(controlled.arm, controlled.controller, exact, state, bits)
        moving = any(at.speed)
        return still + at_balls(controlled, at).rate_of_moving_goal(to_arb(exact)) if moving else still

    return _proved(value)


def exceeds(controlled: ControlledArm, joint: int, limit: Fraction, at: Sample) -> bool:
    """Whether |τ_i| of (6), or of (21) for a moving goal, is proved to be larger than a limit in N·m.

    Soundness: as `rises`.
    """
    return _proved(lambda bits: abs(at_balls(controlled, at).torque()[joint]) - to_arb(limit))


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
