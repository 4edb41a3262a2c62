"""How far from their goal several gain sets let an arm rest, in words and as data."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from lyapcheck.answers.bounds.compare import BoundsComparison
from lyapcheck.answers.gain_place import gain_place
from lyapcheck.certificate import Certificate
from lyapcheck.check.certificate import About
from lyapcheck.check.kinds.resting import AtBounds
from lyapcheck.check.numbers.enclosure import Enclosure
from lyapcheck.files.decimals import decimal_text, significant_up
from lyapcheck.files.names import file_stem
from lyapcheck.output.annotations import Annotation, Level
from lyapcheck.output.answer import Answer
from lyapcheck.output.digits import shown
from lyapcheck.output.document import Bullets, Document, Section, Table
from lyapcheck.promise import all_say

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainFile

RULE = "what dry friction leaves of the errors at every state of rest is proved"
RUNS = (
    "simulated at rest: the larger |e_i| of this motion's end and of one let go at 95 % of the bound; "
    "simulated on the way: the largest of this motion"
)
NONE = "—"
WITHOUT = "without --vary, proved"
LEGEND = (
    "proved at most: accepted by the checker, for dry friction up to what is stated, at every state of rest."
)
SIMULATED = "simulated: {}, in floating point, with that dry friction."
ONE_RUN = "one run at nominal numbers"
CORNERS = "the worst of one run at {}, for {}, which proves nothing of what lies between"
NOT_IN_RECORDS = ("assumptions", "vary", "unvaried")
PROOF = "bounds"


@dataclass(frozen=True)
class Comparisons(Answer):
    """Proved bounds at rest beside simulated runs.

    Args:
        results: one a gain set.
        file: where the gain sets stand.
    """

    schema = "lyapcheck/bounds/1"

    results: tuple[BoundsComparison, ...]
    file: GainFile | None = None

    def document(self) -> Document:
        """The errors at rest of each gain set, joint by joint, then the simulated times."""
        behind = (Section(result.gains.name, tuple(_behind(result))) for result in self.results)
        assumed = dict.fromkeys(text for result in self.results for text in result.assumptions)
        varies = ", ".join(dict.fromkeys(text for result in self.results for text in result.varies))
        tried = ", ".join(dict.fromkeys(result.corners for result in self.results if result.corners))
        runs = CORNERS.format(tried, varies) if varies else ONE_RUN
        promises = [result.promise for result in self.results if result.promise is not None]
        legend = [all_say(promises, LEGEND)] if promises else []
        notes = (*legend, SIMULATED.format(runs), *(f"{text}." for text in assumed))
        return Document(title(self.results), (*behind, _times(self.results)), notes)

    def data(self) -> dict[str, Any]:
        """``results: [{name, robot, disturbance, simulated, …}]``."""
        return {"results": [comparison_data(result) for result in self.results]}

    def records(self) -> list[dict[str, Any]]:
        """A row a gain set, without what the statement says."""
        return [
            {key: value for key, value in row.items() if key not in NOT_IN_RECORDS}
            | {"disturbance": {k: v for k, v in row["disturbance"].items() if k != "rest_statement"}}
            for row in self.data()["results"]
        ]

    def annotations(self) -> list[Annotation]:
        """A case a gain set: whether each joint has a bound at rest."""
        return [
            Annotation(
                group=result.gains.name,
                level=Level.PASSED if result.proved else Level.UNDECIDED,
                rule="resting",
                rule_text=RULE,
                case="errors at rest",
                message="" if result.proved else f"none is proved of a joint: {result.reason}",
                **gain_place(self.file, result.gains)._asdict(),
            )
            for result in self.results
        ]


def title(results: Sequence[BoundsComparison]) -> str:
    """Whether all bounds are proved."""
    robots = ", ".join(dict.fromkeys(result.robot for result in results))
    promises = [result.promise for result in results if result.promise is not None and result.proved]
    whole = len(promises)
    if len(results) == 1:
        return _one(results[0])
    if whole == len(results) > 0:
        return all_say(promises, f"✓ the errors at rest under all {whole} gain sets are proved on {robots}")
    if not promises:
        count = len(results)
        return f"? not all errors at rest are proved under any of {count} gain sets on {robots or 'no arm'}"
    some = f"? the errors at rest under {whole} of {len(results)} gain sets are proved on {robots}"
    return all_say(promises, some)


def _one(result: BoundsComparison) -> str:
    over = f" with {', '.join(result.varies)}" if result.varies else ""
    about = f"{result.gains.name} on {result.robot}{over}:"
    known = [error for error in result.rest_degrees if error is not None]
    if result.promise is not None and result.proved:
        return result.promise.says(f"✓ {about} at every state of rest |e_i| ≤ {angle_up(max(known))}, proved")
    rows = zip(result.joints, result.rest, strict=True)
    missing = ", ".join(joint for joint, error in rows if error is None)
    return f"? {about} no error at rest is proved for {missing}"


def _behind(result: BoundsComparison) -> list[Table | Bullets]:
    """The errors of a gain set, and why a joint has no bound."""
    columns: list[tuple[str, Sequence[str]]] = [
        ("dry friction [N·m]", [NONE if f is None else decimal_text(f) for f in result.dry]),
        ("proved at most", list(map(angle_up, result.rest_degrees))),
        ("simulated at rest", list(map(_angle, result.simulated_rest))),
        ("simulated on the way", list(map(_angle, result.simulated_largest))),
    ]
    if result.unvaried is not None:
        columns.insert(2, (WITHOUT, list(map(angle_up, result.unvaried.rest_degrees))))
    promise = result.promise
    proved = "" if promise is None else promise.says("proved: |e_i| at every state of rest; ")
    rows = zip(result.joints, *(cells for _, cells in columns), strict=True)
    table = Table(("joint", *(head for head, _ in columns)), tuple(rows), f"{proved}{RUNS}:")
    return [table, *([Bullets((f"{result.reason}.",))] if result.reason else [])]


def _times(results: Sequence[BoundsComparison]) -> Table:
    """When the simulated errors are small for good."""
    angles = ", ".join(dict.fromkeys(f"{math.degrees(result.delta):g}°" for result in results))
    rows = tuple((result.gains.name, _time(result)) for result in results)
    return Table(("gains", "simulated time"), rows, f"Simulated: all |e_i| ≤ {angles} for good after:")


def _time(result: BoundsComparison) -> str:
    """When the run came to stay within δ."""
    if result.simulated_time is None:
        return f"not within {result.task.T:g} s"
    return f"{shown(result.simulated_time, '.3g')} s"


def _angle(value: float) -> str:
    """A simulated angle in degrees, rounded."""
    return f"{shown(math.degrees(value), '.3g')}°"


def angle_up(value: Fraction | None) -> str:
    """A proved angle, degrees, in four digits and never rounded down; ``None`` is without a bound."""
    if value is None:
        return "∞"
    return f"{decimal_text(significant_up(value, 4))}°" if value else "0°"


def comparison_data(result: BoundsComparison) -> dict[str, Any]:
    """One gain set; angles in degrees, those that are proved rounded up."""
    task, promise = result.task, result.promise
    return {
        "name": result.gains.name,
        "robot": result.robot,
        "target": [_degrees(x) for x in task.q_d],
        "start": [_degrees(x) for x in task.q0],
        "settling": {"delta": _degrees(result.delta)},
        "disturbance": {
            "friction": [above(x) for x in result.dry],
            "rest": [None if x is None else float(x) for x in result.rest_degrees],
            "rest_statement": None if promise is None else promise.says(promise.shown.statement.text()),
            "reason": result.reason,
        },
        "simulated": {
            "duration": task.T,
            "time": result.simulated_time,
            "largest": [_degrees(x) for x in result.simulated_largest],
            "rest": [_degrees(x) for x in result.simulated_rest],
        },
        "assumptions": list(result.assumptions),
        "vary": list(result.varies),
        "unvaried": None if result.unvaried is None else comparison_data(result.unvaried),
    }


def above(value: Fraction | None) -> float | None:
    """The smallest double that is not below."""
    return None if value is None else Enclosure(value, value).float_upper + 0.0  # −0.0 is written 0.0


def _degrees(x: float) -> float:
    return round(math.degrees(x), 9)


def certificates(result: BoundsComparison) -> dict[str, Certificate]:
    """The certificate by its file name; none where nothing was accepted."""
    if result.promise is None:
        return {}
    name, gains = f"{result.gains.name}.resting", result.gains
    says = f"how far from the goal it can rest: {gains.name} on {result.robot}"
    about = About(name, says, gains.m, len(result.joints), PROOF)
    made = Certificate(about, result.promise.shown.statement, "proved", "enclosure", AtBounds())
    return {f"{file_stem(gains.name)}.resting.json": made}
