"""What the study of the printed experiment found, for the gains and the arm of a report.

The study is read as it is written: angles in °, times in s, torques in N·m, to six digits; ``None`` for a
joint that does not settle.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from hashlib import sha256
from importlib import resources
from pathlib import Path
from typing import TYPE_CHECKING

from lyapcheck.report.plain import read
from lyapcheck.simulate.printed import PRINTED, printed_entry

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots import RobotModel


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


def printed_experiment(gain_sets: Iterable[GainSet], model: RobotModel) -> StudyRow | None:
    """The part of the study that is about these gains, under their names.

    Args:
        gain_sets: those of the report; what the paper did not run is left out.

    Returns:
        None where the paper ran none of the gains on this arm, or where the arm is another by now.
    """
    chosen = {entry.m: one.name for one in gain_sets if (entry := printed_entry(one, model))}
    if not chosen:
        return None
    written = json.loads(study_file("printed_experiment").read_text(encoding="utf-8"))
    if written.pop("arm") != arm_digest(model):
        return None
    study = read(StudyRow, written)
    sets = tuple(replace(one, name=chosen[one.m]) for one in study.sets if one.m in chosen)
    return replace(study, sets=sets, together=study.together if len(sets) == len(PRINTED) else None)


def arm_digest(model: RobotModel) -> str:
    """Of all numbers of an arm: a study of other numbers is one of another arm."""
    numbers = sorted((name, number.value, number.bounds) for name, number in model.numbers.items())
    return sha256(repr((model.name, model.joints, numbers)).encode()).hexdigest()


def study_file(name: str) -> Path:
    """The results of a study: in an installed package, or in a checkout."""
    package = Path(str(resources.files("lyapcheck")))
    inside = package / "report" / f"{name}.json"
    return inside if inside.is_file() else package.parent / "studies" / name / "results.json"


# --- The sensitivity study in words, for findings and documents.


QUANTITIES = {
    "L2": "L2 index",
    "settling": "settling time",
    "final_error": "error after 5 s",
    "start_torque": "torque at t = 0",
}
LEAST_SHARE = 0.1
"""An assumption that accounts for less of the variance than this is not what a number hangs on."""


def quantity_words(number: NumberRow) -> str:
    """``settling time (elbow)``."""
    joint = f" ({number.joint})" if number.joint else ""
    return QUANTITIES[number.quantity] + joint


def value_words(value: float | None, unit: str) -> str:
    """A value with its unit; never settled where there is none."""
    if value is None:
        return "not settled"
    return f"{_short(value)}{'°' if unit == '°' else ' ' + unit}"


def printed_words(number: NumberRow) -> str:
    """``25.4006°``, ``below 1.4 s``."""
    bound = "below " if number.at_most else ""
    return f"{bound}{number.printed:g}{'°' if number.unit == '°' else ' ' + number.unit}"


def beside_words(number: NumberRow) -> str:
    """The nominal arm beside the print."""
    nominal, printed = number.nominal, number.printed
    result = f"{value_words(nominal, number.unit)} on the bench with the nominal arm"
    if nominal is None:
        result = "not settled within the run with the nominal arm"
    apart = f" ({percent(nominal / printed - 1)})" if number.quantity == "L2" and nominal else ""
    return f"{result}, {printed_words(number)} in the paper{apart}"


def answer_words(number: NumberRow) -> str:
    """Whether any arm in range explains the printed number."""
    unit, answer = number.unit, number.answer
    nearest = value_words(number.nearest, unit)
    if answer == "yes":
        return "some arm in range does it"
    if answer == "no part":
        return f"no assumption has a part in it: {nearest} for all arms seen"
    if answer == "between":
        return f"arms in range do more and less, none seen does it: nearest {nearest}"
    if number.nearest is None:
        return f"no arm in range among {number.runs} settles"
    return f"no arm in range among {number.runs} does it: nearest {nearest}"


def tally_words(study: StudyRow) -> str:
    """How many printed numbers some arm in range explains, each by itself."""
    numbers = [number for one in study.sets for number in one.numbers]
    free = [number for number in numbers if number.answer != "no part"]
    parts = [f"{sum(number.answer == 'yes' for number in free)} are what some arm in range does"]
    for answer, words in (("between", "lie between what arms do"), ("no", "no arm seen does")):
        count = sum(number.answer == answer for number in free)
        parts += [f"{count} {words}"] if count else []
    rest = len(numbers) - len(free)
    fixed = f"; on {rest} the arm has no influence at all" if rest else ""
    return f"of {len(free)} printed numbers that depend on the arm, each by itself, {', '.join(parts)}{fixed}"


def hangs_words(number: NumberRow, study: StudyRow) -> str:
    """The assumptions that a number hangs on, by share of the variance: ``elbow viscous friction 45 %``."""
    shares = number.shares or {}
    words = {one.name: one.words for one in study.assumed}
    first = sorted(shares, key=lambda name: -shares[name])[:2]
    large = [f"{words[name]} {percent(shares[name], '')}" for name in first if shares[name] >= LEAST_SHARE]
    return f"it hangs on {', '.join(large) or 'no assumption by itself'}"


def together_words(study: StudyRow, result: TogetherRow) -> str:
    """One arm for all gain sets at once."""
    indices = ", ".join(value_words(value, "°") for value in result.values)
    printed = ", ".join(value_words(one.numbers[0].printed, "°") for one in study.sets)
    ordered = f"{percent(result.ordered, '')} of them put" if result.ordered else "none of them puts"
    return (
        f"the L2 indices of all gain sets at one arm: the nearest of {result.arms} arms in range has "
        f"{indices} for {printed}, up to {percent(result.worst, '')} away; "
        f"{ordered} the gain sets in the printed order"
    )


def at_once_words(one: SetRow) -> str:
    """L2 index and settling times of one gain set at one arm."""
    result = one.at_once
    goals = [number for number in one.numbers if number.quantity in ("L2", "settling")]
    values = [value_words(value, goal.unit) for goal, value in zip(goals, result.values, strict=True)]
    printed = [printed_words(goal) for goal in goals]
    return (
        f"L2 index and settling times at one arm: the nearest of {result.arms} has {', '.join(values)} "
        f"for {', '.join(printed)}; the worst is {percent(result.worst, '')} away"
    )


def figure_gains_words(one: SetRow) -> str:
    """What the gains do with which the paper's figure starts."""
    gains = ", ".join(f"{kp:.4g}" for kp in one.figure_gains.kp)
    source = one.of("start_torque")[0].source
    L2 = _short(one.figure_gains.L2)
    return (
        f"{source} starts as with k_p = ({gains}); with these gains the nominal arm has an L2 index of {L2}°"
    )


def span(ends: Ends) -> str:
    """Two ends of a range; open where a joint does not settle."""
    low, high = ends
    if low is None:
        return "not settled"
    if low == high:
        return _short(low)
    return f"{_short(low)} to {'not settled' if high is None else _short(high)}"


def percent(share: float, sign: str = "+") -> str:
    """A share in per cent."""
    return f"{100 * share:{sign}.0f} %"


def _short(value: float) -> str:
    """Four significant digits, no negative zero, and at most three decimals."""
    text = f"{value:.4g}" if abs(value) >= 1 else f"{value:.3f}"
    return text.removeprefix("-") if float(text) == 0 else text
