"""What a run passes through, judged again in balls: dV/dt and the torque at one exact state.

The doubles of a sample are exact rationals, so what is found here holds of that state, however the simulation
came to it.

References: ``reyes2019family`` (6), (11), (12), (21); ``johansson2017arb``.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction

from flint import arb

from lyapcheck.check.kinds.inertia import dot
from lyapcheck.check.loop.states import State, rate
from lyapcheck.check.numbers.balls import precision, to_arb
from lyapcheck.search.controlled_arm import ControlledArm

BITS = (128, 256, 512)
"""Precisions that are tried one after the other."""

Row = tuple[float, ...]


@dataclass(frozen=True)
class Sample:
    """A sample of a run: q and e in rad, w in rad/s, and q̇_d, q̈_d where the goal moves (empty: at rest).

    For a moving goal w = q̇ − q̇_d.
    """

    q: Row
    e: Row
    w: Row
    speed: Row = ()
    acceleration: Row = ()


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
    mass = model.mass_at(sines, cosines, to_arb)
    coriolis = model.coriolis_at(sines, cosines, rates, to_arb)
    gravity = model.gravity_at(sines, cosines, to_arb)
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
    coriolis = controlled.fixed.coriolis_at(*_turns(at), _balls(at.speed), to_arb)
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
