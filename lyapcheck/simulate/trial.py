"""Runs of the loop as a computer has it: sampled, late, quantised, saturated, with dry friction and load."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from lyapcheck._types import Array, Progress, silent
from lyapcheck.control.gains import one_gain_set
from lyapcheck.errors import argument_error
from lyapcheck.robots import arm_of
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.simulate.bench import (
    Bench,
    dry_friction,
    enough_substeps,
    memory_at,
    period_map,
    stiff_periods,
)
from lyapcheck.simulate.breach import noise_of
from lyapcheck.simulate.integrate import turns
from lyapcheck.simulate.results import BAND, l2_index, motion_of, observe, overshoots
from lyapcheck.simulate.run import FALLS, LIMIT_CYCLE, Run, SimulationFailed, Unrest
from lyapcheck.simulate.task import MOST_POINTS, Setup, set_up

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots import ArmLike


BENCH = Bench()
"""The settings of the published experiment."""
MOST_SUBSTEPS = 400
"""Steps of Runge–Kutta in a period; an arm that needs more is stiff, and moved by an implicit method."""
TOLERANCE = 1e-8
"""Relative, of the implicit method's first integration."""
RUNAWAY = 1e6
"""rad/s: a joint faster than this means that the sampled loop is unstable."""


def experiment(
    gain_set: GainSet | str | Path,
    model: ArmLike,
    target_rad: Sequence[float],
    start_rad: Sequence[float] | None = None,
    velocity_rad: Sequence[float] | None = None,
    T: float = 5.0,
    *,
    eps0: float | None = None,
    bench: Bench = BENCH,
    on_progress: Progress | None = None,
) -> Run:
    """Simulate an arm under (6), or under PD with gravity compensation, on a computer as in `Bench`.

    The arm is (1) with dry friction f_c tanh(w/creep) added, and with a load unknown to the controller.

    Args:
        gain_set: the controller, of any family, or the path of a gain file with one gain set.
        model: the arm, its name or its file; uncertain parameters and friction at nominal values.
        target_rad: (n,) goal in rad.
        start_rad: (n,) start in rad. Default: 0.
        velocity_rad: (n,) initial velocities in rad/s. Default: 0.
        T: seconds, cut to whole periods.
        eps0: the ε₀ of V. Default: 0, and V is the energy.
        bench: the loop as it is run.

    Returns:
        One sample per period, and overshoots between samples. ``tau`` is the torque held from then on, and
        ``dV`` the rate by (11). ``accuracy`` is the change with twice the integration steps. ``unrest`` is a
        limit cycle or a falling payload, see `unrest_of`.

    Raises:
        InputError: a task the arm cannot do, or an unknown payload on an arm without known links.
        SimulationFailed: the sampled loop diverges. The error has the run so far.

    Soundness: floating point throughout; dry friction is regularised, so a joint that should stick creeps,
    and most friction torques are assumptions of the model, which the run lists in ``notes``.

    References: ``reyes2019family``, Section 4 and Table 1.
    """
    gain_set, model = one_gain_set(gain_set), arm_of(model)
    setup = set_up(gain_set, model, target_rad, start_rad, velocity_rad, T=T, eps0=eps0)
    periods = math.floor(T / bench.T * (1 + 1e-12))
    if not 1 <= periods < MOST_POINTS:
        rule = f"is shorter than one period of {bench.T} s" if periods < 1 else f"has {periods} periods"
        raise argument_error("T", T, rule, "give a longer time" if periods < 1 else "give a shorter time")
    progress = on_progress or silent
    substeps = enough_substeps(model, bench)
    if substeps > MOST_SUBSTEPS:
        moved = partial(stiff_periods, setup, bench, periods)
        finer: tuple[float, float] = (TOLERANCE, TOLERANCE / 10)
    else:
        moved, finer = partial(_periods, setup, bench, periods), (substeps, 2 * substeps)
    rough = moved(finer[0])
    progress(1 / 3, "")
    fine = moved(finer[1])
    progress(1.0, "")
    return _run(setup, bench, rough, fine)


def _periods(setup: Setup, bench: Bench, periods: int, substeps: int) -> tuple[Array, Array]:
    """All periods in one call of a compiled map."""
    n, task = setup.model.n, setup.task
    whole = period_map(setup.controlled, bench, substeps).mapaccum(periods)
    start, goal = np.array([*task.q0, *task.w0, *memory_at(setup, bench)]), np.array(task.q_d)
    states, torques = (np.array(x).T for x in whole(start, np.repeat(goal[:, None], periods, axis=1)))
    return np.vstack((start, states))[:, : 2 * n], torques


def _run(setup: Setup, bench: Bench, rough: tuple[Array, Array], fine: tuple[Array, Array]) -> Run:
    n, (states, held) = setup.model.n, fine
    reached = min(_credible(*rough), _credible(*fine))
    complete = reached == len(states)
    t = np.linspace(0.0, bench.T * len(held), len(states))[:reached]
    tau, goal = np.vstack((held, held[-1:]))[:reached], np.array(setup.task.q_d)
    q, w = states[:reached, :n], states[:reached, n:]
    L2 = l2_index(t, goal - q) if reached > 1 else math.nan
    friction = ", ".join(f"{torque:g}" for torque in dry_friction(setup.model))
    dry = f"dry friction ({friction}) N·m · tanh(w/{bench.creep:g} rad/s): a stuck joint creeps"
    settings = f"torque held between samples: {bench.text}", dry
    way = (setup, "experiment", t, goal - q, q, w, tau)
    fields = motion_of(*way, L2=L2, complete=complete, settings=settings)
    V = fields["V"]
    run = Run(
        **fields,
        accuracy=float(np.max(np.abs(states - rough[0]))) if complete else math.nan,
        promises=observe(t, V, tau, setup.controlled, noise=noise_of(V), saturated=True),
        energy_balance=math.nan,
        loop=bench,
    )
    if not complete:
        raise SimulationFailed(f"{setup.title}: the sampled loop runs away at t = {t[-1]:.6g} s", run)
    e = goal - np.vstack((q[:1], turns(t, q, w)))
    unrest = unrest_of(run, setup.controlled, bench.unknown(setup.model, np.vstack((q, goal))))
    return replace(run, unrest=unrest, indices=replace(run.indices, overshoot=overshoots(e)))


def _credible(states: Array, torques: Array) -> int:
    """How many samples from the start are finite and no faster than any arm could be."""
    n = torques.shape[1]
    signals = np.hstack((states, np.vstack((torques, torques[-1:]))))
    good = np.all(np.isfinite(signals), axis=1) & np.all(np.abs(states[:, n:]) < RUNAWAY, axis=1)
    return int(good.size if good.all() else max(1, int(np.argmin(good))))


# --- What a sampled run shows against its gains: a limit cycle, or a load that falls.


LEAST_ANGLE, LEAST_SHARE = math.radians(0.05), 0.01
"""Peak to peak, rad, and as a share of a motor's limit: less is no limit cycle."""
LASTS = 0.9
"""A limit cycle keeps at least this share of what it was a fifth of the run before."""


def unrest_of(run: Run, controlled: ControlledArm, unknown: Array) -> Unrest | None:
    """What a run to its end shows against the gains; a load that falls goes before a limit cycle.

    A limit cycle: in the last fifth a joint turns back twice, its angle spans more than 0.05° or its torque
    more than 1 % of the motor's limit beside a steady drift, and not below 0.9 of the fifth before. A load
    falls where on the way or at the goal it asks no less than k_pi sup h, and the joint ends a degree away.

    Args:
        run: sampled.
        controlled: of the run.
        unknown: (N, n) N·m, what gravity asks on the way and at the goal beyond what the controller knows.

    Soundness: floating point, of one run: what is slower than a fifth of it is not seen.
    """
    if not run.complete:
        return None
    found = [*_falls(run, controlled, unknown)] or [*_cycles(run)]
    return replace(max(found)[1], others=len(found) - 1) if found else None


def _falls(run: Run, controlled: ControlledArm, unknown: Array) -> Iterator[tuple[float, Unrest]]:
    gamma, loads = controlled.family.constants().gamma, np.max(np.abs(unknown), axis=0)
    for i, (joint, load, kp) in enumerate(zip(run.joints, loads, controlled.kp.tolist(), strict=True)):
        most = math.inf if gamma is None else kp * gamma.float_upper
        end = abs(float(run.e[-1, i]))
        if load > 0 and load >= most and end > BAND:
            yield end, Unrest(FALLS, joint, math.degrees(end), float(load), most)


def _cycles(run: Run) -> Iterator[tuple[float, Unrest]]:
    part = len(run.t) // 5
    if part < 4:
        return
    last, before = slice(-part, None), slice(-2 * part, -part)
    for i, (joint, limit) in enumerate(zip(run.joints, run.torque_limit, strict=True)):
        signs = (np.sign(rate[rate != 0]) for rate in (run.w[last, i], run.w[before, i]))
        if min(np.count_nonzero(np.diff(sign)) for sign in signs) < 2:  # turns back less than twice
            continue
        spans = []
        for signal, least in ((run.q, LEAST_ANGLE), (run.tau, LEAST_SHARE * limit if limit else math.inf)):
            now, then = _span(signal[last, i]), _span(signal[before, i])
            spans.append((now, now / least if now >= LASTS * then else 0.0))
        (angle, wide), (torque, strong) = spans
        if max(wide, strong) > 1:
            yield max(wide, strong), Unrest(LIMIT_CYCLE, joint, math.degrees(angle), torque)


def _span(signal: Array) -> float:
    """Peak to peak beside the straight line through a signal."""
    t = np.linspace(-1.0, 1.0, len(signal))
    rest = signal - np.mean(signal) - t * (np.mean(t * signal) / np.mean(t * t))
    return float(np.ptp(rest))
