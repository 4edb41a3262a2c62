"""Tasks of a user in one call each: names, paths or objects in, answers out, angles in degrees."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

from lyapcheck.errors import InputError, argument_error, told_as

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from numpy.typing import ArrayLike

    from lyapcheck._types import Array, Progress
    from lyapcheck.answers.bounds import Comparisons
    from lyapcheck.answers.export import Export
    from lyapcheck.answers.tune.bench import BenchTuning
    from lyapcheck.check.statement import Statement
    from lyapcheck.claims.decision import Decision
    from lyapcheck.control.gains import GainFile, GainSet
    from lyapcheck.robots import ArmLike, RobotModel
    from lyapcheck.simulate.run import Run
    from lyapcheck.simulate.task import Task


def tune_for_targets(
    robot: ArmLike,
    *,
    members: Sequence[int] = (1,),
    overshoot: float | None = None,
    settle: float | None = None,
    peak_share: float | None = None,
    rest_error: float | None = None,
    target_deg: Sequence[float] | None = None,
    start_deg: Sequence[float] | None = None,
    seconds: float = 5.0,
    on_progress: Progress | None = None,
) -> BenchTuning:
    """Find gains that meet targets in a simulated motion and that the gate accepts.

    Args:
        robot: an arm, its name or the path of its file.
        members: the orders m to try.
        overshoot: largest overshoot, % of the step.
        settle: largest settling time (2 %), s.
        peak_share: largest share of each torque limit, in (0, 1].
        rest_error: largest steady-state error under dry friction, degrees.
        target_deg: desired joint angles. Default: 45 degrees per joint.
        start_deg: initial joint angles. Default: 0.
        seconds: duration of the motion.
        on_progress: receives the fraction done.

    Raises:
        InputError: the arm or a target cannot be used, or no target is given.

    Soundness: the gate proves stability and torque limits. The motion is simulated.
    """
    from lyapcheck.answers.tune.search import tune_for
    from lyapcheck.answers.tune.trial import Trials, Wishes
    from lyapcheck.robots import arm_of

    names = ("overshoot", "settle", "peak_share", "rest_error")
    with told_as({f"--{name.replace('_', '-')}": name for name in names}):
        wishes = Wishes(overshoot, settle, peak_share, rest_error)
    if not wishes.given:
        raise argument_error("targets", "", "are missing", "give overshoot=5, settle=1.5 or rest_error=2")
    model = arm_of(robot)
    task = _task(model, target_deg, start_deg, seconds)
    return tune_for(model, Trials(wishes, (task,)), members, on_progress=on_progress)


def bounds(
    gain_file: GainFile | str | Path,
    robot: ArmLike | None = None,
    *,
    target_deg: Sequence[float] | None = None,
    start_deg: Sequence[float] | None = None,
    seconds: float = 10.0,
    within_deg: float = 1.0,
) -> Comparisons:
    """Bound the steady-state error under dry friction and unknown gravity, and simulate a motion.

    Args:
        gain_file: a gain file or its path.
        robot: an arm, its name or the path of its file, instead of the arm of the gain file.
        target_deg: desired joint angles. Default: 45 degrees per joint.
        start_deg: initial joint angles. Default: 0.
        seconds: duration of the motion.
        within_deg: error for the simulated time, degrees.

    Raises:
        InputError: the file, the arm or an angle cannot be used.
    """
    from lyapcheck.answers.bounds import Comparisons, compare
    from lyapcheck.control.sampling import record_of
    from lyapcheck.files.loop import NOTHING
    from lyapcheck.robots import load

    if not 0.0 < within_deg <= 180.0:
        rule = "must be more than 0 and at most 180 degrees"
        raise argument_error("within_deg", within_deg, rule, "give within_deg=1")
    file, arm = _on_arm(gain_file, robot)
    model, varied = (load(arm.address), arm) if arm.varies else (arm, None)
    task, delta = _task(model, target_deg, start_deg, seconds), math.radians(within_deg)
    record = record_of(NOTHING, file.loop, model.loop)
    asked = partial(compare, motors=file.bounds.torque, varied=varied, record=record)
    results = tuple(asked(one, model, task, delta) for one in file.gains)
    return Comparisons(results, file, model.address)


def simulate_motion(
    gain_set: GainSet | str | Path,
    robot: ArmLike,
    *,
    target_deg: Sequence[float] | None = None,
    start_deg: Sequence[float] | None = None,
    seconds: float = 5.0,
) -> Run:
    """Simulate the closed loop (11) from rest; ``run.plot()`` draws it.

    Args:
        gain_set: a gain set, or the path of a gain file with one gain set.
        robot: an arm, its name or the path of its file.
        target_deg: desired joint angles. Default: 45 degrees per joint.
        start_deg: initial joint angles. Default: 0.
        seconds: duration.

    Raises:
        InputError: the gains, the arm or an angle cannot be used.

    Soundness: floating point. A simulation proves nothing.
    """
    from lyapcheck.control.gains import GainSet, read_gain_file
    from lyapcheck.robots import arm_of
    from lyapcheck.simulate.closed_loop import simulate

    model = arm_of(robot)
    if not isinstance(gain_set, GainSet):
        model = model.with_motors(read_gain_file(gain_set).bounds.torque)
    task = _task(model, target_deg, start_deg, seconds)
    return simulate(gain_set, model, task.q_d, task.q0, T=task.T)


def export_controller(
    gain_file: GainFile | str | Path, robot: ArmLike | None = None, *, rate: float | str
) -> Export:
    """Write each gain set as C99; ``answer.sets[i].files`` has the text of each file.

    Args:
        gain_file: a gain file or its path.
        robot: an arm, its name or the path of its file, instead of the arm of the gain file.
        rate: of the controller, Hz.

    Raises:
        InputError: the file, the arm or the rate cannot be used.
    """
    from lyapcheck.answers.export import export
    from lyapcheck.control.sampling import loop_of_options, record_of

    with told_as({"--rate": "rate"}):
        entry = loop_of_options({"rate": str(rate)})
    file, model = _on_arm(gain_file, robot)
    loop = record_of(entry, file.loop, model.loop)
    assert loop is not None
    return export(file, model, loop)


def torque(
    gain_set: GainSet | str | Path,
    model: ArmLike,
    q_rad: ArrayLike,
    velocity_rad: ArrayLike,
    target_rad: ArrayLike,
) -> Array:
    """τ = K_p h(q_d − q) − K_v h(w) + g(q), N·m, without overflow at any finite q, w and q_d.

    Args:
        gain_set: the controller, or the path of a gain file with one gain set.
        model: the arm, its name or its file; uncertain parameters are at their nominal values.
        q_rad: (..., n) angles in rad.
        velocity_rad: (..., n) velocities in rad/s.
        target_rad: (..., n) goals in rad.

    Raises:
        InputError: gains or arrays for another number of joints.

    Soundness: rounded to nearest without bounds; ``lyapcheck export`` writes the same as C with a bound.

    References: (6) of ``reyes2019family``.
    """
    import numpy as np

    from lyapcheck.control.gains import one_gain_set
    from lyapcheck.robots import arm_of
    from lyapcheck.search.controlled_arm import ControlledArm

    arm = arm_of(model)
    controlled = ControlledArm(one_gain_set(gain_set), arm)
    places = [np.asarray(x, dtype=np.float64) for x in (q_rad, velocity_rad, target_rad)]
    for name, x in zip(("q_rad", "velocity_rad", "target_rad"), places, strict=True):
        if x.shape[-1:] != (arm.n,):
            rule = f"has the shape {x.shape}, and its last axis must be the {arm.n} joints"
            raise argument_error(name, "", rule, f"give arrays of the shape (..., {arm.n})")
    at, rates, goals = np.broadcast_arrays(*places)
    kp, kv, h = controlled.kp, controlled.kv, controlled.family.h
    return np.asarray(kp * h(goals - at) - kv * h(rates) + controlled.numeric.gravity(at))


def decide(statement: Statement, m: int | None = None, n: int | None = None) -> Decision:
    """Decide one statement that is made with the names of ``lyapcheck.claims``.

    Args:
        statement: the claim.
        m: the order of h_m, for the record in its certificate.
        n: the number of joints, for the same record.

    Soundness: a search proposes a proof or a counterexample. A fresh process of the checker decides.

    Example:
        >>> from lyapcheck.claims import identity, sinh, cosh, var
        >>> x = var("x")
        >>> decide(identity(cosh(x) ** 2 - sinh(x) ** 2, 1)).word
        'proved'
    """
    from lyapcheck.certificate import Certificate
    from lyapcheck.check.certificate import About
    from lyapcheck.claims.decision import decided, judge_afresh
    from lyapcheck.claims.procedures import propose

    finding, key = propose(statement), ("statement", m)
    if finding.proof is None:
        return decided(finding, None, statement)
    about = About("statement", "", m, n, "")
    made = Certificate(about, statement, finding.verdict.value, finding.grade.label, finding.proof)
    return decided(finding, judge_afresh({key: made}).get(key), statement)


def _on_arm(gain_file: GainFile | str | Path, robot: ArmLike | None) -> tuple[GainFile, RobotModel]:
    """The gain file and its arm.

    Raises:
        InputError: no arm is named.
    """
    from lyapcheck.control.gains import gain_file_of
    from lyapcheck.robots import RobotModel, load
    from lyapcheck.robots.choice import named

    file = gain_file_of(gain_file)
    if isinstance(robot, RobotModel):
        return file, robot
    name = named(robot, file.robot)
    if name is None:
        raise argument_error("robot", "", "is missing", 'give robot="buap3", or robot = "…" in the gain file')
    return file, load(name)


def _task(
    model: RobotModel, target: Sequence[float] | None, start: Sequence[float] | None, seconds: float
) -> Task:
    """The motion between two postures in degrees."""
    from lyapcheck.simulate.task import FARTHEST, task_for

    goal = [45.0] * model.n if target is None else target
    first = None if start is None else [math.radians(x) for x in start]
    try:
        return task_for(model.n, [math.radians(x) for x in goal], first, None, seconds)
    except InputError as error:
        given = {
            "target_rad": ("target_deg", goal),
            "start_rad": ("start_deg", start or ()),
            "T": ("seconds", (seconds,)),
        }
        problems = []
        for one in error.problems:
            key, values = given[one.key]
            value, said = ", ".join(f"{x:g}" for x in values), one
            if one.repair == "give values in rad":
                rule = f"every value must be finite and at most {math.degrees(FARTHEST):.0f} degrees in size"
                said = replace(one, rule=rule, repair="give values in degrees")
            problems.append(replace(said, key=key, value=value))
        raise InputError(problems) from None
