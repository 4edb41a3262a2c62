"""What the study of the printed experiment found, for the gains and the arm of a report."""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import replace
from hashlib import sha256
from importlib import resources
from pathlib import Path
from typing import TYPE_CHECKING

from lyapcheck.report.plain import read
from lyapcheck.report.study import Ends, NumberRow, SetRow, StudyRow, TogetherRow
from lyapcheck.simulate.printed import PRINTED, printed_entry

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots import RobotModel


def printed_experiment(gain_sets: Iterable[GainSet], model: RobotModel) -> StudyRow | None:
    """The part of the study that is about these gains, under their names.

    Args:
        gain_sets: those of the report; what the paper did not run is left out.
        model: the arm.

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


def answer_cell(number: NumberRow) -> str:
    """The same in a cell of a table."""
    nearest = value_words(number.nearest, number.unit)
    cells = {
        "yes": "yes",
        "no part": "no part in it",
        "between": f"more and less: nearest {nearest}",
        "no": f"no: nearest {nearest}",
    }
    return cells[number.answer]


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
    """Which assumptions a number hangs on, by their share of the variance."""
    result = leading(number, study)
    return f"it hangs on {result}" if result else "it hangs on no assumption by itself"


def leading(number: NumberRow, study: StudyRow, most: int = 2) -> str:
    """The assumptions with the largest shares, ``elbow viscous friction 45 %``."""
    shares = number.shares or {}
    words = {one.name: one.words for one in study.assumed}
    first = sorted(shares, key=lambda name: -shares[name])[:most]
    large = [name for name in first if shares[name] >= LEAST_SHARE]
    return ", ".join(f"{words[name]} {percent(shares[name], '')}" for name in large)


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


def span(ends: Ends, unit: str = "") -> str:
    """Two ends of a range; open where a joint does not settle."""
    low, high = ends
    if low is None:
        return "not settled"
    if low == high:
        return f"{_short(low)}{unit}"
    return f"{_short(low)} to {'not settled' if high is None else _short(high)}{unit}"


def percent(share: float, sign: str = "+") -> str:
    """A share in per cent."""
    return f"{100 * share:{sign}.0f} %"


def _short(value: float) -> str:
    """Four significant digits, no negative zero, and at most three decimals."""
    text = f"{value:.4g}" if abs(value) >= 1 else f"{value:.3f}"
    return text.removeprefix("-") if float(text) == 0 else text
