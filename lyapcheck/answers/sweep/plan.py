"""Plans: which arms, with which uncertainties and gains, are asked which questions."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import product
from typing import Any

from lyapcheck.answers.sweep.question import Question
from lyapcheck.control.gains import GainSet
from lyapcheck.files.decimals import decimal_text

Gain = Fraction | tuple[Fraction, ...]
"""The same in every joint, or one a joint; N·m."""
LONGEST_NAME = 120
WITHOUT_GAINS = ("robot",)
"""What is asked of an arm alone."""


@dataclass(frozen=True)
class Grid:
    """Every m with every K_p and every K_v."""

    m: tuple[int, ...]
    kp: tuple[Gain, ...]
    kv: tuple[Gain, ...]

    def __len__(self) -> int:
        return len(self.m) * len(self.kp) * len(self.kv)

    def gains(self, n: int) -> Iterator[GainSet]:
        """The gain sets for an arm of n joints, k_v the fastest."""
        for m, kp, kv in product(self.m, self.kp, self.kv):
            both = _of_joints(kp, n), _of_joints(kv, n)
            yield GainSet(_name(m, *both), m, *both)


@dataclass(frozen=True)
class Plan:
    """A sweep: robots × variations × gains × questions, in that order.

    Args:
        path: of its file.
        robots: names or files.
        variations: of each the ranges, as ``--vary`` takes them; one without any is the arm as it is.
        joints: how many each robot has.
        listed: gain sets one by one.
        grid: gain sets by rows, after those that are listed.
        asks: each question by its name, and what it was asked with.
    """

    path: str
    robots: tuple[str, ...]
    variations: tuple[tuple[str, ...], ...]
    joints: tuple[int, ...]
    listed: tuple[GainSet, ...]
    grid: Grid | None
    asks: tuple[tuple[str, tuple[tuple[str, Any], ...]], ...]

    @cached_property
    def count(self) -> int:
        """How many questions."""
        alone = sum(name in WITHOUT_GAINS for name, _ in self.asks)
        sets = len(self.listed) + (0 if self.grid is None else len(self.grid))
        return len(self.robots) * len(self.variations) * (alone + sets * (len(self.asks) - alone))

    def questions(self) -> Iterator[Question]:
        """One after the other: none is kept, however many there are."""
        number = 0
        for (robot, n), variation in product(zip(self.robots, self.joints, strict=True), self.variations):
            for question in self._of_arm(robot, n, variation):
                yield question.numbered(number)
                number += 1

    def _of_arm(self, robot: str, n: int, variation: tuple[str, ...]) -> Iterator[Question]:
        for name, options in self.asks:
            if name in WITHOUT_GAINS:
                yield Question(0, robot, variation, None, name, options)
        for gains in self._gains(n):
            for name, options in self.asks:
                if name not in WITHOUT_GAINS:
                    yield Question(0, robot, variation, gains, name, options)

    def _gains(self, n: int) -> Iterator[GainSet]:
        yield from self.listed
        if self.grid is not None:
            yield from self.grid.gains(n)


def _of_joints(gain: Gain, n: int) -> tuple[Fraction, ...]:
    return gain if isinstance(gain, tuple) else (gain,) * n


def _name(m: int, kp: tuple[Fraction, ...], kv: tuple[Fraction, ...]) -> str:
    """What a gain set of a grid is called: what it is."""
    parts = (f"{key} {gain_text(gains)}" for key, gains in (("kp", kp), ("kv", kv)))
    return f"m{m} {' '.join(parts)}"[:LONGEST_NAME]


def gain_text(gains: tuple[Fraction, ...]) -> str:
    """One number where it is the same in every joint, else one a joint."""
    return ",".join(map(decimal_text, gains[:1] if len(set(gains)) == 1 else gains))
