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

from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import cast

from lyapcheck.errors import InputError, near
from lyapcheck.files.decimals import NotFinite
from lyapcheck.files.fields import Fields, Notes
from lyapcheck.files.toml import open_document
from lyapcheck.simulate.reference.base import MinimumJerk, Reference, Sine
from lyapcheck.simulate.reference.recorded import DEGREES, Recorded, read_samples

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
