"""The experiment as the bench would run it: sampled, quantised, saturated, with dry friction."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from lyapcheck._types import Array, Progress, silent
from lyapcheck.control.gains import one_gain_set
from lyapcheck.errors import argument_error
from lyapcheck.robots.registry import arm_of
from lyapcheck.simulate.bench import Bench, dry_friction, enough_substeps, period_map
from lyapcheck.simulate.extremes import turns
from lyapcheck.simulate.indices import l2_index, overshoots
from lyapcheck.simulate.results import Motion, run_of
from lyapcheck.simulate.run import Run, SimulationFailed
from lyapcheck.simulate.setup import Setup, set_up
from lyapcheck.simulate.stiff import stiff_periods

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots import RobotModel


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
    model: RobotModel | str | Path,
    q_d: Sequence[float],
    q0: Sequence[float] | None = None,
    w0: Sequence[float] | None = None,
    T: float = 5.0,
    *,
    eps0: float | None = None,
    bench: Bench = BENCH,
    on_progress: Progress | None = None,
) -> Run:
    """Move an arm under (6), or under PD with gravity compensation, the way the bench did it.

    Every period: read the encoders, take the backward difference for the velocity, compute the torque, cut it
    at the motors' limits, hold it. The arm is (1) with dry friction f_c tanh(w/creep) added.

    Args:
        gain_set: the controller, of any family, or the path of a gain file with one gain set.
        model: the arm, its name or its file; uncertain parameters and friction at nominal values.
        q_d: (n,) goal in rad.
        q0: (n,) start in rad; home if missing.
        w0: (n,) initial rates in rad/s; rest if missing.
        T: seconds, cut to whole periods.
        eps0: the ε₀ of V; 0 if missing, and then V is the energy.
        bench: period and creep rate.
        on_progress: receives the fraction done.

    Returns:
        One sample a period, overshoots of what lies between; ``tau`` is the torque held from then on, ``dV``
        what (11) gives at the states passed, and ``accuracy`` the change when the arm is integrated with
        twice the steps.

    Raises:
        InputError: a task the arm cannot be given.
        SimulationFailed: the sampled loop runs away; carries what was reached.

    Soundness: floating point throughout; dry friction is regularised, so a joint that should stick creeps,
    and most friction torques are assumptions of the model, which the run lists in ``notes``.

    References: ``reyes2019family``, Section 4 and Table 1.
    """
    gain_set, model = one_gain_set(gain_set), arm_of(model)
    setup = set_up(gain_set, model, q_d, q0, w0, T=T, eps0=eps0)
    periods = math.floor(T / bench.period * (1 + 1e-12))
    if periods < 1:
        raise argument_error("T", T, f"is shorter than one period of {bench.period} s", "give a longer time")
    progress = on_progress or silent
    substeps = enough_substeps(model, bench)
    if substeps > MOST_SUBSTEPS:
        moved = partial(stiff_periods, setup, bench, periods)
        finer: tuple[float, float] = (TOLERANCE, TOLERANCE / 10)
    else:
        moved, finer = partial(_periods, setup, bench, periods), (substeps, 2 * substeps)
    rough = _motion(bench, *moved(finer[0]))
    progress(1 / 3, "")
    fine = _motion(bench, *moved(finer[1]))
    progress(1.0, "")
    return _run(setup, bench, rough, fine)


def _periods(setup: Setup, bench: Bench, periods: int, substeps: int) -> tuple[Array, Array]:
    """All periods in one call of a compiled map."""
    n, task = setup.model.n, setup.task
    whole = period_map(setup.gains, setup.model, bench, substeps).mapaccum(periods)
    before = np.array(task.q0) - bench.period * np.array(task.w0)
    start, goal = np.array([*task.q0, *task.w0, *before]), np.array(task.q_d)
    states, torques = (np.array(x).T for x in whole(start, np.repeat(goal[:, None], periods, axis=1)))
    return np.vstack((start, states))[:, : 2 * n], torques


def _motion(bench: Bench, states: Array, torques: Array) -> Motion:
    n, periods = torques.shape[1], len(torques)
    t = np.linspace(0.0, bench.period * periods, periods + 1)
    return Motion("experiment", t, states[:, :n], states[:, n:], np.vstack((torques, torques[-1:])))


def _run(setup: Setup, bench: Bench, rough: Motion, fine: Motion) -> Run:
    reached = min(_credible(rough), _credible(fine))
    complete = reached == fine.t.size
    kept = Motion(fine.kind, fine.t[:reached], fine.q[:reached], fine.w[:reached], fine.tau[:reached])
    run = run_of(
        setup,
        kept,
        accuracy=_difference(rough, fine) if complete else math.nan,
        energy_balance=math.nan,
        L2=l2_index(kept.t, np.array(setup.task.q_d) - kept.q) if reached > 1 else math.nan,
        complete=complete,
        saturated=True,
        notes=_notes(setup, bench),
    )
    if complete:
        e = np.array(setup.task.q_d) - np.vstack((kept.q[:1], turns(kept.t, kept.q, kept.w)))
        run = replace(run, indices=replace(run.indices, overshoot=overshoots(e)))
    if not complete:
        raise SimulationFailed(f"{setup.title}: the sampled loop runs away at t = {kept.t[-1]:.6g} s", run)
    return run


def _credible(motion: Motion) -> int:
    """How many samples from the start are finite and no faster than any arm could be."""
    signals = np.hstack((motion.q, motion.w, motion.tau))
    good = np.all(np.isfinite(signals), axis=1) & np.all(np.abs(motion.w) < RUNAWAY, axis=1)
    return int(good.size if good.all() else max(1, int(np.argmin(good))))


def _difference(rough: Motion, fine: Motion) -> float:
    """The largest change of q or w between two motions."""
    return float(max(np.max(np.abs(fine.q - rough.q)), np.max(np.abs(fine.w - rough.w))))


def _notes(setup: Setup, bench: Bench) -> tuple[str, ...]:
    friction = ", ".join(f"{torque:g}" for torque in dry_friction(setup.model))
    hold = f"torque held for {1000 * bench.period:g} ms, velocity by the backward difference of the readings"
    dry = f"dry friction ({friction}) N·m · tanh(w/{bench.creep:g} rad/s): a stuck joint creeps"
    return hold, dry
