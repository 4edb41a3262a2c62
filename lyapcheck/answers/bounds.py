"""How far from their goal gain sets let an arm rest under dry friction: proved, beside simulated motions."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import ceil
from typing import TYPE_CHECKING, Any

import numpy as np

from lyapcheck import asked
from lyapcheck._types import Array, Progress, part, silent
from lyapcheck.answers.assumed import arm_words, assumed_line, file_words
from lyapcheck.answers.running import HoldsCheck, holds_checks, running_sentences
from lyapcheck.certificate import Certificate
from lyapcheck.check.certificate import About
from lyapcheck.check.kinds.resting import AtBounds, Resting
from lyapcheck.check.numbers.polynomials import Enclosure
from lyapcheck.control.judgement import ACCEPTED, DEGREES, REJECTED
from lyapcheck.errors import argument_error
from lyapcheck.family import named
from lyapcheck.files.decimals import decimal_text, significant_up
from lyapcheck.files.fields import file_stem
from lyapcheck.output.answer import Annotation, Answer, Level
from lyapcheck.output.digits import shown
from lyapcheck.output.document import Bullets, Document, Section, Table, command
from lyapcheck.output.fields import Field, table
from lyapcheck.promise import Promise, all_say, promised
from lyapcheck.robots.vary import corners, corners_text
from lyapcheck.search.rest import resting
from lyapcheck.simulate.closed_loop import SetPoint
from lyapcheck.simulate.task import set_up

if TYPE_CHECKING:
    from lyapcheck.control.conditions import Check
    from lyapcheck.control.gains import GainFile, GainSet
    from lyapcheck.control.judgement import JudgedStatement
    from lyapcheck.control.sampling import LoopRecord
    from lyapcheck.robots import RobotModel
    from lyapcheck.robots.vary import Vary
    from lyapcheck.simulate.task import Task

    Varied = tuple[RobotModel, Sequence[Vary]]
    """An arm with ranges, and which."""

PLACES = 6
"""Decimals of a degree."""
POINTS, TOLERANCE = 1001, 1e-8
"""Samples of a run, and its relative tolerance."""
JUST_INSIDE = 0.95
"""Where a run starts, next to the proved bound of rest: simulated friction lets a joint creep."""
MOST_ROWS = 12
RULE = "what dry friction leaves of the errors at every state of rest is proved"
NOTES = (
    "Simulated in floating point, with the dry friction shown; a simulation proves nothing.",
    "simulated: the larger |e_i| at the end of this motion and of one let go at 95 % of the bound. "
    "peak: the largest |e_i| of this motion.",
)
LEGEND = "proved: |e_i| at every state of rest is at most this, for dry friction up to what is stated."
CORNERS = "simulated: the worst of one run at {}, which proves nothing of what lies between"
NOT_IN_RECORDS = ("assumptions", "vary", "unvaried")


@dataclass(frozen=True)
class BoundsComparison:
    """Bounds at rest, proved, and what was seen in runs with dry friction, in floating point.

    Args:
        gains: the gain set.
        model: the arm.
        dry: N·m, the most that dry friction of each joint may be; none where nothing is known of it.
        promise: of the errors at rest, as they are printed; none where there are none.
        reason: why a joint has no bound; empty where all have one.
        task: the motion that was simulated.
        delta: δ, rad.
        simulated_time: s, from when on every |e_i| ≤ δ within the run; none if it was not reached.
        simulated_largest: rad, the largest |e_i| of the run.
        simulated_rest: rad, the largest |e_i| at the end of two runs: of the task, and of one let go just
            inside the bound of rest.
        varies: the ranges over which the bounds hold, as typed.
        corners: at which of their corners runs were made; the worst of them counts.
        unvaried: the same without these ranges, where something varies.
        unknown: what gravity that the controller does not know makes of them, where a record says so.
    """

    gains: GainSet
    model: RobotModel
    dry: tuple[Fraction | None, ...]
    promise: Promise | None
    reason: str
    task: Task
    delta: float
    simulated_time: float | None
    simulated_largest: tuple[float, ...]
    simulated_rest: tuple[float, ...]
    varies: tuple[str, ...] = ()
    corners: str = ""
    unvaried: BoundsComparison | None = None
    unknown: tuple[Check, ...] = ()

    @property
    def joints(self) -> tuple[str, ...]:
        """Names of the joints, base first."""
        return self.model.joints

    @property
    def rest(self) -> tuple[Fraction | None, ...]:
        """rad, |e_i| at every state of rest; none for a joint without a bound."""
        return _errors(self.promise, len(self.joints))

    @property
    def rest_degrees(self) -> tuple[Fraction | None, ...]:
        """The same in degrees."""
        return tuple(None if error is None else error * DEGREES for error in self.rest)

    @property
    def proved(self) -> bool:
        """Whether each joint has a bound, whatever gravity is unknown."""
        return None not in self.rest and all(check.verdict == ACCEPTED for check in self.unknown)

    @property
    def falls(self) -> bool:
        """Whether a joint is refuted to hold the gravity that the controller does not know."""
        return any(check.verdict == REJECTED for check in self.unknown)

    @property
    def unknown_degrees(self) -> tuple[Fraction | None, ...]:
        """Errors at rest with what is unknown as well; those of dry friction where that is nothing."""
        result = list(self.rest_degrees)
        for check in self.unknown:
            if isinstance(check, HoldsCheck) and check.joint is not None:
                result[check.joint] = None if check.error is None else check.error * DEGREES
        return tuple(result)


def compare(
    gain_set: GainSet,
    model: RobotModel,
    task: Task,
    delta: float,
    dry: Sequence[Fraction] | None = None,
    *,
    varied: Varied | None = None,
    record: LoopRecord | None = None,
    on_progress: Progress | None = None,
) -> BoundsComparison:
    """The bounds at rest and the run.

    Args:
        gain_set: the controller, of a bounded family.
        model: the arm.
        task: start, goal and duration of the run.
        delta: δ, rad.
        dry: (n,) bounds of dry friction, N·m; if missing the upper ends of what is known of the arm.
        varied: the arm with ranges, and what varies; the bounds are asked over them as well.
        record: what the controller does not know of gravity; runs know all of it.
        on_progress: receives the share done.

    Raises:
        InputError: an unbounded h.
    """
    progress = on_progress or silent
    if not named(gain_set.family, gain_set.m).bounded:
        rule = f"{gain_set.name} has an unbounded h, of which no error at rest is judged"
        raise argument_error("gains", gain_set.name, rule, "choose gains of a bounded family")
    unvaried = None
    if varied is not None:
        unvaried = compare(gain_set, model, task, delta, dry, on_progress=part(progress, 0, 0.4))
    whole, arms = (model, [model]) if varied is None else (varied[0], [arm for _, arm in corners(*varied)])
    known_most = (None if number is None else number.bounds[1] for number in whole.coulomb)
    most = tuple(known_most if dry is None else dry)
    known = [f for f in most if f is not None]
    shown = resting(gain_set, known) if len(known) == len(most) else None
    promise, reason = (None, "") if shown is None else _promised(gain_set, known, shown)
    errors = _errors(promise, model.n)
    runs = []
    for index, arm in enumerate(arms):
        progress((0 if varied is None else 0.4) + 0.6 * index / len(arms), "simulation")
        runs.append(_run(gain_set, arm, task, delta, dry, errors))
    times, largest, last = zip(*runs, strict=True)
    return BoundsComparison(
        gains=gain_set,
        model=model,
        dry=most,
        promise=promise,
        reason=reason or _reason(gain_set, model.joints, most, errors),
        task=task,
        delta=delta,
        simulated_time=None if None in times else max(times),
        simulated_largest=tuple(np.max(largest, axis=0).tolist()),
        simulated_rest=tuple(np.max(last, axis=0).tolist()),
        varies=() if varied is None else tuple(one.text for one in varied[1]),
        corners="" if varied is None else corners_text(*varied),
        unvaried=unvaried,
        unknown=()
        if record is None or record.knows_gravity
        else holds_checks(gain_set, whole, record, known if len(known) == len(most) else None),
    )


def _promised(gains: GainSet, dry: Sequence[Fraction], shown: JudgedStatement) -> tuple[Promise | None, str]:
    """The promise of what is printed, in degrees and rounded up; or why there is none."""
    assert isinstance(shown.statement, Resting)
    unit = Fraction(1, 10**PLACES)
    errors = [
        None if error is None else ceil(error * DEGREES / unit) * unit / DEGREES
        for error in shown.statement.errors
    ]
    return promised(asked.resting(gains, dry, errors), shown)


def _errors(promise: Promise | None, n: int) -> tuple[Fraction | None, ...]:
    """rad, what is promised of each joint."""
    if promise is None:
        return (None,) * n
    assert isinstance(promise.asked, Resting)
    return promise.asked.errors


def _reason(
    gains: GainSet,
    joints: tuple[str, ...],
    dry: tuple[Fraction | None, ...],
    errors: tuple[Fraction | None, ...],
) -> str:
    """Why joints have no bound, and what to do."""
    unknown = [joint for joint, f in zip(joints, dry, strict=True) if f is None]
    if unknown:
        return (
            f"nothing is known of the dry friction of {', '.join(unknown)}; give --friction, or state it as "
            "coulomb in the arm file"
        )
    rows = zip(joints, gains.kp, dry, errors, strict=True)
    weak = [
        f"k_p = {decimal_text(k)} N·m of {joint} does not exceed its dry friction of {decimal_text(f)} N·m"
        for joint, k, f, e in rows
        if e is None and f is not None and f >= k
    ]
    if weak:
        return f"{'; '.join(weak)}: raise k_p"
    return "" if None not in errors else "h at the bounds does not decide it; raise k_p"


def _run(
    gain_set: GainSet,
    model: RobotModel,
    task: Task,
    delta: float,
    dry: Sequence[Fraction] | None,
    errors: Sequence[Fraction | None],
) -> tuple[float | None, Array, Array]:
    """Time, largest and last errors of the task, and the last of a motion let go just inside the bound."""
    known = [0.0 if number is None else float(number.value) for number in model.coulomb]
    friction = known if dry is None else [float(f) for f in dry]
    let_go = [x - JUST_INSIDE * float(e or 0) for x, e in zip(task.q_d, errors, strict=True)]
    starts = ((task.q0, task.w0), (let_go, None))
    setups = (set_up(gain_set, model, task.q_d, q0, w0, T=task.T, eps0=None) for q0, w0 in starts)
    paths = [SetPoint(one, POINTS, friction).once(TOLERANCE) for one in setups]
    e, other = (np.abs(np.array(task.q_d) - path.y[:, : model.n]) for path in paths)
    return inside_from(paths[0].t, e, delta), e.max(axis=0), np.maximum(e[-1], other[-1])


def inside_from(t: Array, e: Array, delta: float) -> float | None:
    """The first sample from which on every |e_i| ≤ δ."""
    outside = np.flatnonzero(np.abs(e).max(axis=1) > delta)
    if outside.size == 0:
        return float(t[0])
    last = int(outside[-1])
    return float(t[last + 1]) if last + 1 < t.size else None


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
        for result in self.results[:2]:
            name = f"{result.gains.name}, " if len(self.results) > 1 else ""
            within = f"within {math.degrees(result.delta):g}° of the goal"
            time = result.simulated_time
            if time is None:
                yield f"{name}simulated: not {within} in {result.task.T:g} s"
            else:
                yield f"{name}simulated: {within} after {shown(time, '.3g')} s, until {result.task.T:g} s"

    def _next(self) -> str:
        if self.file is None or not self.results:
            return command("bounds", "--help")
        first = min(self.results, key=lambda result: result.proved)
        again = file_words(self.file, self.arm)
        if None in first.dry:
            return command("bounds", *again, "--friction", ",".join(["1"] * len(first.dry)))
        if first.proved or first.gains.m is None:
            return command("simulate", *again)
        return command("tune", *arm_words(self.arm), "--m", first.gains.m)

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
    return all_say((result.promise for result in known), f"{words} {len(results)} gain sets, proved")


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
        return all_say(promises, f"✓ {about}: rests at most {far}, proved")
    rows = zip(result.joints, result.unknown_degrees, strict=True)
    missing = ", ".join(joint for joint, error in rows if error is None)
    if not missing:
        return f"? {about}: the errors under unknown gravity are undecided"
    return f"? {about}: no error at rest is proved for {missing}"


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
    shown_if = {
        "gain set": many,
        "without --vary [°]": any(result.unvaried is not None for result, _ in rows),
        "with unknown gravity [°]": any(result.unknown for result, _ in rows),
    }
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
    Field("", "unvaried.rest_degrees", "without --vary [°]", angle_up),
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
    says = f"how far from the goal it can rest: {gains.name} on {result.model.name}"
    about = About(name, says, gains.m, len(result.joints), "bounds")
    made = Certificate(about, result.promise.shown.statement, "proved", "enclosure", AtBounds())
    return {f"{file_stem(gains.name)}.resting.json": made}
