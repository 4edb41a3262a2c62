"""How long motions take and what disturbances leave of their errors, under each of several gain sets."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import partial
from typing import TYPE_CHECKING, Any

from lyapcheck.answers.bounds.compare import BoundsComparison
from lyapcheck.answers.bounds.data import comparison_data
from lyapcheck.answers.bounds.words import (
    after_text,
    angle_text,
    angle_up,
    provenance_text,
    ratio_text,
    seconds_up,
    simulated_time,
    title,
)
from lyapcheck.answers.gain_place import gain_place
from lyapcheck.check.kinds.phases import FallingPhases
from lyapcheck.output.annotations import Annotation, Level
from lyapcheck.output.answer import Answer
from lyapcheck.output.document import Bullets, Document, Section, Table

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainFile
    from lyapcheck.search.decay.results import MotionBound

RULES = {
    "settling": "a time after which every |e_i| ≤ δ is certified",
    "disturbed": "what torques and dry friction within bounds leave of the errors is certified",
    "no-rate": "V falls exponentially near the goal",
}
FLAT = "h is flat at 0: no exponential rate, and the time grows fast as the angle shrinks"
REST = (
    "Under dry friction every motion ends at rest, certified by falling energy; |e_i|, simulated: "
    "the larger of this motion's and of one let go at 95 % of the bound:"
)
PHASES = "As the motion calms down, V with ε = ε₀ falls for larger ε₀, within these errors and speeds:"
NONE, TORQUE = "—", "torque"
AT_NOMINAL = "at nominal numbers"
LEGEND = (
    "certified: accepted by the checker, {}, for all postures and all motions from starts no "
    "farther than this one, joint by joint.",
    "simulated: {}.",
)
NOMINAL = "at nominal numbers", "one run"
RANGED = (
    "for every arm with {}, constant in time, its other numbers nominal",
    "the worst of one run at each corner of the ranges, which proves nothing of what lies between",
)
NOT_IN_RECORDS = ("envelope", "phases", "after", "statement", "rest_statement")


@dataclass(frozen=True)
class Comparisons(Answer):
    """Certified bounds beside simulated runs.

    Args:
        results: one a gain set.
        file: where the gain sets stand.
    """

    schema = "lyapcheck/bounds/1"

    results: tuple[BoundsComparison, ...]
    file: GainFile | None = None

    def document(self) -> Document:
        """The times of all gain sets, then the errors of each, joint by joint."""
        behind = (Section(result.settling.name, tuple(_behind(result))) for result in self.results)
        assumed = dict.fromkeys(text for result in self.results for text in result.assumptions)
        varies = ", ".join(dict.fromkeys(text for result in self.results for text in result.varies))
        about = (RANGED[0].format(varies), RANGED[1]) if varies else NOMINAL
        legend = (text.format(one) for text, one in zip(LEGEND, about, strict=True))
        notes = (*legend, *(f"{text}." for text in assumed))
        return Document(title(self.results), (_times(self.results), *behind), notes)

    def data(self) -> dict[str, Any]:
        """``results: [{name, robot, settling, disturbance, simulated, …}]``."""
        return {"results": [comparison_data(result) for result in self.results]}

    def records(self) -> list[dict[str, Any]]:
        """A row a gain set, without the envelopes and what the statements say."""
        rows = []
        for row in self.data()["results"]:
            parts = {
                part: {
                    key: value
                    for key, value in row[part].items()
                    if key not in NOT_IN_RECORDS and not (key == "rests_on" and value is None)
                }
                for part in ("settling", "disturbance")
            }
            rows.append(
                {
                    key: value
                    for key, value in (row | parts).items()
                    if key not in ("assumptions", "vary", "unvaried")
                }
            )
        return rows

    def annotations(self) -> list[Annotation]:
        """Two cases a gain set: its settling time, and what disturbances leave."""
        return [one for result in self.results for one in self._judged(result)]

    def _judged(self, result: BoundsComparison) -> list[Annotation]:
        place = gain_place(self.file, result.gains)._asdict()
        about = partial(Annotation, group=result.settling.name, **place)
        judged: list[tuple[str, str, MotionBound]] = [
            ("settling", "settling time", result.settling),
            ("disturbed", "disturbed errors", result.disturbance),
        ]
        cases = [
            about(
                level=Level.UNDECIDED if bound.time is None else Level.PASSED,
                rule=rule,
                rule_text=RULES[rule],
                case=case,
                message=f"none is certified: {bound.reason}" if bound.time is None else "",
            )
            for rule, case, bound in judged
        ]
        if result.settling.time is not None and not result.settling.exponential:
            rule, case = "no-rate", "settling time"
            cases.append(about(level=Level.REMARK, rule=rule, rule_text=RULES[rule], case=case, message=FLAT))
        return cases


def _times(results: Sequence[BoundsComparison]) -> Table:
    """When the errors are small for good, if nothing acts."""
    angles = ", ".join(dict.fromkeys(angle_text(result.settling.delta) for result in results))
    rows: list[tuple[str, ...]] = [
        (
            result.settling.name,
            seconds_up(result.settling.time),
            simulated_time(result),
            ratio_text(result),
            *_cost(result),
        )
        for result in results
    ]
    over = (AT_NOMINAL, "cost of the ranges") if any(result.unvaried for result in results) else ()
    heads = ("gains", "certified", "simulated", "ratio", *over)
    return Table(heads, tuple(rows), f"Every |e_i| ≤ {angles} for good after:")


def _cost(result: BoundsComparison) -> tuple[str, ...]:
    """The certified time without ranges, and by how much these lengthen it; nothing where there are none."""
    if result.unvaried is None:
        return ()
    nominal, now = result.unvaried.settling.time, result.settling.time
    return seconds_up(nominal), f"{float(now / nominal) - 1:+.1%}" if nominal and now else NONE


def _behind(result: BoundsComparison) -> list[Table | Bullets]:
    """The errors of a gain set, and what its bounds rest on or why there are none."""
    settling, left = result.settling, result.disturbance
    said = []
    for name, bound in (("settling time", settling), ("disturbed errors", left)):
        if bound.time is None:
            said.append(f"no certified {name}: {bound.reason}.")
        elif bound.rests_on is not None and (bound is settling or _acting(result)):
            said.append(f"{name} proved by {provenance_text(bound.rests_on)}.")
    if after := after_text(result):
        said.append(f"{after}.")
    if settling.time is not None and not settling.exponential:
        said.append(f"{FLAT}.")
    return [*_errors(result), *_rest(result), *_phases(result), Bullets(tuple(said))]


def _errors(result: BoundsComparison) -> list[Table]:
    """The largest error of each joint; no table where nothing is known."""
    left, n = result.disturbance, len(result.joints)
    columns: list[tuple[str, Sequence[str]]] = []
    if result.settling.largest_errors:
        columns.append(("on the way", list(map(angle_up, result.settling.largest_errors))))
    acting = _acting(result)
    nominal = None if result.unvaried is None else result.unvaried.disturbance
    columns += [(f"{name} N·m", [f"{float(x):g}" for x in values]) for name, values in acting.items()]
    if acting:
        columns += [
            ("disturbed, certified", list(map(angle_up, left.errors)) or [NONE] * n),
            *([] if nominal is None else [(AT_NOMINAL, list(map(angle_up, nominal.errors)) or [NONE] * n)]),
            ("disturbed, simulated", list(map(angle_up, result.simulated_errors))),
        ]
        if left.resting is not None and not left.comes_to_rest:
            columns.append(("at rest, certified", list(map(angle_up, left.rest))))
    if not columns:
        return []
    rows = zip(result.joints, *(cells for _, cells in columns), strict=True)
    return [Table(("joint", *(head for head, _ in columns)), tuple(rows), _caption(result))]


def _phases(result: BoundsComparison) -> list[Table]:
    """Which ε₀ is certified within which errors and speeds; no table where there is one phase."""
    shown = result.settling.shown
    if shown is None or not isinstance(shown.proof, FallingPhases):
        return []
    rows = [
        (
            seconds_up(phase.envelope[0][0]),
            f"{float(phase.eps0):.4g}",
            ", ".join(map(angle_up, phase.within)),
            ", ".join(f"{float(floor):.3g}" for floor in phase.floors),
        )
        for phase in shown.proof.phases
    ]
    return [Table(("from", "ε₀", "|e_i| at most", "h(w_i)/w_i at least"), tuple(rows), PHASES)]


def _rest(result: BoundsComparison) -> list[Table]:
    """Where motions end under dry friction alone; no table where nothing is known."""
    left = result.disturbance
    if not left.comes_to_rest or not any(left.dry):
        return []
    rows: list[tuple[str, ...]] = [
        (joint, angle_up(bound), angle_up(run), f"{float(bound) / run:.3g} ×" if bound and run else NONE)
        for joint, bound, run in zip(result.joints, left.rest, result.simulated_rest, strict=True)
    ]
    heads: tuple[str, ...] = ("joint", "at most", "simulated", "ratio")
    if result.unvaried is not None:
        nominal = result.unvaried.disturbance.rest
        rows = [(*row, angle_up(bound)) for row, bound in zip(rows, nominal, strict=True)]
        heads += (AT_NOMINAL,)
    return [Table(heads, tuple(rows), REST)]


def _caption(result: BoundsComparison) -> str:
    """What the errors are, and from when on."""
    if not _acting(result):
        return "Largest |e_i|:"
    acting = " and ".join(f"{name} of any sign" if name == TORQUE else name for name in _acting(result))
    time = result.disturbance.time
    since = "" if time is None else f"certified from {seconds_up(time)} on, "
    return (
        f"Largest |e_i|; disturbed, under {acting}: {since}simulated in the last tenth "
        f"of {result.task.T:g} s."
    )


def _acting(result: BoundsComparison) -> dict[str, tuple[Fraction, ...]]:
    """What disturbs, joint by joint."""
    both = {TORQUE: result.disturbance.torque, "dry friction": result.disturbance.dry}
    return {name: values for name, values in both.items() if any(values)}
