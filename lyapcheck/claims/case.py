"""The case a claim is decided for: m, n, a robot and gains, and which of them a statement looked at."""

from __future__ import annotations

from typing import Any


class Lacking(Exception):
    """A statement needs something that this case does not have; the claim is undecided for that reason."""


def lacking(reason: str) -> Lacking:
    """What a statement raises when the text says nothing about a case: the claim is then undecided."""
    return Lacking(reason)


class Case:
    """What a statement may depend on; there is no other way to it than one that ``read`` takes down.

    Args:
        m: the member of the family.
        n: the number of joints.
        robot: a model with that many joints, or none.
        gains: the gain set for this m, or none.
    """

    def __init__(self, m: int, n: int, robot: Any = None, gains: Any = None) -> None:
        values = {"m": m, "n": n, "robot": robot, "gains": gains}
        self.read: set[str] = set()

        def look(*names: str) -> Any:
            self.read.update(names)
            return values[names[0]]

        self._look = look

    @property
    def m(self) -> int:
        """The member of the family."""
        return int(self._look("m"))

    @property
    def n(self) -> int:
        """The number of joints."""
        return int(self._look("n"))

    @property
    def robot(self) -> Any:
        """The robot model; its n is the case's."""
        model = self._look("robot", "n")
        if model is None:
            raise Lacking("this claim is about a robot; name one with --robot")
        return model

    @property
    def gains(self) -> Any:
        """The gain set for this m."""
        gains = self._look("gains", "m", "n")
        if gains is None:
            raise Lacking(f"no gain set has m = {self.m}; give a file that has one with --gains")
        return gains
