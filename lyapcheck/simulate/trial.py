"""The experiment as the bench would run it: sampled, quantised, saturated, with dry friction."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import casadi as ca
import numpy as np

from lyapcheck._types import Array, Progress, silent
from lyapcheck.control.gains import one_gain_set
from lyapcheck.errors import argument_error
from lyapcheck.robots.registry import arm_of
from lyapcheck.simulate.breach import noise_of
from lyapcheck.simulate.integrate import MAX_STEPS, Compiled, turns
from lyapcheck.simulate.results import l2_index, motion_of, observe, overshoots, torque_limits
from lyapcheck.simulate.run import Run, SimulationFailed
from lyapcheck.simulate.task import Gains, Setup, set_up

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots import RobotModel


# --- The bench as a discrete map: encoders, controller, hold, motors, and the arm between two samples.


@dataclass(frozen=True)
class Bench:
    """How the experiment was run.

    The controller reads the encoders every ``period`` seconds, takes the backward difference of two
    readings for the velocity, and holds its torque, cut at the motors' limits, until the next reading.
    Dry friction is f_c tanh(w/creep): a joint that should stick creeps at about ``creep`` rad/s instead.

    References: ``reyes2019family``, Section 4 and Table 1.
    """

    period: float = 2.5e-3
    creep: float = 1e-3


def period_map(gains: Gains, model: RobotModel, bench: Bench, substeps: int) -> Any:
    """The CasADi function ((q, w, last reading), q_d) ↦ (the same one period later, the torque held).

    The arm moves by ``substeps`` steps of the classical Runge–Kutta method.
    """
    n = model.n
    state, goal = ca.MX.sym("state", 3 * n), ca.MX.sym("q_d", n)
    torque, reading = controller(gains, model, bench)(state[:n], state[2 * n :], goal)
    arm = _runge_kutta(model, bench, bench.period / substeps).mapaccum(substeps)
    moved = arm(state[: 2 * n], ca.repmat(torque, 1, substeps))[:, -1]
    return ca.Function("period", [state, goal], [ca.vertcat(moved, reading), torque])


def controller(gains: Gains, model: RobotModel, bench: Bench) -> Any:
    """The CasADi function (q, last reading, q_d) ↦ (torque after the motors' limits, new reading)."""
    from lyapcheck.robots import graph

    n = model.n
    q, last, goal = (ca.SX.sym(name, n) for name in ("q", "last", "q_d"))
    reading = read_encoders(q, model.encoder)
    spring = ca.DM(gains.kp) * gains.family.casadi(goal - reading).h
    damper = ca.DM(gains.kv) * gains.family.casadi((reading - last) / bench.period).h
    most = ca.DM([math.inf if limit is None else limit for limit in torque_limits(model)])
    wanted = spring - damper + graph.gravity(model, reading)
    return ca.Function("controller", [q, last, goal], [ca.fmin(ca.fmax(wanted, -most), most), reading])


def read_encoders(q: Any, counts: Sequence[int | None]) -> Any:
    """The nearest encoder line to each angle in rad; the angle itself where the encoder is unknown."""
    line = [2.0 * math.pi / number if number else None for number in counts]
    return ca.vertcat(*(q[i] if a is None else a * ca.floor(q[i] / a + 0.5) for i, a in enumerate(line)))


def arm_rate(model: RobotModel, bench: Bench) -> Any:
    """The CasADi function (x, τ) ↦ ẋ of the arm with dry friction, x = (q, w)."""
    n = model.n
    x, torque = ca.SX.sym("x", 2 * n), ca.SX.sym("tau", n)
    rate = ca.vertcat(x[n:], _acceleration(model, bench, x[:n], x[n:], torque))
    return ca.Function("rate", [x, torque], [ca.densify(rate)])


def _runge_kutta(model: RobotModel, bench: Bench, h: float) -> Any:
    x, torque = ca.SX.sym("x", 2 * model.n), ca.SX.sym("tau", model.n)
    rate = arm_rate(model, bench)
    k1 = rate(x, torque)
    k2 = rate(x + h / 2 * k1, torque)
    k3 = rate(x + h / 2 * k2, torque)
    k4 = rate(x + h * k3, torque)
    return ca.Function("arm", [x, torque], [x + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)])


def _acceleration(model: RobotModel, bench: Bench, q: Any, w: Any, torque: Any) -> Any:
    """M⁻¹(τ − C w − g − B w − f_c tanh(w/creep)), that is (1) with dry friction added."""
    from lyapcheck.robots import graph

    dry = ca.DM(dry_friction(model)) * ca.tanh(w / bench.creep)
    drift = graph.coriolis(model, q, w) @ w + graph.gravity(model, q) + graph.viscous(model) @ w
    return graph.solve(graph.mass(model, q), torque - drift - dry)


def dry_friction(model: RobotModel) -> list[float]:
    """Coulomb torques in N·m, 0 where nothing is known."""
    return [0.0 if number is None else float(number.value) for number in model.coulomb]


def enough_substeps(model: RobotModel, bench: Bench) -> int:
    """Runge–Kutta steps in a period with which the steep part of the dry friction is integrated stably.

    The fastest rate is λmax(M⁻¹ (F_c/creep + B)), taken over a fixed set of postures with half as much again
    for the postures between; the method is stable up to 2.78 of it and is asked for 1.5.
    """
    from lyapcheck.robots import graph

    q = ca.SX.sym("q", model.n)
    mass = ca.Function("mass", [q], [graph.mass(model, q)])
    friction = np.diag(np.array(dry_friction(model)) / bench.creep + [float(b.value) for b in model.viscous])
    postures = np.random.default_rng(0).uniform(-math.pi, math.pi, size=(64, model.n))
    fastest = max(
        float(np.max(np.abs(np.linalg.eigvals(np.linalg.solve(np.array(mass(p)), friction)))))
        for p in postures
    )
    return max(5, math.ceil(1.5 * fastest * bench.period / 1.5))


# --- The bench experiment on a stiff arm: an implicit method between two samples.


def stiff_periods(setup: Setup, bench: Bench, periods: int, tolerance: float) -> tuple[Array, Array]:
    """(periods + 1, 2n) states and (periods, n) torques; what comes after a failure is NaN.

    Each period is integrated by LSODA, which turns to backward differentiation formulas where the arm is
    stiff.

    Args:
        setup: controller, arm and task.
        bench: period and creep rate.
        periods: how many.
        tolerance: relative error allowed per step; the absolute one is a hundredth of it.

    Soundness: an error estimate per step is not a bound: compare with a run at a smaller tolerance.

    References: ``petzold1983automatic``.
    """
    from scipy.integrate import odeint

    n, task = setup.model.n, setup.task
    x, tau = ca.SX.sym("x", 2 * n), ca.SX.sym("tau", n)
    arm = arm_rate(setup.model, bench)(x, tau)
    rate = Compiled(ca.Function("rate", [x, tau], [arm]))
    slope = Compiled(ca.Function("slope", [x, tau], [ca.densify(ca.jacobian(arm, x))]))
    control, goal = controller(setup.gains, setup.model, bench), np.array(task.q_d)
    states, torques = np.full((periods + 1, 2 * n), np.nan), np.full((periods, n), np.nan)
    states[0] = *task.q0, *task.w0
    reading: Any = np.array(task.q0) - bench.period * np.array(task.w0)
    options = {"rtol": tolerance, "atol": tolerance / 100, "mxstep": MAX_STEPS, "full_output": True}
    for k in range(periods):
        held, reading = control(states[k, :n], reading, goal)
        torques[k] = np.array(held).ravel()
        ends, info = odeint(
            lambda y, _, tau: rate(y, tau),
            states[k],
            [0.0, bench.period],
            (torques[k],),
            lambda y, _, tau: slope(y, tau),
            **options,
        )
        if info["message"] != "Integration successful.":
            break
        states[k + 1] = ends[1]
    return states, torques


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
    rough = moved(finer[0])
    progress(1 / 3, "")
    fine = moved(finer[1])
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


def _run(setup: Setup, bench: Bench, rough: tuple[Array, Array], fine: tuple[Array, Array]) -> Run:
    n, (states, held) = setup.model.n, fine
    reached = min(_credible(*rough), _credible(*fine))
    complete = reached == len(states)
    t = np.linspace(0.0, bench.period * len(held), len(states))[:reached]
    tau, goal = np.vstack((held, held[-1:]))[:reached], np.array(setup.task.q_d)
    q, w = states[:reached, :n], states[:reached, n:]
    L2 = l2_index(t, goal - q) if reached > 1 else math.nan
    notes = _notes(setup, bench)
    fields = motion_of(setup, "experiment", t, goal - q, q, w, tau, L2=L2, complete=complete, notes=notes)
    V = fields["V"]
    run = Run(
        **fields,
        accuracy=float(np.max(np.abs(states - rough[0]))) if complete else math.nan,
        promises=observe(t, V, tau, setup.gains, setup.model, noise=noise_of(V), saturated=True),
        energy_balance=math.nan,
    )
    if not complete:
        raise SimulationFailed(f"{setup.title}: the sampled loop runs away at t = {t[-1]:.6g} s", run)
    e = goal - np.vstack((q[:1], turns(t, q, w)))
    return replace(run, indices=replace(run.indices, overshoot=overshoots(e)))


def _credible(states: Array, torques: Array) -> int:
    """How many samples from the start are finite and no faster than any arm could be."""
    n = torques.shape[1]
    signals = np.hstack((states, np.vstack((torques, torques[-1:]))))
    good = np.all(np.isfinite(signals), axis=1) & np.all(np.abs(states[:, n:]) < RUNAWAY, axis=1)
    return int(good.size if good.all() else max(1, int(np.argmin(good))))


def _notes(setup: Setup, bench: Bench) -> tuple[str, ...]:
    friction = ", ".join(f"{torque:g}" for torque in dry_friction(setup.model))
    hold = f"torque held for {1000 * bench.period:g} ms, velocity by the backward difference of the readings"
    dry = f"dry friction ({friction}) N·m · tanh(w/{bench.creep:g} rad/s): a stuck joint creeps"
    return hold, dry
