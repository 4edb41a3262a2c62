"""A recorded motion, made smooth by a spline."""

from __future__ import annotations

import csv
import io
import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from math import comb
from pathlib import Path
from typing import Any

import numpy as np

from lyapcheck._types import Array
from lyapcheck.errors import InputError, Problem
from lyapcheck.files.reader import SAMPLES, read_text
from lyapcheck.output.escapes import printable
from lyapcheck.simulate.reference.base import Reference, Suprema

DEGREES = {"cubic": 3, "quintic": 5}
"""Splines with two and with four continuous derivatives."""

HALVINGS = 3
"""How often the pieces of the spline are halved before their control points are taken for bounds."""
_SHARE = 2.0**-45
"""More than what some thirty roundings do to a sum, relative to the sum of its absolute terms."""


class Recorded(Reference):
    """The interpolating spline through samples, with not-a-knot ends (``scipy.interpolate``).

    Args:
        t: (N,) s, increasing; the first is taken for 0.
        q: (N, n) rad.
        spline: ``cubic``, q_d of class C², or ``quintic``, of class C⁴.
        name: of the file.
    """

    kind = "recorded"

    def __init__(self, t: Array, q: Array, spline: str = "cubic", name: str = "samples") -> None:
        self.n = q.shape[1]
        self.name, self.spline, self.samples = name, spline, t.size
        path = _spline(t - t[0], q, DEGREES[spline])
        self._parts: tuple[Any, ...] = (path, path.derivative(), path.derivative(2))
        self._together = _stacked(self._parts)
        self.span = self.duration = float(t[-1] - t[0])

    def at(self, t: Array) -> Array:
        """See `Reference.at`; past its end a recording has no value, and the last one is given."""
        return np.asarray(self._together(np.minimum(t, self.duration)))

    def suprema(self) -> Suprema:
        """See `Reference.suprema`.

        In Bernstein form a polynomial is a convex combination of its control points, so the largest of these
        bounds it, joint by joint and in norm.
        """
        (rate, speed), (acceleration, acceleration_norm) = (_bounds(part) for part in self._parts[1:])
        return Suprema(rate, acceleration, speed, acceleration_norm)

    @property
    def sentence(self) -> str:
        """See `Reference.sentence`."""
        return f"{self.samples} samples of {self.name} over {self.span:g} s, {self.spline} spline"


def _spline(t: Array, q: Array, degree: int) -> Any:
    """The spline as polynomials between its knots, coefficients (degree + 1, pieces, n)."""
    from scipy.interpolate import PPoly, make_interp_spline

    joints = [PPoly.from_spline(make_interp_spline(t, column, k=degree)) for column in q.T]
    knots = joints[0].x
    live = np.diff(knots) > 0  # a spline repeats its end knots
    coefficients = np.stack([joint.c[:, live] for joint in joints], axis=-1)
    return PPoly(coefficients, np.append(knots[:-1][live], knots[-1]))


def _stacked(parts: Sequence[Any]) -> Any:
    """Piecewise polynomials with the same knots as one, with values (len(parts), n)."""
    from scipy.interpolate import PPoly

    degree = len(parts[0].c)
    padded = [np.concatenate((np.zeros((degree - len(p.c), *p.c.shape[1:])), p.c)) for p in parts]
    return PPoly(np.stack(padded, axis=-2), parts[0].x)


def _bounds(path: Any) -> tuple[tuple[Fraction, ...], Fraction]:
    """Bounds of each component of a piecewise polynomial, and of its norm, from above."""
    points, error = _control_points(path)
    for _ in range(HALVINGS):
        points = _halved(points)
    size = np.abs(points)
    each = [_up(float(x)) for x in size.max(axis=(0, 1)) + error]
    norm = float(np.max(np.linalg.norm(size, axis=-1)) + np.linalg.norm(error))
    return tuple(each), _up(norm)


def _control_points(path: Any) -> tuple[Array, Array]:
    """(degree + 1, pieces, n) control points, and how far rounding may have moved them, (n,)."""
    powers, widths = path.c[::-1], np.diff(path.x)
    degree = len(powers) - 1
    scaled = powers * widths[None, :, None] ** np.arange(degree + 1)[:, None, None]
    table = np.array([[comb(k, j) / comb(degree, j) for j in range(degree + 1)] for k in range(degree + 1)])
    points = np.einsum("kj,jpn->kpn", table, scaled)
    terms = np.einsum("kj,jpn->kpn", table, np.abs(scaled))
    return points, _SHARE * terms.max(axis=(0, 1))


def _halved(points: Array) -> Array:
    """The control points of both halves of every piece (de Casteljau)."""
    row, left, right = points, [points[0]], [points[-1]]
    while len(row) > 1:
        row = (row[:-1] + row[1:]) / 2
        left.append(row[0])
        right.append(row[-1])
    return np.concatenate((np.stack(left), np.stack(right[::-1])), axis=1)


def _up(value: float) -> Fraction:
    """A little above, exactly: more than the last roundings do, and than squares that underflow in a norm."""
    return Fraction(value * (1.0 + 2.0**-40) + 2.0**-500)


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
