"""The numbers that the experiment needs and no source prints, each with its range."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from lyapcheck.simulate.results import SETTLING_BAND

if TYPE_CHECKING:
    from lyapcheck.robots import RobotModel
    from lyapcheck.robots.fields import Number

NARROWEST, WIDEST = 0.01, 0.05
"""Settling is said for bands from 1 to 5 % of the step; the paper does not say which."""

BAND = "settling_band"


@dataclass(frozen=True)
class Assumption:
    """One number that is taken for granted: what is used, and from where to where it may lie."""

    name: str
    unit: str
    low: float
    nominal: float
    high: float

    @property
    def words(self) -> str:
        """The name as it stands in a sentence: ``base viscous friction``."""
        words = self.name.replace("_", " ").replace("coulomb", "Coulomb")
        return f"{words} friction" if words.endswith(("viscous", "Coulomb")) else words

    def share(self, value: float) -> float:
        """Where a value lies in the range: 0 at its low end, 1 at its high end."""
        return (value - self.low) / (self.high - self.low)


def assumptions(model: RobotModel) -> tuple[Assumption, ...]:
    """What the bench run of an arm rests on: its numbers with a range, then the settling band.

    In the order of the arm's uncertain parameters, then its joints' viscous and their Coulomb friction.
    """
    band = Assumption(BAND, "", NARROWEST, SETTLING_BAND, WIDEST)
    return (*(_of(name, number) for name, number in numbers(model) if number.ranged), band)


def numbers(model: RobotModel) -> Iterator[tuple[str, Number]]:
    """The numbers of the arm that a bench run takes one by one, in their order there but parameters first."""
    yield from model.parameters.items()
    for kind, values in (("viscous", model.viscous), ("coulomb", model.coulomb)):
        for joint, number in zip(model.joints, values, strict=True):
            if number is not None:
                yield f"{joint}_{kind}", number


def _of(name: str, number: Number) -> Assumption:
    low, high = number.bounds
    return Assumption(name, number.unit, float(low), float(number.value), float(high))
