"""The loop as a computer runs it, as a discrete map: encoders, controller, delay, motors, the arm between."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import casadi as ca
import numpy as np

from lyapcheck._types import Array
from lyapcheck.control.sampling import LoopRecord
from lyapcheck.errors import InputError, argument_error, argument_problem
from lyapcheck.files.decimals import decimal_text
from lyapcheck.files.loop import VELOCITIES
from lyapcheck.lyapunov import graph
from lyapcheck.lyapunov.along import solve_definite
from lyapcheck.robots.dynamics import Chain
from lyapcheck.robots.fields import PAYLOAD, Vary
from lyapcheck.robots.numeric import NumericModel
from lyapcheck.robots.vary import varied
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.simulate.integrate import MAX_STEPS, Compiled
from lyapcheck.simulate.task import Setup, motor_limits

if TYPE_CHECKING:
    from lyapcheck.robots import RobotModel

COARSEST = 5e-4
"""s: the longest step of the arm between two samples."""
SHORTEST, LATEST = 1e-6, 1000
"""s between two samples, and samples of delay."""
UNSAMPLED = Fraction(1, 4000)
"""s: the period of a record that says nothing of a rate, then without delay."""


@dataclass(frozen=True)
class Bench(LoopRecord):
    """The loop on a computer, as in `LoopRecord`. The default is the published experiment.

    In every period the controller reads the encoders, estimates the velocity and computes (6) within the
    motor limits. The torque acts ``delay`` samples later. Until then the motors hold gravity. The
    arm carries the unknown payload at the centre of mass of its last link, and gravity is larger than the
    controller's by the share of ``gravity_error``. Intervals are all equal.

    A float stands for its shortest decimal.

    Args:
        creep: rad/s. Dry friction is f_c tanh(w/creep): a joint that should stick creeps about so fast.

    Raises:
        InputError: a period, delay or way to a velocity that no loop can have.

    References: ``reyes2019family``, Section 4 and Table 1.
    """

    period: Fraction | None = Fraction(1, 400)
    delay: int = 0
    creep: float = 1e-3

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            if isinstance(value, float) and math.isfinite(value) and name != "creep":
                object.__setattr__(self, name, Fraction(repr(value)))  # the decimal that was typed
        whole = isinstance(self.delay, int) and 0 <= self.delay <= LATEST
        rules = (
            ("period", SHORTEST <= self.T <= 1, f"must be from {SHORTEST:g} to 1 s", "give 0.001 for 1 kHz"),
            ("delay", whole, f"must be 0 to {LATEST} samples", "give whole samples, such as 1"),
            ("velocity", self.velocity in VELOCITIES, "is unknown", f"use one of {', '.join(VELOCITIES)}"),
            ("creep", self.creep > 0, "must be positive", "give rad/s, such as 0.001"),
        )
        wrong = [argument_problem(key, getattr(self, key), *say) for key, good, *say in rules if not good]
        if wrong:
            raise InputError(wrong)

    @classmethod
    def of(cls, record: LoopRecord) -> Bench:
        """The bench that runs a record; of one without a rate at 4 kHz, at once."""
        period = record.period or UNSAMPLED
        return cls(**vars(record) | {"period": period, "delay": record.delay if record.period else 0})

    @property
    def T(self) -> float:
        """The period in s."""
        return float(UNSAMPLED if self.period is None else self.period)

    @property
    def pull(self) -> float:
        """By which gravity is multiplied, to what the controller takes it for."""
        return 1.0 + float(self.gravity_error)

    def carried(self, model: RobotModel) -> RobotModel:
        """The arm that moves: with the payload that the controller does not know.

        Raises:
            InputError: a payload on an arm whose links are not known.
        """
        load = Fraction(self.unknown_payload)
        if not load:
            return model
        if not isinstance(model.dynamics, Chain):
            rule = f"needs the links of the arm, and {model.name} is given by its inertia matrix"
            repair = "leave it out, or give an arm file with links"
            raise argument_error("unknown_payload", decimal_text(load), rule, repair)
        return varied(model, [Vary(PAYLOAD, load, load)])

    def unknown(self, model: RobotModel, q: Array) -> Array:
        """Δg(q), N·m: gravity beyond what the controller knows, (…, n) angles in rad to (…, n)."""
        known, real = (NumericModel(arm).gravity(q) for arm in (model, self.carried(model)))
        return np.asarray(self.pull * real - known)

    def counts(self, model: RobotModel) -> Sequence[int | None]:
        """Counts per turn of each encoder."""
        return model.encoder if self.encoder is None else (self.encoder,) * model.n


def period_map(controlled: ControlledArm, bench: Bench, substeps: int) -> Any:
    """The CasADi function ((q, w, memory), q_d) ↦ (the same one period later, the torque held).

    The arm moves by ``substeps`` steps of the classical Runge–Kutta method.
    """
    n, control, h = controlled.n, controller(controlled, bench), bench.T / substeps
    state, goal = ca.MX.sym("state", 2 * n + control.numel_in(2)), ca.MX.sym("q_d", n)
    torque, memory = control(state[:n], state[n : 2 * n], state[2 * n :], goal)
    x, held, rate = ca.SX.sym("x", 2 * n), ca.SX.sym("tau", n), arm_rate(controlled.model, bench)
    k1 = rate(x, held)
    k2 = rate(x + h / 2 * k1, held)
    k3 = rate(x + h / 2 * k2, held)
    k4 = rate(x + h * k3, held)
    arm = ca.Function("arm", [x, held], [x + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)])
    moved = arm.mapaccum(substeps)(state[: 2 * n], ca.repmat(torque, 1, substeps))[:, -1]
    return ca.Function("period", [state, goal], [ca.vertcat(moved, memory), torque])


def controller(controlled: ControlledArm, bench: Bench) -> Any:
    """The CasADi function (q, w, memory, q_d) ↦ (the torque that the motors hold from now on, new memory).

    The memory holds the last reading, past velocities, the low-pass filter's, and torques under way.
    """
    n, model, past = controlled.n, controlled.model, len(bench.filter) - 1
    q, w, goal = (ca.SX.sym(name, n) for name in ("q", "w", "q_d"))
    memory = ca.SX.sym("memory", n * (1 + past + (bench.lowpass is not None) + bench.delay))
    last, *rest = ca.vertsplit(memory, n)
    reading = read_encoders(q, bench.counts(model))
    velocity = [w if bench.velocity == "measured" else (reading - last) / bench.T, *rest[:past]]
    smooth, kept = sum(float(tap) * v for tap, v in zip(bench.filter, velocity, strict=True)), []
    if bench.lowpass is not None:
        before = rest[past]
        smooth = before + (1 - math.exp(-2 * math.pi * float(bench.lowpass) * bench.T)) * (smooth - before)
        kept = [smooth]
    known = ca.DM(controlled.kp), ca.DM(controlled.kv), controlled.family.casadi
    wanted = ca.vertcat(*graph.at_symbols(model, reading, goal - reading, smooth, *known).torque())
    most = ca.DM(motor_limits(model))
    held, *later = [*rest[past + len(kept) :], ca.fmin(ca.fmax(wanted, -most), most)]
    new = ca.vertcat(reading, *velocity[:past], *kept, *later)
    return ca.Function("controller", [q, w, memory, goal], [held, new])


def memory_at(setup: Setup, bench: Bench) -> Array:
    """What the controller remembers at the start: the arm came with its initial rates, and was held there."""
    q, w, counts = np.array(setup.task.q0), np.array(setup.task.w0), bench.counts(setup.model)
    last, now = (np.array(read_encoders(ca.DM(x), counts))[:, 0] for x in (q - bench.T * w, q))
    most = np.array(motor_limits(setup.model))
    held = np.clip(NumericModel(setup.model).gravity(now), -most, most)
    smooth = [] if bench.lowpass is None else [float(sum(bench.filter)) * w]
    return np.concatenate([last, *[w] * (len(bench.filter) - 1), *smooth, *[held] * bench.delay])


def read_encoders(q: Any, counts: Sequence[int | None]) -> Any:
    """The nearest encoder line to each angle in rad; the angle itself where the encoder is unknown."""
    line = [2.0 * math.pi / number if number else None for number in counts]
    return ca.vertcat(*(q[i] if a is None else a * ca.floor(q[i] / a + 0.5) for i, a in enumerate(line)))


def arm_rate(model: RobotModel, bench: Bench) -> Any:
    """The CasADi function (x, τ) ↦ ẋ of the arm with load and dry friction, x = (q, w).

    ẇ = M⁻¹(τ − C w − g − B w − f_c tanh(w/creep)), that is (1) with dry friction added.
    """
    n, arm = model.n, bench.carried(model)
    x, torque = ca.SX.sym("x", 2 * n), ca.SX.sym("tau", n)
    q, w = x[:n], x[n:]
    dry = ca.DM(dry_friction(arm)) * ca.tanh(w / bench.creep)
    at, viscous = graph.at_angles(arm, q), ca.DM([float(b.value) for b in arm.viscous])
    gravity = bench.pull * ca.vertcat(*at.gravity())
    drift = graph.matrix(at.coriolis(ca.vertsplit(w))) @ w + gravity + viscous * w
    acceleration = solve_definite(at.mass(), ca.vertsplit(torque - drift - dry))
    return ca.Function("rate", [x, torque], [ca.densify(ca.vertcat(w, *acceleration))])


def dry_friction(model: RobotModel) -> list[float]:
    """Coulomb torques in N·m, 0 where nothing is known."""
    return [0.0 if number is None else float(number.value) for number in model.coulomb]


def enough_substeps(model: RobotModel, bench: Bench) -> int:
    """Runge–Kutta steps in a period with which the steep part of the dry friction is integrated stably.

    The fastest rate is λmax(M⁻¹ (F_c/creep + B)), taken over a fixed set of postures with half as much again
    for the postures between; the method is stable up to 2.78 of it and is asked for 1.5.
    """
    q = ca.SX.sym("q", model.n)
    mass = ca.Function("mass", [q], [graph.matrix(graph.at_angles(model, q).mass())])
    friction = np.diag(np.array(dry_friction(model)) / bench.creep + [float(b.value) for b in model.viscous])
    postures = np.random.default_rng(0).uniform(-math.pi, math.pi, size=(64, model.n))
    fastest = max(
        float(np.max(np.abs(np.linalg.eigvals(np.linalg.solve(np.array(mass(p)), friction)))))
        for p in postures
    )
    return max(math.ceil(bench.T / COARSEST), math.ceil(1.5 * fastest * bench.T / 1.5))


# --- The same on a stiff arm: an implicit method between two samples.


def stiff_periods(setup: Setup, bench: Bench, periods: int, tolerance: float) -> tuple[Array, Array]:
    """(periods + 1, 2n) states and (periods, n) torques; what comes after a failure is NaN.

    Each period is integrated by LSODA, which turns to backward differentiation formulas where the arm is
    stiff.

    Args:
        setup: controller, arm and task.
        bench: the loop.
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
    control, goal = controller(setup.controlled, bench), np.array(task.q_d)
    states, torques = np.full((periods + 1, 2 * n), np.nan), np.full((periods, n), np.nan)
    states[0] = *task.q0, *task.w0
    memory: Any = memory_at(setup, bench)
    options = {"rtol": tolerance, "atol": tolerance / 100, "mxstep": MAX_STEPS, "full_output": True}
    for k in range(periods):
        held, memory = control(states[k, :n], states[k, n:], memory, goal)
        torques[k] = np.array(held).ravel()
        ends, info = odeint(
            lambda y, _, tau: rate(y, tau),
            states[k],
            [0.0, bench.T],
            (torques[k],),
            lambda y, _, tau: slope(y, tau),
            **options,
        )
        if info["message"] != "Integration successful.":
            break
        states[k + 1] = ends[1]
    return states, torques
