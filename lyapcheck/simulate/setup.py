"""What a run starts from: a controller, an arm and a task that fit together."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.simulate.gains import Gains, gains_for
from lyapcheck.simulate.task import Task, task_for

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots import RobotModel


@dataclass(frozen=True, eq=False)
class Setup:
    """One controller on one arm with one task; ``eps0`` is the ε₀ of the V that is watched.

    ``controlled`` is the same controller and arm as exact data.
    """

    gains: Gains
    model: RobotModel
    task: Task
    eps0: float
    controlled: ControlledArm

    @property
    def title(self) -> str:
        """How messages name the run."""
        return f"{self.gains.name} on {self.model.name}"


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
    gains = gains_for(gain_set, model.n)
    return Setup(gains, model, task, 0.0 if eps0 is None else float(eps0), ControlledArm(gain_set, model))
