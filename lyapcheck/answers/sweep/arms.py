"""The arms of a sweep, each read once a process."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import lru_cache
from typing import TYPE_CHECKING

from lyapcheck import store
from lyapcheck.robots import load
from lyapcheck.robots.vary import Vary

if TYPE_CHECKING:
    from lyapcheck.control.arm_limits import ArmLimits
    from lyapcheck.robots import RobotModel

MOST = 16
"""Arms that a process keeps."""


@dataclass(frozen=True)
class UncertainArm:
    """An arm with its uncertainties.

    Args:
        model: the arm.
        ranges: what varies.
        digest: of all its numbers.
        limits: by its name, as the gate takes them; read when it is first asked.
    """

    model: RobotModel
    ranges: tuple[Vary, ...]
    digest: str
    limits: dict[str, ArmLimits] = field(default_factory=dict)


@lru_cache(maxsize=MOST)
def arm(robot: str, variation: tuple[str, ...] = ()) -> UncertainArm:
    """The arm of a name or file, with ranges as ``--vary`` takes them.

    Raises:
        InputError: no such arm, or a range of nothing that it has.
    """
    ranges = tuple(map(Vary.parsed, variation))
    model = load(robot, vary=ranges)
    return UncertainArm(model, ranges, store.exact(model))
