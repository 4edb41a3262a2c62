"""Reference files (TOML): one trajectory, described in a few lines.

kind = "sine"                    # q_di = offset + amplitude sin(2π frequency t + phase)
amplitude = [20, 30, 40]         # degrees
frequency = [0.5, 0.5, 0.25]     # Hz
phase = [0, 90, 0]               # degrees, 0 if missing
offset = [0, 45, 0]              # degrees, 0 if missing

kind = "minimum-jerk"
from = [0, 0, 0]                 # degrees
to = [45, 45, 90]                # degrees
duration = 2                     # s

kind = "recorded"
file = "motion.csv"              # beside this file: t [s],q1 [rad],…,qn [rad], or [deg]
spline = "cubic"                 # or "quintic"; cubic if missing
"""

from __future__ import annotations

import csv
import io
import math
import re
from collections.abc import Callable
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path
from typing import cast

import numpy as np

from lyapcheck._types import Array
from lyapcheck.errors import InputError, Problem, near
from lyapcheck.files.decimals import NotFinite
from lyapcheck.files.fields import Fields, Notes
from lyapcheck.files.reader import SAMPLES, read_text
from lyapcheck.files.toml import open_document
from lyapcheck.output.escapes import printable
from lyapcheck.simulate.reference import DEGREES, MinimumJerk, Recorded, Reference, Sine

FARTHEST = Fraction(36_000)
"""Degrees: a hundred turns of a joint."""
FASTEST = Fraction(1000)
"""Hz."""
LONGEST = Fraction(3600)
"""s"""
QUICKEST = Fraction(1, 1000)
"""s, the shortest motion from one posture to another."""

Row = tuple[Fraction, ...]


def read_reference(path: str | Path, joints: int | None = None) -> Reference:
    """The trajectory that a reference file describes.

    Args:
        path: of the TOML file.
        joints: of the arm; any number if missing.

    Raises:
        InputError: everything that is wrong with the file, or with the recording it names.
    """
    document = open_document(Path(path), str(path))
    notes = Notes(document.name, document.line)
    fields = RowFields(document.data, (), notes)
    kind = fields.text("kind", required=True)
    maker = _KINDS.get(kind)
    if maker is None:
        if kind:
            meant = near(kind, _KINDS) or "sine"
            fields.fail("kind", f"must be one of {', '.join(_KINDS)}", f'write kind = "{meant}"')
        raise InputError(notes.problems)
    result = maker(fields, Path(path).parent)
    fields.close()
    if result is not None and joints is not None and result.n != joints:
        rule = f"moves {result.n} joints, but the arm has {joints}"
        fields.fail("kind", rule, f"give {joints} values, one a joint")
    if notes.problems or result is None:
        raise InputError(notes.problems)
    return result


class RowFields(Fields):
    """Fields with rows of numbers of any sign."""

    def row(self, key: str, low: Fraction, high: Fraction, unit: str, required: bool = True) -> Row | None:
        """A list of numbers between two bounds, ``None`` when absent or bad."""
        value = self.raw(key, required)
        if value is None:
            return None
        example = f"write {key} = [0, 0, 0]"
        if not isinstance(value, list) or not value:
            self.fail(key, "must be a list of numbers, one a joint", example)
            return None
        return self._inside(key, value, low, high, unit)

    def seconds(self, key: str, low: Fraction, high: Fraction) -> Fraction | None:
        """A time, required; ``None`` when bad."""
        value = self.raw(key, required=True)
        row = None if value is None else self._inside(key, [value], low, high, "s", single=True)
        return None if row is None else row[0]

    def _inside(
        self, key: str, values: list[object], low: Fraction, high: Fraction, unit: str, single: bool = False
    ) -> Row | None:
        kept = []
        for i, value in enumerate(values):
            path = (*self.path, key) if single else (*self.path, key, i)
            plain = isinstance(value, int | Fraction) and not isinstance(value, bool)
            exact = Fraction(cast("Fraction", value)) if plain else None
            if exact is not None and low <= exact <= high:
                kept.append(exact)
                continue
            rule = f"must be a number from {float(low):g} to {float(high):g} {unit}"
            if isinstance(value, NotFinite):
                rule = value.rule
            self.notes.fail(path, value, rule, f"give a plain decimal in {unit}")
        return tuple(kept) if len(kept) == len(values) else None

    def same_length(self, rows: dict[str, Row | None]) -> bool:
        """Whether all rows are there and of one length; notes those of another length than the first."""
        lists = {key: self.data.get(key) for key in rows}
        given = {key: value for key, value in lists.items() if isinstance(value, list) and value}
        first = next(iter(given), "")
        for key, row in given.items():
            if len(row) != len(given[first]):
                rule = f"has {len(row)} values where {first} has {len(given[first])}"
                self.fail(key, rule, f"give {len(given[first])} values, one a joint")
        return None not in rows.values() and len({len(row) for row in given.values()}) == 1


def _sine(fields: RowFields, folder: Path) -> Reference | None:
    amplitude = fields.row("amplitude", -FARTHEST, FARTHEST, "degrees")
    frequency = fields.row("frequency", Fraction(0), FASTEST, "Hz")
    rows = {"amplitude": amplitude, "frequency": frequency}
    zeros = (Fraction(0),) * len(amplitude or frequency or ())
    for key in ("phase", "offset"):
        given = fields.row(key, -FARTHEST, FARTHEST, "degrees", required=False)
        rows[key] = given if key in fields.data else zeros
    if not fields.same_length(rows):
        return None
    return Sine(*(row for row in rows.values() if row is not None))


def _minimum_jerk(fields: RowFields, folder: Path) -> Reference | None:
    start, end = (fields.row(key, -FARTHEST, FARTHEST, "degrees") for key in ("from", "to"))
    seconds = fields.seconds("duration", QUICKEST, LONGEST)
    fit = fields.same_length({"from": start, "to": end})
    if not fit or start is None or end is None or seconds is None:
        return None
    return MinimumJerk(start, end, seconds)


def _recorded(fields: RowFields, folder: Path) -> Reference | None:
    name = fields.text("file", required=True)
    spline = fields.choice("spline", tuple(DEGREES), "cubic")
    if not name or spline not in DEGREES:
        return None
    try:
        t, q = read_samples(folder / name, DEGREES[spline] + 1)
    except InputError as error:
        fields.notes.problems += error.problems
        return None
    if t[-1] - t[0] > LONGEST:
        fields.fail("file", f"covers more than {float(LONGEST):g} s", "record a shorter motion")
        return None
    return Recorded(t, q, spline, name)


_KINDS: dict[str, Callable[[RowFields, Path], Reference | None]] = {
    "sine": _sine,
    "minimum-jerk": _minimum_jerk,
    "recorded": _recorded,
}


# --- A recorded motion, made smooth by a spline.


# --- Samples of a recorded motion: a CSV file with columns t, q1, …, qn, read strictly.


MOST_ROWS = 200_000
MOST_PROBLEMS = 20
"""Problems that are reported of one file; the others are most often the same slip again."""

_COLUMN = re.compile(r"q(?P<joint>[1-9]\d?) ?\[(?P<unit>rad|deg|°)\]")
_TIME = ("t", "t [s]")


@dataclass
class _Table:
    """What was read of a file so far, and what is wrong with it."""

    name: str
    problems: list[Problem] = field(default_factory=list)
    columns: dict[int, tuple[int, float]] = field(default_factory=dict)
    """Of each joint, counted from 1: its column and what a number there is in rad."""
    time: int = -1
    rows: list[list[float]] = field(default_factory=list)
    latest: float = -math.inf
    """s, the largest time so far."""

    def fail(self, line: int | None, key: str, value: str, rule: str, repair: str) -> None:
        if len(self.problems) < MOST_PROBLEMS:
            self.problems.append(Problem(self.name, line, key, printable(value)[:60], rule, repair))


def read_samples(path: Path, least: int) -> tuple[Array, Array]:
    """Times (N,) in s and angles (N, n) in rad.

    The header names the columns: ``t`` or ``t [s]``, and ``q1 [rad]`` or ``q1 [deg]`` for each joint. Other
    columns are left aside, so that the samples of one simulated run can be read back.

    Args:
        path: of the file.
        least: how many samples are needed.

    Raises:
        InputError: what is wrong with the file, each problem with its line.
    """
    table = _Table(str(path))
    text = read_text(path, SAMPLES, newline="")
    try:
        _read(table, csv.reader(io.StringIO(text, newline=""), strict=True))
    except csv.Error as error:
        table.fail(None, "file", "", f"is not CSV ({error})", "write numbers separated by commas")
    if not table.problems and len(table.rows) < least:
        rule = f"has {len(table.rows)} samples, but the spline needs {least}"
        table.fail(None, "file", "", rule, "record more samples")
    if table.problems:
        raise InputError(table.problems)
    values = np.array(table.rows)
    return values[:, 0], values[:, 1:]


def _read(table: _Table, lines: csv._reader) -> None:  # type: ignore[name-defined]
    _header(table, [word.strip() for word in next(lines, [])])
    if table.problems:
        return
    for row in lines:
        if len(table.rows) >= MOST_ROWS:
            rule = f"has more than {MOST_ROWS} samples"
            table.fail(lines.line_num, "file", "", rule, "record fewer, or split the motion")
            return
        if row:
            _sample(table, lines.line_num, row)


def _header(table: _Table, names: list[str]) -> None:
    for column, name in enumerate(names):
        result = _COLUMN.fullmatch(name)
        if name in _TIME:
            table.time = column
        elif result is not None:
            unit = 1.0 if result["unit"] == "rad" else math.radians(1.0)
            table.columns[int(result["joint"])] = (column, unit)
    known = sorted(table.columns)
    if table.time < 0:
        table.fail(1, "header", ",".join(names), "names no column t", "begin with t [s],q1 [rad]")
    if not known or known != list(range(1, len(known) + 1)):
        rule = "must name one column a joint with its unit, from 1 on"
        table.fail(1, "header", ",".join(names), rule, "write t [s],q1 [deg],q2 [deg] or q1 [rad]")


def _sample(table: _Table, line: int, row: list[str]) -> None:
    t = _number(table, line, "t", row, table.time)
    q = [
        unit * _number(table, line, f"q{joint}", row, column)
        for joint, (column, unit) in sorted(table.columns.items())
    ]
    if t <= table.latest < math.inf:
        rule = "times must increase, and do not here"
        table.fail(line, "t", row[table.time], rule, "keep the samples of one run, in order")
        table.latest = math.inf  # one slip: what follows is not reported as well
    table.latest = max(table.latest, t) if math.isfinite(t) else table.latest
    if all(map(math.isfinite, (t, *q))):
        table.rows.append([t, *q])


def _number(table: _Table, line: int, key: str, row: list[str], column: int) -> float:
    """A finite number of a row; NaN, and a problem, where there is none."""
    word = row[column].strip() if column < len(row) else ""
    try:
        value = float(word)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        table.fail(line, key, word, "must be a finite decimal number", "write a plain decimal like 0.25")
        return math.nan
    return value
