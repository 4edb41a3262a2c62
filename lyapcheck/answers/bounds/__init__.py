"""Errors at rest, proved beside simulated, for people and for programs."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from lyapcheck.answers import arm_words, assumed_line, bounds_words, file_words
from lyapcheck.answers.bounds.compare import BoundsComparison, compare
from lyapcheck.answers.running import running_sentences
from lyapcheck.answers.running.holds import NO_LINKS
from lyapcheck.certificate import Certificate
from lyapcheck.check.certificate import About
from lyapcheck.check.kinds.resting import AtBounds
from lyapcheck.check.numbers.polynomials import Enclosure
from lyapcheck.control.judgement import REJECTED
from lyapcheck.files.decimals import decimal_text, significant_up
from lyapcheck.files.fields import file_stem
from lyapcheck.output.answer import Annotation, Answer, Level
from lyapcheck.output.digits import shown
from lyapcheck.output.document import Bullets, Document, Section, Table, command
from lyapcheck.output.fields import Field, table
from lyapcheck.promise import all_say

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainFile

__all__ = ["BoundsComparison", "Comparisons", "certificates", "compare", "comparison_data"]

MOST_ROWS = 12
RULE = "what dry friction leaves of the errors at every state of rest is proved"
NOTES = (
    "Simulated in floating point, with the dry friction shown; a simulation proves nothing.",
    "simulated: the larger |e_i| at the end of this motion and of one let go at 95 % of the bound. "
    "peak: the largest |e_i| of this motion.",
)
LEGEND = "proved: |e_i| at every state of rest is at most this, for dry friction up to what is stated."
CORNERS = "simulated: the worst of one run at {}, which proves nothing of what lies between"
NOT_IN_RECORDS = ("assumptions", "vary")


@dataclass(frozen=True)
class Comparisons(Answer):
    """Proved bounds at rest beside simulated runs.

    Args:
        results: one a gain set.
        file: where the gain sets stand.
        arm: its name or path, as it was given.
    """

    schema = "lyapcheck/bounds/1"

    results: tuple[BoundsComparison, ...]
    file: GainFile | None = None
    arm: str = ""

    def document(self) -> Document:
        """How far from the goal the arm rests, joint by joint, proved beside simulated."""
        many = len(self.results) > 1
        rows = [(result, i) for result in self.results for i in range(len(result.joints))]
        kept = rows if len(rows) <= MOST_ROWS else [(one, _farthest(one)) for one in self.results]
        kept.sort(key=lambda row: row[0].proved)
        said = dict.fromkeys(text for result in self.results for text in _remarks(result, many))
        whole = [Section("Every joint", (_table(rows, many),))] if kept is not rows else []
        promises = [result.promise for result in self.results if result.promise is not None]
        notes = [all_say(promises, LEGEND)] if promises else []
        assumed = (text for result in self.results for text in result.model.assumptions)
        return Document(
            title(self.results),
            (_table(kept, many), *([Bullets(tuple(said)[:3])] if said else [])) if rows else (),
            (*notes, *NOTES, *dict.fromkeys(assumed)),
            tuple(self._lead()),
            (*whole, *([Section("Further remarks", (Bullets(tuple(said)[3:]),))] if len(said) > 3 else [])),
            assumed_line(self.results[0].model, self.arm) if self.arm and rows else "",
            self._next(),
        )

    def _lead(self) -> Iterator[str]:
        known = next(filter(None, map(_source, self.results)), "")
        if known:
            yield known
        for result in self.results[: 1 if known else 2]:
            name = f"{result.gains.name}, " if len(self.results) > 1 else ""
            within = f"within {math.degrees(result.delta):g}° of the goal"
            time = result.simulated_time
            ideal = ["all gravity known"] * bool(result.unknown) + ["infinite rate"] * result.sampled
            run = f"{name}simulated{' with ' * bool(ideal)}{' and '.join(ideal)}"
            if time is None:
                yield f"{run}: not {within} in {result.task.T:g} s"
            else:
                yield f"{run}: {within} after {shown(time, '.3g')} s, until {result.task.T:g} s"

    def _next(self) -> str:
        if self.file is None or not self.results:
            return command("bounds", "--help")
        first = min(self.results, key=lambda result: result.proved)
        again = file_words(self.file, self.arm)
        if None in first.dry:
            return command("bounds", *again, "--friction", ",".join(["1"] * len(first.dry)))
        if any(check.reason == NO_LINKS for check in first.unknown):
            return command("gate", *again)
        if first.proved or first.gains.m is None:
            return command("simulate", *again)
        return command("tune", *arm_words(self.arm), "--m", first.gains.m, *bounds_words(self.file.bounds))

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
                level=Level.FAILED if result.falls else Level.PASSED if result.proved else Level.UNDECIDED,
                rule="resting",
                rule_text=RULE,
                case="errors at rest",
                message="" if result.proved else _missing(result),
                **({} if self.file is None else self.file.spot(result.gains)),
            )
            for result in self.results
        ]


def _missing(result: BoundsComparison) -> str:
    said = running_sentences(result.unknown, result.joints)
    return f"none is proved of a joint: {'; '.join(filter(None, (result.reason, *said)))}"


def title(results: Sequence[BoundsComparison]) -> str:
    """How far from the goal one set lets the arm rest, or under how many sets this is proved."""
    if len(results) == 1:
        return _one(results[0])
    robots = ", ".join(dict.fromkeys(result.model.name for result in results)) or "no arm"
    known = [result for result in results if result.promise is not None and result.proved]
    if fallen := sum(result.falls for result in results):
        return f"✗ {robots} falls under {fallen} of {len(results)} gain sets, by gravity unknown to them"
    if not known:
        return f"? not all errors at rest are proved under any of {len(results)} gain sets on {robots}"
    mark = "✓" if len(known) == len(results) else "?"
    most = max(error for result in known for error in result.unknown_degrees if error is not None)
    words = f"{mark} {robots} rests at most {angle_up(most)}° from its goal under {len(known)} of"
    end = f"{len(results)} gain sets{results[0].exact_only}, proved"
    return all_say((result.promise for result in known), f"{words} {end}")


def _one(result: BoundsComparison) -> str:
    over = f" with {', '.join(result.varies)}" if result.varies else ""
    about = f"{result.gains.name} on {result.model.name}{over}"
    if result.falls:
        rejected = (check for check in result.unknown if check.verdict == REJECTED)
        joints = ", ".join(result.joints[check.joint or 0] for check in rejected)
        return f"✗ {about}: {joints} cannot hold the gravity that is unknown to the controller"
    if result.promise is not None and result.proved:
        i = _farthest(result)
        far = f"{angle_up(result.unknown_degrees[i])}° from the goal ({result.joints[i]})"
        promises = [result.promise, *(check.own_promise for check in result.unknown)]
        return all_say(promises, f"✓ {about}: rests at most {far}{result.exact_only}, proved")
    rows = zip(result.joints, result.unknown_degrees, strict=True)
    missing = ", ".join(joint for joint, error in rows if error is None)
    if not missing or any(check.joint is None for check in result.unknown):
        return f"? {about}: the errors under unknown gravity are undecided"
    return f"? {about}: no error at rest is proved for {missing}"


def _source(result: BoundsComparison) -> str:
    """Where the dry friction has no source but the arm file, in words."""
    rows = zip(result.model.coulomb, result.dry, strict=True)
    if any(x is not None and x.assumed and f == x.bounds[1] for x, f in rows):
        return "for dry friction as the arm file assumes it"
    return "" if any(f is None or f for f in result.dry) else "without any dry friction"


def _farthest(result: BoundsComparison) -> int:
    """The joint with the largest error, or without a bound."""
    errors = result.unknown_degrees
    return max(range(len(errors)), key=lambda i: math.inf if errors[i] is None else errors[i])  # type: ignore[arg-type,return-value]


def _remarks(result: BoundsComparison, many: bool) -> Iterator[str]:
    name = f"{result.gains.name}: " if many else ""
    yield from ([f"{name}{result.reason}"] if result.reason else [])
    yield from (f"{name}{text}" for text in running_sentences(result.unknown, result.joints))
    yield from ([CORNERS.format(result.corners)] if result.corners else [])


def _table(rows: Sequence[tuple[BoundsComparison, int]], many: bool) -> Table:
    shown_if = {"gain set": many, "with unknown gravity [°]": any(result.unknown for result, _ in rows)}
    fields = [field for field in JOINTS if shown_if.get(field.head, True)]
    return table(fields, rows, keys=1 + many)


def angle_up(value: Fraction | None) -> str:
    """A proved angle, degrees, in four digits and never rounded down; ``None`` is without a bound."""
    return "∞" if value is None else decimal_text(significant_up(value, 4)) if value else "0"


def _seen(value: float) -> str:
    """A simulated angle in degrees, rounded."""
    return shown(math.degrees(value), ".3g")


JOINTS = (
    Field("", lambda row: [row.gains.name] * len(row.joints), "gain set", align="l"),
    Field("", "joints", "joint", align="l"),
    Field("", "rest_degrees", "proved [°]", angle_up),
    Field("", "unknown_degrees", "with unknown gravity [°]", angle_up),
    Field("", "simulated_rest", "simulated [°]", _seen),
    Field("", "simulated_largest", "peak, simulated [°]", _seen),
    Field("", "dry", "dry friction [N·m]", lambda f: "—" if f is None else decimal_text(f)),
)
"""What is said of a joint under a gain set."""


def comparison_data(result: BoundsComparison) -> dict[str, Any]:
    """One gain set; angles in degrees, those that are proved rounded up."""
    task, promise = result.task, result.promise
    return {
        "name": result.gains.name,
        "robot": result.model.name,
        "target": [_degrees(x) for x in task.q_d],
        "start": [_degrees(x) for x in task.q0],
        "settling": {"delta": _degrees(result.delta)},
        "disturbance": {
            "friction": [above(x) for x in result.dry],
            "rest": [None if x is None else float(x) for x in result.rest_degrees],
            "rest_statement": None if promise is None else promise.says(promise.shown.statement.text()),
            "reason": result.reason,
            "unknown_rest": [None if x is None else float(x) for x in result.unknown_degrees],
            "unknown": running_sentences(result.unknown, result.joints),
        },
        "simulated": {
            "duration": task.T,
            "time": result.simulated_time,
            "largest": [_degrees(x) for x in result.simulated_largest],
            "rest": [_degrees(x) for x in result.simulated_rest],
        },
        "assumptions": list(result.model.assumptions),
        "vary": list(result.varies),
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
    says = f"how far from the goal it can rest: {gains.name} on {result.model.name}"
    about = About(name, says, gains.m, len(result.joints), "bounds")
    made = Certificate(about, result.promise.shown.statement, "proved", "enclosure", AtBounds())
    return {f"{file_stem(gains.name)}.resting.json": made}
