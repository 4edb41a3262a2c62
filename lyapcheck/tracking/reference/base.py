"""What every reference trajectory offers: q_d, q̇_d and q̈_d at any time, and bounds of them for all times."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from flint import arb

from lyapcheck._types import Array
from lyapcheck.check.numbers.balls import precision
from lyapcheck.check.numbers.enclosure import Enclosure

SECONDS = 5.0
"""Duration of a run of which nothing else is said."""

BITS = 128
_PLACES = 10**12


@dataclass(frozen=True)
class Suprema:
    """Bounds from above for all times, exact.

    Args:
        rate: sup |q̇_di| of each joint, rad/s.
        acceleration: sup |q̈_di| of each joint, rad/s².
        speed: v_d, sup ‖q̇_d‖, rad/s.
        acceleration_norm: sup ‖q̈_d‖, rad/s².
    """

    rate: tuple[Fraction, ...]
    acceleration: tuple[Fraction, ...]
    speed: Fraction
    acceleration_norm: Fraction


class Reference(ABC):
    """A trajectory with two continuous derivatives, which is what (21) takes for granted.

    References: (21) of ``reyes2019family``.
    """

    kind: str
    n: int
    duration: float = SECONDS
    """s, how long a run takes of which nothing else is said."""
    span: float | None = None
    """s, where the trajectory ends; none if it goes on for ever."""

    @abstractmethod
    def at(self, t: Array) -> Array:
        """q_d, q̇_d and q̈_d at times (N,) in s: (N, 3, n) in rad, rad/s and rad/s²."""

    @abstractmethod
    def suprema(self) -> Suprema:
        """Bounds of q̇_d and q̈_d for all times.

        Soundness: rounded outward; they bound the trajectory itself, of which ``at`` is the nearest double.
        """

    @property
    @abstractmethod
    def sentence(self) -> str:
        """The trajectory in one line."""


def above(ball: arb) -> Fraction:
    """A decimal of twelve places that is not below any number of a ball."""
    with precision(BITS):
        value = Enclosure.from_arb(ball).upper
    return -Fraction(-value.numerator * _PLACES // value.denominator, _PLACES)


def angles(values: Sequence[Fraction]) -> str:
    """Angles as they were written, in degrees."""
    return f"({', '.join(f'{float(x):g}' for x in values)})°"
