"""What the three kinds of simulation have in common: gain sets on an arm, and the bounds they violate."""

from __future__ import annotations

import csv
import io
import math
from abc import abstractmethod
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import TYPE_CHECKING, Any, ClassVar, Generic, TypeVar

from lyapcheck.answers import file_words
from lyapcheck.output import fields
from lyapcheck.output.answer import Annotation, Answer, Level
from lyapcheck.output.digits import NONE, at_least, at_most, shown
from lyapcheck.output.document import Block, Bullets, Document, Section, Table, command
from lyapcheck.output.escapes import csv_text
from lyapcheck.output.fields import Field
from lyapcheck.output.text import HEADLINE
from lyapcheck.verdicts import Exit

if TYPE_CHECKING:
    from lyapcheck.control.conditions import Check
    from lyapcheck.control.gains import GainFile
    from lyapcheck.simulate.many import Sweep
    from lyapcheck.simulate.run import Breach, Motion, Run
    from lyapcheck.simulate.tracking import TrackingRun


PROMISES, FINISHED = "promises", "finished"
MOST_REMARKS = 3
MARKS = {Level.PASSED: "✓", Level.FAILED: "✗", Level.UNDECIDED: "?"}
NUMERIC = (
    "Runs are integrated in floating point: they are simulated, not proved. Ball arithmetic can confirm a "
    "violated bound: at exactly that state V rises, or the torque (6) exceeds its limit. It does not confirm "
    "that a motion reaches the state. --certificates writes the states at which V rises. Torques have no "
    "certificate."
)
BREACH_KEYS = ("promise", "t", "value", "limit", "unit", "grade")
BREACH = (
    Field("breach", "breach", to=lambda breach: breach.data, csv=None),
    Field("", lambda one: breach_record(one.breach), csv="breach"),
)
"""The violated bound, whole for programs and in a few cells for spreadsheets."""


Result = TypeVar("Result", bound="Run | Sweep | TrackingRun")
"""What was found for one gain set."""


@dataclass(frozen=True)
class Unfinished:
    """Why not all that was asked of a gain set could be found out."""

    name: str
    reason: str


@dataclass(frozen=True)
class Simulation(Answer, Generic[Result]):
    """Simulated gain sets on one arm.

    Args:
        results: one a gain set; a run that was cut short is one as well.
        unfinished: what could not be found out.
        file: where the gain sets stand.
        robot: the arm, its name or path as it was given.
        arms: on which arms each gain set was run, where some numbers vary.
    """

    schema = "lyapcheck/simulate/1"

    results: tuple[Result, ...]
    unfinished: tuple[Unfinished, ...] = ()
    file: GainFile | None = None
    arms: str = ""
    unsampled: bool = False
    """Whether a file says how a computer runs the loop, and the runs leave that out."""
    judged: dict[str, tuple[Check, ...]] = field(default_factory=dict)
    """What the checker says of each gain set as a computer runs it."""
    robot: str = ""

    against = "bounds violated by"
    """What is said of the gain sets that failed, before their number."""
    promised: ClassVar[str]
    """The bounds of theory, in words."""
    fields: ClassVar[tuple[Field, ...]]
    """What is said of a gain set, and of each joint of it."""
    legend: ClassVar[tuple[str, ...]]
    """What the tables mean."""

    @property
    def exit_code(self) -> Exit:
        """1 if a bound is proved violated, 3 if that was seen only or something was not finished, else 0."""
        levels = {self.level(name) for name in self._names()}
        if Level.FAILED in levels:
            return Exit.REFUTED
        return Exit.UNDECIDED if Level.UNDECIDED in levels else Exit.PROVED

    def level(self, name: str) -> Level:
        """How a gain set came out; what was only seen in floating point decides nothing."""
        breach = self._breaches().get(name)
        if breach is not None and breach.confirmed:
            return Level.FAILED
        return Level.UNDECIDED if breach is not None or self.missing(name) else Level.PASSED

    def missing(self, name: str) -> list[str]:
        """Why not all that was asked of a gain set is known."""
        return [one.reason for one in self.unfinished if one.name == name]

    def mark(self, name: str) -> str:
        """How a gain set came out as a sign; none where nothing was held against theory."""
        level = self.level(name)
        return MARKS[level] if level is not Level.PASSED or self.watches(name) else ""

    def complaints(self) -> list[str]:
        """What went wrong: a sentence for each violated bound, and for what was not finished."""
        broken = [f"violated bound: {name}: {one.sentence}" for name, one in self._breaches().items()]
        return [*broken, *(f"not finished: {one.reason}" for one in self.unfinished)]

    def document(self) -> Document:
        """What went wrong, then the run joint by joint, or all gain sets; in detail each by itself."""
        wrong, one = self.complaints(), len(self.results) == 1
        overview = [self.overview()] if self.results else []
        short: list[Block] = [self.by_joint(self.results[0])] if one else list(overview)
        about = [text for text in (self.about(), f"simulated on {self.arms}" if self.arms else "") if text]
        most = MOST_REMARKS - len(about)
        said = [*wrong[:most], *about]
        if len(wrong) > most:
            said[most - 1] = f"{len(wrong) - most + 1} more complaints; -v lists them"
        short += [Bullets(tuple(said))] if said else []
        details: tuple[Block, ...] = (
            *([Bullets(tuple(wrong))] if len(wrong) > most else []),
            *self.opening(),
            *(overview if one else []),
            *map(self.section, self.results),
        )
        title, lead = self._title(), [text for text in (self.far_off, *self.motions()) if text]
        then = "" if self.file is None else command("gate", *file_words(self.file, self.robot))
        return Document(
            title,
            tuple(short),
            (*self.legend, NUMERIC, *self._notes()),
            tuple(lead[: 1 if len(title) > HEADLINE else 2]),
            details,
            next=then,
        )

    def data(self) -> dict[str, Any]:
        """``results: [{name, m, robot, kind, …}], notes``: degrees, N·m, s, J; ``None`` without a number."""
        results = [self.plain_data(one) for one in self.results]
        return {"results": results, "arms": self.arms or None, "notes": self._notes()}

    def records(self) -> list[dict[str, Any]]:
        """The rows of every gain set."""
        return [row for one in self.results for row in self.rows_of(one)]

    def annotations(self) -> list[Annotation]:
        """A case a gain set."""
        return [self._annotation(name) for name in self._names()]

    def overview(self) -> Table:
        """A row a gain set, and how it came out."""
        mark = Field("", lambda one: self.mark(one.name) or NONE, "bounds checked", align="l")
        whole = [one for one in self.fields if not one.each]
        return fields.table([*whole, mark], [(one,) for one in self.results])

    def by_joint(self, one: Result) -> Table:
        """A row a joint of a gain set."""
        parts = [field for field in self.fields if field.each]
        band = f"{math.degrees(getattr(one, 'band', 0)):g}°"
        return fields.table(parts, [(one, i) for i in range(len(one.joints))], band=band)

    @abstractmethod
    def section(self, one: Result) -> Section:
        """All that was found for a gain set."""

    def plain_data(self, one: Result) -> dict[str, Any]:
        """The same for programs."""
        return fields.data(self.fields, one)

    def rows_of(self, one: Result) -> list[dict[str, Any]]:
        """The same as rows of a table."""
        return fields.records(self.fields, one, len(one.joints))

    def opening(self) -> Sequence[Block]:
        """What all gain sets have in common."""
        return ()

    @property
    def far_off(self) -> str:
        """How far from the goal sampled runs end; empty if that is near."""
        return ""

    @property
    def unknown(self) -> str:
        """What the controller of sampled runs does not know; empty if that is nothing."""
        return ""

    def motions(self) -> Sequence[str]:
        """What was simulated: from where to where, and whether a run was cut short."""
        return ()

    def about(self) -> str:
        """How the loop was run, in a remark."""
        return ""

    def watches(self, name: str) -> bool:
        """Whether the bounds of theory were checked for a gain set."""
        return True

    def _names(self) -> list[str]:
        return list(dict.fromkeys([*(one.name for one in self.results), *(x.name for x in self.unfinished)]))

    def _breaches(self) -> dict[str, Breach]:
        return {one.name: one.breach for one in self.results if one.breach is not None}

    def _title(self) -> str:
        names = self._names()
        levels = [self.level(name) for name in names]
        robots = ", ".join(dict.fromkeys(one.robot for one in self.results)) or "simulation"
        left_out = any(one.without_dry_friction for one in self.results)
        left = [*["dry friction"] * left_out, *["[loop]"] * self.unsampled]
        the = "the " if len(left) == 1 else ""
        ideal = f", without {the}{' and '.join(left)} of the file" if left else ""
        counted = f"{'run' if self.arms else 'gain set'}{'' if len(names) == 1 else 's'}"
        count = f"{len(names)} {counted}{' over the ranges' * bool(self.arms)}{self.unknown}{ideal}"
        failed, open_ = levels.count(Level.FAILED), levels.count(Level.UNDECIDED)
        if failed:
            return f"✗ {robots}: {self.against} {failed} of {count}"
        if open_:
            return f"? {robots}: undecided for {open_} of {count}"
        if any(map(self.watches, names)):
            return f"{'!' if left_out else '✓'} {robots}: no bound violated by {count}"
        return f"{'!' if self.far_off else '✓'} {robots}: no limit cycle seen in {count}"

    def _notes(self) -> list[str]:
        return list(dict.fromkeys(note for one in self.results for note in one.notes))

    def _annotation(self, name: str) -> Annotation:
        breach = self._breaches().get(name)
        said = [*([] if breach is None else [breach.sentence]), *self.missing(name)]
        rule = PROMISES if self.watches(name) else FINISHED
        text = self.promised if rule == PROMISES else "the run reaches its end"
        known = {} if self.file is None else {one.name: one for one in self.file.gains}
        place = self.file.spot(known[name]) if self.file is not None and name in known else {}
        return Annotation(self.level(name), rule, text, name, "", "; ".join(said), **place)


def breach_record(breach: Breach | None) -> dict[str, Any]:
    """A violated bound as the part of a row; empty cells without one."""
    return {key: None if breach is None else breach.data[key] for key in BREACH_KEYS}


def headline(one: Motion, way: str) -> str:
    """What was run, on which way, and how far it came."""
    member = "" if one.m is None else f" (m = {one.m})"
    return f"{one.name}{member}: {motion(one, way)}"


def motion(one: Motion, way: str) -> str:
    """On which way an arm was to move, and how far it came."""
    cut = "" if one.complete else f", CUT SHORT at {shown(one.t[-1], '.4g')} s"
    return f"{way} in {one.task.T:g} s{cut}"


def accuracy(one: Motion) -> str:
    """How far the samples of a run can be trusted."""
    if math.isnan(one.accuracy):
        return "accuracy unknown: the run was cut short"
    return f"accuracy {sized(one.accuracy)} (rad, rad/s) by a second, tighter run"


def lower(value: float | Fraction | None) -> str:
    """A limit or an ε₀, rounded down; a dash where there is none."""
    return NONE if value is None or math.isnan(value) else at_least(value)


def upper(value: float | None) -> str:
    """A bound from above, rounded up; a dash where there is none."""
    return NONE if value is None or math.isnan(value) else at_most(value)


def sized(value: float) -> str:
    """The size of an error in one digit, rounded up."""
    return "unknown" if math.isnan(value) else at_most(value, 1)


def plain(value: float | None) -> float | None:
    """The number to nine digits, which is what the accuracy of a run supports; none for NaN and infinity."""
    return None if value is None or not math.isfinite(value) else float(f"{value:.9g}")


def plains(values: Iterable[float]) -> list[float | None]:
    """The same for each number."""
    return [plain(float(value)) for value in values]


def degrees(values: Iterable[float]) -> list[float | None]:
    """Angles in rad for programs."""
    return plains(map(math.degrees, values))


def row(values: Iterable[float]) -> str:
    """Numbers in parentheses."""
    return f"({', '.join(shown(value, 'g') for value in values)})"


# --- The samples of runs as comma-separated values, with units in the header.


TRACKING = "tracking"
SIGNALS = (("q", "rad", "q"), ("w", "rad/s", "w"), ("e", "rad", "e"), ("tau", "N.m", "tau"))
"""Angles, rates, errors, torques of each joint, by their names in a `Motion`."""
TRACKING_SIGNALS = (
    *(("q", "rad", "q"), ("qd", "rad", "goal"), ("e", "rad", "e")),
    *(("v", "rad/s", "velocity"), ("vd", "rad/s", "speed"), ("tau", "N.m", "tau")),
)
"""Angles, reference, errors, rates, rates of the reference, torques."""


def runs_csv(runs: Sequence[Motion]) -> str:
    """The samples of runs on one arm: gain set, whether its run is complete, t, q, w, e, tau, V, dV.

    Of tracking runs see `TRACKING_SIGNALS`; then also the bound that dV must not exceed, empty without one.
    Every number is the shortest decimal that reads back as the same double. A run that was cut short says
    ``no`` under ``complete`` and ends with the last sample it reached.
    """
    tracking = any(run.kind == TRACKING for run in runs)
    signals = TRACKING_SIGNALS if tracking else SIGNALS
    import numpy as np

    n = len(runs[0].joints) if runs else 0
    each = [f"{signal}{i} [{unit}]" for signal, unit, _ in signals for i in range(1, n + 1)]
    head = ["gains", "complete", "t [s]", *each, "V [J]", "dV [W]", *(["bound [W]"] if tracking else [])]
    rows: list[list[str]] = []
    for run in runs:
        table = np.column_stack((run.t, *(getattr(run, name) for *_, name in signals), run.V, run.dV))
        known = getattr(run, "bound", None)
        bound = [""] * run.t.size if known is None else map(repr, known.tolist())
        names = csv_text(run.name), "yes" if run.complete else "no"
        for sample, last in zip(table.tolist(), bound, strict=True):
            rows.append([*names, *map(repr, sample), *([last] if tracking else [])])
    return csv_of(head, rows)


def csv_of(head: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """Lines of comma-separated values."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerows([head, *rows])
    return text.getvalue()
