"""The case a claim is decided for: m, n, a robot and gains, and which of them a statement looked at."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from lyapcheck.control import GainSet
    from lyapcheck.robots import RobotModel


class Lacking(Exception):
    """A statement needs something that this case does not have; the claim is undecided for that reason."""


def lacking(reason: str) -> Lacking:
    """What a statement raises when the text says nothing about a case: the claim is then undecided."""
    return Lacking(reason)


@dataclass
class Case:
    """What a statement may depend on; reading ``m`` makes the claim one that is decided for each m."""

    the_m: int
    the_n: int
    the_robot: RobotModel | None
    the_gains: GainSet | None
    read: set[str] = field(default_factory=set)

    @property
    def m(self) -> int:
        """The member of the family."""
        self.read.add("m")
        return self.the_m

    @property
    def n(self) -> int:
        """The number of joints."""
        self.read.add("n")
        return self.the_n

    @property
    def robot(self) -> Any:
        """The robot model; its n is the case's."""
        self.read.update(("robot", "n"))
        if self.the_robot is None:
            raise Lacking("this claim is about a robot; name one with --robot")
        return self.the_robot

    @property
    def gains(self) -> Any:
        """The gain set for this m."""
        self.read.update(("gains", "m", "n"))
        if self.the_gains is None:
            raise Lacking(f"no gain set has m = {self.the_m}; give a file that has one with --gains")
        return self.the_gains
