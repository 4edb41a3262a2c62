"""What a sensitivity study found."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from studies.printed_experiment.assumptions import Assumption
from studies.printed_experiment.printed_numbers import PrintedNumber


class Answer(StrEnum):
    """Whether any arm in range explains a printed number."""

    YES = "yes"
    """One was seen that does it, or that meets a printed bound."""
    BETWEEN = "between"
    """Arms on either side of it were seen, but none at it: where it was looked for, the way there jumps."""
    NO = "no"
    """All arms seen are on one side of it."""
    NO_PART = "no part"
    """The assumed numbers have no part in it: the same value at every arm."""


@dataclass(frozen=True)
class NumberStudy:
    """One printed number beside what the bench does with it; ``None`` for a joint that does not settle.

    Args:
        printed: the number.
        nominal: with all assumptions as they are taken.
        low, high: the least and the largest value seen at any arm in range.
        typical: from where to where the middle 90 % of the arms spread over the ranges lie.
        unsettled: the share of those arms at which the joint does not settle within the run.
        alone: for each assumption the least and the largest value when it alone is changed.
        shares: for each assumption the share of the variance it accounts for by itself; none where the arm
            has no influence.
        answer: whether an arm in range explains the printed number.
        nearest: the value seen that is nearest to the printed one.
        at: the assumed numbers of that arm; none where the arm has no part in it.
        runs: how many runs that rests on.
    """

    printed: PrintedNumber
    nominal: float | None
    low: float | None
    high: float | None
    typical: tuple[float | None, float | None]
    unsettled: float
    alone: tuple[tuple[float | None, float | None], ...]
    shares: tuple[float, ...] | None
    answer: Answer
    nearest: float | None
    at: tuple[float, ...] | None
    runs: int


@dataclass(frozen=True)
class FigureGains:
    """The gains with which the paper's figure starts, in the unit of the gain file, and their L2 index."""

    kp: tuple[float, ...]
    L2: float
    """degrees, nominal arm."""


@dataclass(frozen=True)
class AtOnce:
    """The one arm that comes nearest to several printed numbers at once.

    Args:
        values: what it does, one a number; none for a joint that does not settle.
        worst: the largest relative difference among them.
        at: the assumed numbers of the arm.
        arms: how many were tried.
    """

    values: tuple[float | None, ...]
    worst: float
    at: tuple[float, ...]
    arms: int


@dataclass(frozen=True)
class SetStudy:
    """All printed numbers of one gain set.

    Args:
        name: of the gain set.
        m: the member of the family; none for PD.
        numbers: one a printed number.
        at_once: its L2 index and its settling times at one arm.
        figure_gains: what the torques of the paper's figure ask for.
    """

    name: str
    m: int | None
    numbers: tuple[NumberStudy, ...]
    at_once: AtOnce
    figure_gains: FigureGains


@dataclass(frozen=True)
class Together:
    """The L2 indices of all gain sets at one arm.

    Args:
        nearest: the arm that comes nearest to the printed ones.
        ordered: the share of the arms tried that put the gain sets in the printed order.
    """

    nearest: AtOnce
    ordered: float


@dataclass(frozen=True)
class Study:
    """A whole study.

    Args:
        robot: the arm.
        joints: its joints.
        assumed: what was varied.
        spread, corners: sizes of the sample.
        search: whether arms were looked for beyond the sample.
        runs: bench runs in all.
        seed: of all random choices.
        sets: one a gain set.
        together: for two gain sets or more.
    """

    robot: str
    joints: tuple[str, ...]
    assumed: tuple[Assumption, ...]
    spread: int
    corners: int
    search: bool
    runs: int
    seed: int
    sets: tuple[SetStudy, ...]
    together: Together | None
