"""Samples of a recorded motion: a CSV file with columns t, q1, …, qn, read strictly."""

from __future__ import annotations

import csv
import io
import math
import re
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from lyapcheck._types import Array
from lyapcheck.errors import InputError, Problem
from lyapcheck.files.reader import SAMPLES, read_text
from lyapcheck.output.escapes import printable

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
