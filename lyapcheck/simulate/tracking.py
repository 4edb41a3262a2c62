"""The simulation of the tracking scheme (21), with what theory promises of it."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from operator import mul
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from flint import fmpq_mpoly

from lyapcheck._types import Array, Progress, silent
from lyapcheck.check.loop.closed_loop import ScalarForm
from lyapcheck.check.loop.states import State, value
from lyapcheck.check.numbers.balls import precision, to_arb
from lyapcheck.check.numbers.harmonics import harmonics
from lyapcheck.check.numbers.polynomials import root_above
from lyapcheck.constants import robot_constants
from lyapcheck.constants.arm import robot_bounds
from lyapcheck.control.gains import one_gain_set
from lyapcheck.errors import InputError, Problem, argument_problem
from lyapcheck.files.decimals import significant_down
from lyapcheck.lyapunov.scalar import scalar_form
from lyapcheck.robots.dynamics import FEW_JOINTS
from lyapcheck.robots.registry import arm_of
from lyapcheck.robots.trig import to_terms
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.simulate.breach import Monitor, fall_monitor, joint_monitor, limit_monitor, rate_monitor
from lyapcheck.simulate.closed_loop import Course, closed_loop
from lyapcheck.simulate.integrate import MAX_STEPS, Trajectory
from lyapcheck.simulate.reference import BITS, SECONDS, Reference, Suprema, above
from lyapcheck.simulate.results import BAND, imbalance, l2_of, motion_of
from lyapcheck.simulate.run import Motion
from lyapcheck.simulate.task import FASTEST, Setup, Task, gains_for, task_for

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots import RobotModel
    from lyapcheck.simulate.reference import Suprema
    from lyapcheck.simulate.run import Breach, Motion
    from lyapcheck.simulate.task import Gains, Setup

# --- How much torque (21) can ask of each motor, for all times and all motions from one start.
#
#     |τ_i| ≤ γ (k_pi + k_vi) + Σ_j sup|M_ij| sup|q̈_dj| + κ_i (v_d + b̄) v_d + sup|g_i| + b_i sup|q̇_di|
#
# where κ_i is k_c, or √(Σ_jk sup c_ijk²) if that is smaller, and b̄ bounds ‖w‖ = ‖q̇ − q̇_d‖: with ε₀ = 0 V is
# ½ wᵀMw + Σ k_pi U(e_i), which never grows under (21), so ‖w‖ ≤ b̄ = √(2 V(0)/λmin(M)). With q_d at rest
# this is the bound (9), joint by joint.

Row = tuple[Fraction, ...]


@dataclass(frozen=True)
class TorqueBounds:
    """What bounds the motions from one start, exact."""

    total: Row
    """(n,) of each |τ_i|, N·m."""
    error_rate: Fraction
    """b̄ ≥ ‖q̇ − q̇_d‖ at all times, rad/s."""


def torque_bounds(
    controlled: ControlledArm, suprema: Suprema, q: Sequence[float], e: Sequence[float], w: Sequence[float]
) -> TorqueBounds | None:
    """The bounds for motions from one state; none where h is unbounded or λmin(M) > 0 is not known.

    Args:
        controlled: controller and arm, at nominal numbers.
        suprema: of the reference.
        q: (n,) start in rad.
        e: (n,) q_d(0) − q.
        w: (n,) q̇ − q̇_d(0), rad/s.
    """
    gamma, constants = controlled.family.constants().gamma, robot_constants(controlled.model)
    least = constants.lambda_min.lower
    if gamma is None or least <= 0:
        return None
    start = State(*(tuple(map(Fraction, part)) for part in (q, e, w)))
    with precision(BITS):
        stored = value(controlled.arm, controlled.controller, Fraction(0), start, BITS)
        spin = above((2 * stored / to_arb(least)).sqrt())
    top, fixed, n = gamma.upper, controlled.fixed, controlled.n
    product = (suprema.speed + spin) * suprema.speed
    parts = (
        [top * (p + v) for p, v in zip(controlled.gains.kp, controlled.gains.kv, strict=True)],
        [
            sum((_size(x, n) * a for x, a in zip(row, suprema.acceleration, strict=True)), Fraction(0))
            for row in fixed.mass
        ],
        [k * product for k in _coriolis_rows(controlled, constants.k_c.upper)],
        [_size(entry, n) for entry in fixed.gravity],
        map(mul, controlled.arm.viscous, suprema.rate),
    )
    return TorqueBounds(tuple(sum(column, Fraction(0)) for column in zip(*parts, strict=True)), spin)


def _coriolis_rows(controlled: ControlledArm, k_c: Fraction) -> Row:
    """κ_i with |(C(q, x) y)_i| ≤ κ_i ‖x‖ ‖y‖ for all q, kg·m²: k_c or √(Σ_jk sup c_ijk²)."""
    n = controlled.n
    if n > FEW_JOINTS:
        return (k_c,) * n
    squares = [
        sum((_size(entry, n) ** 2 for row in layer for entry in row), Fraction(0))
        for layer in controlled.fixed.christoffel
    ]
    with precision(BITS):
        return tuple(min(k_c, above(to_arb(square).sqrt())) for square in squares)


def _size(poly: fmpq_mpoly, n: int) -> Fraction:
    """At least how large an entry of M, g or C can be at any angles.

    It is a sum of harmonics a cos(k·q) + b sin(k·q), and at most Σ (a² + b²)^½ in size.
    """
    pairs = harmonics(to_terms(poly), n).values()
    return sum(
        (max(abs(a), abs(b)) if not a or not b else root_above(a * a + b * b) for a, b in pairs), Fraction(0)
    )


# --- How fast V must fall under (21): dV/dt ≤ −[a b] Θ' [a b]ᵀ with a = ‖h(e)‖, b = ‖w‖ and v_d = sup ‖q̇_d‖.
#
#     θ'11 = ε (k − ε k_c v_d),   θ'12 = −½ ε (d + k_c v_d + ε c),   θ'22 = β − ε c,   ε = ε₀/(1 + ‖e‖)
#
# with k, β, c, d of ``lyapcheck.lyapunov.scalar``; at v_d = 0 it is that form. The inequality holds for every
# ε₀ > 0 and is proved in ``proofs/tracking.py``; where Θ' is positive definite as well, V falls.


HALVINGS = 48
DIGITS = 9
"""Significant digits of an ε₀."""


@dataclass(frozen=True)
class TrackingForm:
    """Θ' with rational numbers on the safe side: the form of (11), and ``turn`` = k_c v_d."""

    still: ScalarForm
    turn: Fraction

    def certifies(self, eps0: Fraction) -> bool:
        """Whether Θ'(ε) ≻ 0 for every ε in (0, ε₀].

        Soundness: θ'11/ε and θ'22 fall as ε grows, and where both are positive so does det Θ'/ε =
        (k − ε k_c v_d) θ'22 − ¼ ε (d + k_c v_d + ε c)²; so the signs at ε₀ decide.
        """
        form = self.still
        corner, low = form.stiffness - eps0 * self.turn, form.friction - eps0 * form.drift
        side = form.cross + self.turn + eps0 * form.drift
        return eps0 > 0 and corner > 0 and low > 0 and 4 * corner * low > eps0 * side**2

    def largest(self) -> Fraction | None:
        """The largest ε₀ that ``certifies``, rounded down to nine digits; none where there is none."""
        form = self.still
        if form.friction <= 0 or form.stiffness <= 0:
            return None
        high = 4 * form.stiffness * form.friction / (form.cross + self.turn) ** 2
        low = Fraction(0)
        for _ in range(HALVINGS):
            middle = (low + high) / 2
            low, high = (middle, high) if self.certifies(middle) else (low, middle)
        short = significant_down(low, DIGITS) if low else low
        return short if self.certifies(short) else None

    def promised(self, eps0: float, r: Array, a: Array, b: Array) -> Array:
        """−[a b] Θ' [a b]ᵀ at states of given ‖e‖, ‖h(e)‖ and ‖w‖, W; in doubles."""
        k, beta, c, d, turn = map(
            float, (self.still.stiffness, self.still.friction, self.still.drift, self.still.cross, self.turn)
        )
        eps = eps0 / (1.0 + r)
        corner, side, low = eps * (k - eps * turn), -eps / 2 * (d + turn + eps * c), beta - eps * c
        return np.asarray(-(corner * a * a + 2.0 * side * a * b + low * b * b))


def tracking_form(controlled: ControlledArm, speed: Fraction) -> TrackingForm | None:
    """Θ' of a controller on an arm at a bound v_d of ‖q̇_d‖ in rad/s; none where h is unbounded.

    Soundness: β_M and k_c are outside bounds at the arm's nominal numbers, v_d is what it is given.
    """
    still = scalar_form(controlled.gains, controlled.family.constants(), robot_bounds(controlled.model))
    return None if still is None else TrackingForm(still, robot_constants(controlled.model).k_c.upper * speed)


# --- The promise of (21) along a run: dV/dt below its form.


ROUNDING = 1e-9
"""How far dV/dt may be above its bound, relative to the larger of both: what doubles may do."""


def form_monitor(bound: Array | None) -> Monitor:
    """dV/dt ≤ −[a b] Θ' [a b]ᵀ at every sample; ``bound`` (N,) in W."""

    def monitor(setup: Setup, run: Motion) -> Breach | None:
        if bound is None:
            return None
        scale = ROUNDING * max(float(np.max(np.abs(bound))), float(np.max(np.abs(run.dV))))
        beyond = np.flatnonzero(run.dV > bound + scale)
        if not beyond.size:
            return None
        i = int(beyond[0])
        return run.broken("dV/dt ≤ −zᵀΘ'z", i, run.dV[i], bound[i], "W", False)

    return monitor


POINTS = 2001
"""Samples of a run."""


@dataclass(frozen=True)
class Promise:
    """What theory says of a run before it begins, at nominal numbers, by bounds without certificates."""

    suprema: Suprema
    largest: Fraction | None
    """The largest ε₀ for which Θ' is positive definite at v_d; none where there is none."""
    falls: bool
    """Whether Θ' is positive definite at the ε₀ watched, so that dV/dt < 0 away from e = ė = 0."""
    torque: TorqueBounds | None
    """Bounds of each |τ_i|; none for an unbounded controller."""
    reason: str = ""
    """Why there is no ε₀."""


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class TrackingRun(Motion):
    """A motion along a reference, where w = q̇ − q̇_d."""

    reference: Reference
    goal: Array
    """(N, n) q_d, rad."""
    speed: Array
    acceleration: Array
    bound: Array | None
    """(N,) W, −[a b] Θ' [a b]ᵀ, which dV/dt must not exceed; none for an unbounded controller."""
    promise: Promise
    band: float
    """rad, of ``indices.entered``."""
    work_balance: float
    """The largest difference of the arm's energy and the work done on it, relative to the larger of both."""

    @property
    def velocity(self) -> Array:
        """q̇, rad/s."""
        return self.speed + self.w

    @property
    def tightness(self) -> float:
        """The largest share of the seen fall of V that was promised: 1 where the form is met exactly.

        NaN where nothing falls, or nothing was promised.
        """
        if self.bound is None:
            return float("nan")
        inside = self.dV < -ROUNDING * np.max(np.abs(self.dV))
        return float(np.max(self.bound[inside] / self.dV[inside])) if inside.any() else float("nan")


# --- What a run is asked to do, once all of it is known to be possible.


def request_for(
    n: int,
    reference: Reference | None,
    q0: Sequence[float] | None,
    velocity: Sequence[float] | None,
    T: float | None,
    *,
    eps0: float | None,
    band: float = BAND,
    points: int = POINTS,
) -> Task:
    """The task of an arm of ``n`` joints; its goal is where the reference begins.

    Without a reference, because it could not be read, the rest is looked at all the same.

    Raises:
        InputError: all that is wrong with it at once.
    """
    problems: list[Problem] = []
    natural = SECONDS if reference is None else reference.duration
    seconds = natural if T is None else T
    try:
        task = task_for(n, (0.0,) * n, q0, velocity, seconds, eps0=eps0, points=points)
    except InputError as error:
        problems += error.problems
    if not 0.0 < band <= math.pi:
        rule = "must be more than 0 and at most 180°"
        problems.append(argument_problem("band_rad", f"{math.degrees(band):g}°", rule, "choose about 1°"))
    if reference is not None:
        problems += _reference_problems(n, reference)
    if problems:
        raise InputError(problems)
    return task


def _reference_problems(n: int, reference: Reference) -> Iterator[Problem]:
    write = "write another reference file"
    if reference.n != n:
        rule = f"moves {reference.n} joints, but the arm has {n}"
        yield argument_problem("reference", reference.kind, rule, write)
    speed = reference.suprema().speed
    if speed > FASTEST:
        rule = f"moves at {float(speed):.3g} rad/s, more than {FASTEST:g} rad/s"
        yield argument_problem("reference", reference.kind, rule, write)


# --- A tracking run: its start, its promises, and the run of its samples.


SHARE = Fraction(1, 2)
"""ε₀ as a share of the largest one for which Θ' is positive definite: there the form is singular."""
UNBOUNDED = "h is unbounded, and Θ' needs its bound γ"
NO_EPS0 = "no ε₀ > 0 makes Θ' positive definite; λmin(B) and λmin(K_p) must be positive"


class Tracking(Course[TrackingRun]):
    """The way along a reference.

    Args:
        gain_set: the controller.
        model: the arm.
        reference: q_d(t).
        task: a task that is known to be possible.
        eps0: as `track` has it.
        band: rad.
        points: samples of the run.
    """

    easier = 100.0  # only W feels the kinks of q̈_d at the ends of a motion, and it is no more than a check

    def __init__(
        self,
        gain_set: GainSet,
        model: RobotModel,
        reference: Reference,
        task: Task,
        *,
        eps0: float | None,
        band: float,
        points: int,
    ) -> None:
        gains, controlled = gains_for(gain_set, model.n), ControlledArm(gain_set, model)
        self.reference, self.band, suprema = reference, band, reference.suprema()
        self.form: TrackingForm | None = tracking_form(controlled, suprema.speed)
        first = reference.at(np.zeros(1))[0]
        e0, w0 = (first[0] - np.array(task.q0)).tolist(), (np.array(task.w0) - first[1]).tolist()
        largest = None if self.form is None else self.form.largest()
        if eps0 is None:
            eps0 = 0.0 if largest is None else float(largest * SHARE)
        self.promise = Promise(
            suprema,
            largest,
            falls=self.form is not None and self.form.certifies(Fraction(eps0)),
            torque=torque_bounds(controlled, suprema, task.q0, e0, w0),
            reason=UNBOUNDED if self.form is None else NO_EPS0 if largest is None else "",
        )
        setup = Setup(gains, model, task, eps0, controlled)
        super().__init__(setup, closed_loop(gains, model, moving=True), [*e0, *w0], points)

    def goal(self, t: Array) -> Array:
        return self.reference.at(t).reshape(t.size, -1)

    def watched(self, path: Trajectory) -> Array:
        """τ and e."""
        return np.hstack((self.signals(path)[0], path.y[:, : self.loop.n]))

    def run(self, path: Trajectory, accuracy: float) -> TrackingRun:
        n, t, y, setup = self.loop.n, path.t, path.y, self.setup
        goal, speed, acceleration = np.split(self.goal(t), 3, axis=1)
        tau, energy = self.signals(path)
        e, w, change = y[:, :n], y[:, n:-2], energy - energy[0]
        return TrackingRun(
            **motion_of(
                setup,
                "tracking",
                t,
                e,
                goal - e,
                w,
                tau,
                L2=l2_of(float(y[-1, -1]), float(t[-1])),
                complete=path.failure is None,
                band=self.band,
                speed=speed,
            ),
            acceleration=acceleration,
            accuracy=accuracy,
            reference=self.reference,
            goal=goal,
            bound=None if self.form is None else bound_of(self.form, setup.gains, setup.eps0, e, w),
            promise=self.promise,
            band=self.band,
            work_balance=imbalance(change - y[:, -2], change, y[:, -2]),
        )

    @staticmethod
    def monitors(run: TrackingRun) -> Sequence[Monitor]:
        torque = None if run.promise.torque is None else tuple(map(float, run.promise.torque.total))
        joints = joint_monitor("its bound for (21)", torque)
        return rate_monitor, fall_monitor, form_monitor(run.bound), joints, limit_monitor


def bound_of(form: TrackingForm, gains: Gains, eps0: float, e: Array, w: Array) -> Array:
    """−[a b] Θ' [a b]ᵀ at the samples, W."""
    r, a, b = (np.linalg.norm(x, axis=1) for x in (e, gains.family.h(e), w))
    return form.promised(eps0, r, a, b)


TOLERANCE = 1e-10
"""Relative tolerance of the first integration; the one handed back is ten times tighter."""


def track(
    gain_set: GainSet | str | Path,
    model: RobotModel | str | Path,
    reference: Reference,
    start_rad: Sequence[float] | None = None,
    velocity_rad: Sequence[float] | None = None,
    T: float | None = None,
    *,
    eps0: float | None = None,
    band_rad: float = BAND,
    points: int = POINTS,
    tolerance: float = TOLERANCE,
    max_steps: int = MAX_STEPS,
    stop: bool = True,
    on_progress: Progress | None = None,
) -> TrackingRun:
    """Simulate an arm along a reference under (21).

    ė = −w, M(q) ẇ = K_p h(e) − K_v h(w) − B w − C(q, q̇) w with e = q_d(t) − q and w = q̇ − q̇_d. The
    integration is done twice, the second time ten times tighter. The second run is returned, and the
    difference is its ``accuracy``.

    Args:
        gain_set: the controller, of any family, or the path of a gain file with one gain set.
        model: the arm, its name or its file; uncertain parameters are at their nominal values.
        reference: q_d(t).
        start_rad: (n,) start in rad. Default: 0.
        velocity_rad: (n,) initial q̇ in rad/s. Default: 0.
        T: seconds. Default: the duration of the reference.
        eps0: the ε₀ of V. Default: half of the largest with Θ' positive definite at v_d.
        band_rad: rad, for the time from which on each |e_i| stays within it.
        points: number of returned samples, evenly spaced with both ends.
        tolerance: relative tolerance of the first integration.
        max_steps: a budget for each integration.
        stop: end the run at the first state that violates a bound.
        on_progress: receives the fraction done.

    Raises:
        InputError: a request the arm or the reference cannot meet.
        SimulationFailed: the integrator stopped. The error has the run so far.
        PromiseBroken: a bound was violated. The error has the run up to that state.

    Examples:
        >>> from fractions import Fraction as F
        >>> from lyapcheck import paper_gain_file, read_gain_file
        >>> from lyapcheck.robots import load
        >>> from lyapcheck.simulate.reference import MinimumJerk
        >>> way = MinimumJerk((F(0),) * 3, (F(45), F(45), F(90)), F(2))
        >>> gain_set = read_gain_file(paper_gain_file("table2")).gains[0]
        >>> run = track(gain_set, load("buap3"), way, [0.1, 0.0, 0.0], T=1.0)
        >>> run.promise.falls, run.breach
        (True, None)

    Soundness: the motion is floating point, which is evidence and never a proof. ``promise`` is certified.
        The run is compared with it.

    References: (13), (20), (21) of ``reyes2019family``; ``proofs/tracking.py``.
    """
    gain_set, model = one_gain_set(gain_set), arm_of(model)
    way = (reference, start_rad, velocity_rad, T)
    task = request_for(model.n, *way, eps0=eps0, band=band_rad, points=points)
    course = Tracking(gain_set, model, reference, task, eps0=eps0, band=band_rad, points=points)
    return course.moved(tolerance, max_steps, stop, on_progress or silent)
