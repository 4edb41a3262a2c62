"""The study of the printed experiment as it is written: what is printed beside what assumed arms do.

Angles in °, times in s, torques in N·m, to six digits; ``None`` for a joint that does not settle.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

Ends = tuple[float | None, float | None]


@dataclass(frozen=True)
class AssumedRow:
    """A number of the arm that no source prints, in its SI unit; ``words`` as it stands in a sentence."""

    name: str
    words: str
    unit: str
    low: float
    nominal: float
    high: float


@dataclass(frozen=True)
class NumberRow:
    """One printed number of one gain set.

    Args:
        quantity: ``L2``, ``settling``, ``final_error`` or ``start_torque``.
        joint: its name; none where the number is about all.
        unit: of all values here.
        printed, at_most: the number, and whether it is printed as a bound.
        source: where it is printed.
        nominal: with all assumptions as they are taken.
        low, high: the least and the largest value seen at any arm in range.
        typical: from where to where the middle 90 % of the arms spread over the ranges lie.
        unsettled: the share of those arms at which the joint does not settle within the run.
        alone: for each assumption the least and the largest value when it alone is changed.
        shares: of the variance, by assumption; none where the arm has no influence.
        answer: whether an arm in range explains it: ``yes``, ``between``, ``no`` or ``no part``.
        nearest: the value seen that is nearest to the printed one.
        at: the assumed numbers of that arm; none where the arm has no part in it.
        runs: how many runs that rests on.
    """

    quantity: str
    joint: str | None
    unit: str
    printed: float
    at_most: bool
    source: str
    nominal: float | None
    low: float | None
    high: float | None
    typical: Ends
    unsettled: float
    alone: Mapping[str, Ends]
    shares: Mapping[str, float] | None
    answer: str
    nearest: float | None
    at: Mapping[str, float] | None
    runs: int


@dataclass(frozen=True)
class NearestRow:
    """The arm that comes nearest to several printed numbers at once: what it does, and what it is.

    Args:
        values: one a number.
        worst: the largest relative difference among them.
        arms: how many were tried.
        at: the assumed numbers of the arm.
    """

    values: tuple[float | None, ...]
    worst: float
    arms: int
    at: Mapping[str, float] | None


@dataclass(frozen=True)
class TogetherRow(NearestRow):
    """The L2 indices of all gain sets at one arm; ``ordered``: the share of arms with the printed order."""

    ordered: float


@dataclass(frozen=True)
class FigureGainsRow:
    """The gains with which the paper's figure starts, as gain files write them, and their L2 index, °."""

    kp: tuple[float, ...]
    L2: float


@dataclass(frozen=True)
class SetRow:
    """All printed numbers of one gain set; ``m`` is none for PD."""

    name: str
    m: int | None
    numbers: tuple[NumberRow, ...]
    at_once: NearestRow
    figure_gains: FigureGainsRow

    def of(self, quantity: str) -> list[NumberRow]:
        """The numbers of one quantity."""
        return [number for number in self.numbers if number.quantity == quantity]


@dataclass(frozen=True)
class StudyRow:
    """A whole study.

    Args:
        robot: the arm.
        model: how the bench is modelled, in words.
        seed: of all random choices.
        spread, corners: sizes of the sample.
        search: whether arms were looked for beyond the sample.
        runs: bench runs in all.
        assumed: what was varied.
        sets: one a gain set.
        together: for two gain sets or more.
    """

    robot: str
    model: str
    seed: int
    spread: int
    corners: int
    search: bool
    runs: int
    assumed: tuple[AssumedRow, ...]
    sets: tuple[SetRow, ...]
    together: TogetherRow | None
