"""What a run is asked to do: from where, to where, for how long."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from lyapcheck.errors import InputError, Problem, argument_problem
from lyapcheck.search.controlled_arm import ControlledArm

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots import RobotModel


LONGEST = 3600.0
"""Seconds of motion that one run may cover."""
SHORTEST = 1e-6
"""Seconds: less is a slip of units, and no arm moves in it."""
LARGEST_EPS0 = 1e9
"""ε₀ of V: what arms admit is about 1, and squares of it must stay in range."""
FASTEST = 1e3
"""rad/s: no arm turns faster, and a request beyond it is a slip of units."""
FARTHEST = 1e3
"""rad: about 160 turns of a joint."""
MOST_POINTS = 2_000_000
"""Samples of one run."""


@dataclass(frozen=True)
class Task:
    """A set-point task: joints go from ``q0`` at rates ``w0`` to ``q_d`` and are watched for ``T`` seconds.

    Args:
        q_d: desired positions, one a joint, rad.
        q0: initial positions, rad.
        w0: initial rates, rad/s.
        T: duration, s.
    """

    q_d: tuple[float, ...]
    q0: tuple[float, ...]
    w0: tuple[float, ...]
    T: float

    @property
    def step(self) -> tuple[float, ...]:
        """The initial position errors q_d − q0, rad."""
        return tuple(d - s for d, s in zip(self.q_d, self.q0, strict=True))


def task_for(
    n: int,
    q_d: Sequence[float],
    q0: Sequence[float] | None,
    w0: Sequence[float] | None,
    T: float,
    *,
    eps0: float | None = None,
    points: int = 2,
) -> Task:
    """The task on an arm of ``n`` joints; missing initial values are zero (at rest at home).

    ``eps0`` (the ε₀ of V) and ``points`` (samples of the run) are only looked at, so that all that is wrong
    with a request is said at once.

    Raises:
        InputError: every value that is not finite, too large, or of the wrong length; all at once.
    """
    problems: list[Problem] = []
    for name, values, most, unit in (
        ("target_rad", q_d, FARTHEST, "rad"),
        ("start_rad", q0, FARTHEST, "rad"),
        ("velocity_rad", w0, FASTEST, "rad/s"),
    ):
        if values is None:
            continue
        text = ", ".join(f"{float(x):g}" for x in values)
        if len(values) != n:
            rule = f"has {len(values)} values, but the arm has {n} joints"
            problems.append(argument_problem(name, text, rule, f"give {n} values, one a joint"))
        elif not all(math.isfinite(x) and abs(x) <= most for x in values):
            rule = f"every value must be finite and at most {most:g} {unit} in size"
            problems.append(argument_problem(name, text, rule, f"give values in {unit}"))
    if not SHORTEST <= T <= LONGEST:
        rule = f"must be from {SHORTEST:g} to {LONGEST:g} s"
        problems.append(argument_problem("T", T, rule, "give seconds, for instance 5"))
    if eps0 is not None and not 0.0 <= eps0 <= LARGEST_EPS0:
        rule = f"must be from 0 to {LARGEST_EPS0:g}"
        problems.append(argument_problem("eps0", eps0, rule, "give the ε₀ of V, for instance 0.01"))
    if not 2 <= points <= MOST_POINTS:
        rule = f"must be from 2 to {MOST_POINTS}"
        problems.append(argument_problem("points", points, rule, "give the number of samples"))
    if problems:
        raise InputError(problems)
    rows = (q_d, *((0.0,) * n if x is None else x for x in (q0, w0)))
    goal, start, rates = (tuple(map(float, row)) for row in rows)
    return Task(goal, start, rates, float(T))


_QUARTER = math.pi / 4
PAPER_TASK = Task(q_d=(_QUARTER, _QUARTER, 2 * _QUARTER), q0=(0.0, 0.0, 0.0), w0=(0.0, 0.0, 0.0), T=5.0)
"""The published experiment: (45, 45, 90)° from rest at home, 5 s.

References: ``reyes2019family``, Section 4.
"""


# --- What a run starts from: a controller, an arm and a task that fit together.


@dataclass(frozen=True, eq=False)
class Setup:
    """One controller on one arm with one task; ``eps0`` is the ε₀ of the V that is watched."""

    controlled: ControlledArm
    task: Task
    eps0: float

    @property
    def model(self) -> RobotModel:
        """The arm."""
        return self.controlled.model

    @property
    def title(self) -> str:
        """How messages name the run."""
        return f"{self.controlled.gains.name} on {self.model.name}"


def set_up(
    gain_set: GainSet,
    model: RobotModel,
    q_d: Sequence[float],
    q0: Sequence[float] | None,
    w0: Sequence[float] | None,
    *,
    T: float,
    eps0: float | None,
    points: int = 2,
) -> Setup:
    """The setup, once its parts are known to fit.

    Raises:
        InputError: a task the arm cannot be given, or gains for another number of joints.
    """
    task = task_for(model.n, q_d, q0, w0, T, eps0=eps0, points=points)
    return Setup(ControlledArm(gain_set, model), task, 0.0 if eps0 is None else float(eps0))


def torque_limits(model: RobotModel) -> tuple[float | None, ...]:
    """What each motor can give, N·m."""
    return tuple(None if limit is None else float(limit.value) for limit in model.torque_limit)


def motor_limits(model: RobotModel) -> list[float]:
    """The same, infinite where the arm has no limit."""
    return [math.inf if limit is None else limit for limit in torque_limits(model)]
