"""Reading the tables of an arm file: numbers with unit and provenance on top of the plain getters."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from fractions import Fraction
from typing import Any, cast

from lyapcheck.errors import argument_error
from lyapcheck.files.decimals import decimal_text
from lyapcheck.files.fields import RETYPE, UNPRINTABLE, Fields, Notes
from lyapcheck.files.toml import KeyPath

# --- A number of an arm with where it comes from and how far it can be trusted.


@dataclass(frozen=True)
class Number:
    """One exact number of an arm, with unit and source, and a range if it is uncertain.

    Args:
        value: the nominal value, exactly as written.
        unit: SI unit as text (``"kg·m²"``), empty for a count.
        source: the place where the value is printed, or the reason for it.
        assumed: true when no source prints the number for this arm.
        low: smallest possible value. None if the number has no range.
        high: largest possible value. None if the number has no range.
        note: a note for the reader of a result that uses this number.

    Soundness:
        a statement made at ``value`` says nothing about the rest of ``[low, high]``.
    """

    value: Fraction
    unit: str = ""
    source: str = ""
    assumed: bool = False
    low: Fraction | None = None
    high: Fraction | None = None
    note: str = ""

    @property
    def bounds(self) -> tuple[Fraction, Fraction]:
        """The range ``(low, high)``; both the value itself when the number has no range."""
        low = self.value if self.low is None else self.low
        high = self.value if self.high is None else self.high
        return low, high

    @property
    def ranged(self) -> bool:
        low, high = self.bounds
        return low < high

    def widened(self, share: Fraction) -> Number:
        """The number with the range value·(1 ± share), unless it has a range of its own or is 0.

        Args:
            share: 0 ≤ share < 1.
        """
        if self.ranged or self.value == 0 or share == 0:
            return self
        ends = sorted((self.value * (1 - share), self.value * (1 + share)))
        return replace(self, low=ends[0], high=ends[1])

    def sentence(self, name: str) -> str:
        """The assumption as a sentence for a report, e.g. ``base_inertia = 0.5 kg·m² is assumed (…)``."""
        text = f"{name} = {with_unit(self.value, self.unit)} is assumed"
        if self.ranged:
            low, high = self.bounds
            text += f", between {decimal_text(low)} and {with_unit(high, self.unit)}"
        reason = self.note or self.source
        return f"{text}: {reason}" if reason else text


def with_unit(value: Fraction, unit: str) -> str:
    """The value in decimals followed by its unit, if it has one."""
    return f"{decimal_text(value)} {unit}".rstrip()


LARGEST = 10**12
"""No number of an arm in SI units is larger; beyond it sits a slip, and no double holds its square."""


_DECIMAL = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE]([+-]?[0-9]{1,3}))?")


def decimal(text: str) -> Fraction | None:
    """The exact value of a decimal in a file of a robot (``1``, ``.5``, ``5.``, ``1e-3``), or ``None``."""
    result = _DECIMAL.fullmatch(text) if len(text) <= 60 else None
    return None if result is None else Fraction(text)


class Sign(Enum):
    """Which values a number may have over its whole range."""

    ANY = "any number"
    NONNEGATIVE = "zero or positive"
    POSITIVE = "positive"

    def allows(self, low: Fraction) -> bool:
        """Whether a number whose smallest value is ``low`` is of this sign."""
        return self is Sign.ANY or low > 0 or (self is Sign.NONNEGATIVE and low == 0)


class ArmNotes(Notes):
    """The problems of an arm file, and the source of the numbers that name none themselves."""

    def __init__(self, file: str, line: Callable[[KeyPath], int | None], source: str) -> None:
        super().__init__(file, line)
        self.source = source


class ArmFields(Fields):
    """The keys of one table of an arm file."""

    def texts(self, key: str) -> tuple[str, ...]:
        value = self.raw(key)
        if value is None:
            return ()
        if not isinstance(value, list) or not all(isinstance(item, str) and item.strip() for item in value):
            self.fail(key, "must be a list of non-empty texts", f'write {key} = ["…", "…"]')
            return ()
        for i, item in enumerate(value):
            if not item.isprintable():
                self.notes.fail((*self.path, key, i), item, UNPRINTABLE, RETYPE)
        return tuple(value)

    def quantity(self, key: str, unit: str, sign: Sign = Sign.ANY, required: bool = False) -> Number | None:
        """A decimal, or a table of a value with its provenance; ``None`` when absent or bad."""
        value = self.raw(key, required)
        number = None if value is None else self._quantity((*self.path, key), value, unit)
        if number is not None and not sign.allows(number.bounds[0]):
            self.fail(key, f"must be {sign.value}", "correct the value, or the low end of its range")
            return None
        return number

    def vector(self, key: str, unit: str) -> tuple[Number, ...] | None:
        value = self.raw(key, required=True)
        if value is None:
            return None
        if not isinstance(value, list) or len(value) != 3:
            self.fail(key, "must be a list of 3 numbers", f"write {key} = [0, 0, 0]")
            return None
        items = [self._quantity((*self.path, key, i), item, unit) for i, item in enumerate(value)]
        kept = tuple(item for item in items if item is not None)
        return kept if len(kept) == 3 else None

    def decimal(self, path: KeyPath, value: object) -> Fraction | None:
        if isinstance(value, int | Fraction) and not isinstance(value, bool):
            exact = Fraction(value)
            if abs(exact) <= LARGEST:
                return exact
            self.notes.fail(path, value, f"must be at most {LARGEST} in size", "use SI units")
            return None
        self.notes.fail(path, value, "must be a finite decimal number", "write a plain decimal like 0.091")
        return None

    def _quantity(self, path: KeyPath, value: object, unit: str) -> Number | None:
        source = cast(ArmNotes, self.notes).source
        if not isinstance(value, dict):
            exact = self.decimal(path, value)
            return None if exact is None else Number(exact, unit, source)
        inner = ArmFields(value, path, self.notes)
        number = inner._described(unit, source)
        inner.close()
        return number

    def _described(self, unit: str, default: str) -> Number | None:
        parts = {key: self.raw(key, required=key == "value") for key in ("value", "low", "high")}
        value, low, high = (
            None if x is None else self.decimal((*self.path, key), x) for key, x in parts.items()
        )
        given, source, note = self.text("unit"), self.text("source"), self.text("note")
        if unit and given and given != unit:
            self.fail("unit", f"must be {unit}", f"convert the value to {unit}")
        assumed = self.raw("assumed")
        if assumed is not None and not isinstance(assumed, bool):
            self.fail("assumed", "must be true or false", "write assumed = true")
        assumed = assumed is True
        if assumed and not (note or source):
            self.fail("assumed", "an assumption needs its reason", 'add note = "why this value"')
        if ("low" in self.data) != ("high" in self.data):
            present = "low" if "low" in self.data else "high"
            self.fail(present, "a range needs both ends", "give both low and high")
        if value is not None and low is not None and high is not None and not low <= value <= high:
            ends = f"[{decimal_text(low)}, {decimal_text(high)}]"
            self.fail("value", f"must lie in its range {ends}", "correct value, low or high")
        if value is None:
            return None
        origin = source or ("" if assumed else default)
        return Number(value, given or unit, origin, assumed, low, high, note)


# --- A range that a user gives to a number of an arm, such as ``viscous=-30%..+0%``.

OPTION = "--vary"
PAYLOAD = "payload"
_FORM = re.compile(r"(\w+)=([+-]?[\d.]+)(%?)\.\.([+-]?[\d.]+)(%?)", re.ASCII)


@dataclass(frozen=True)
class Vary:
    """One number of an arm, or one of every joint or link, with a range.

    Args:
        name: of a number such as ``base_inertia``, or the last part of such names: ``viscous``, ``mass``.
            A ``payload`` is a mass at the centre of mass of the last link.
        low, high: the range, in the number's unit or as shares of its value.
        relative: whether they are shares: −30 % is 0.7.
    """

    name: str
    low: Fraction
    high: Fraction
    relative: bool = False

    @classmethod
    def parsed(cls, text: str) -> Vary:
        """The meaning of ``NAME=LO..HI``, both in percent of the number's value or both in its unit.

        Raises:
            InputError: text of another form, or an empty range.
        """
        result = _FORM.fullmatch(text.replace(" ", "").replace("−", "-"))
        repair = "write --vary viscous=-30%..+0%, or --vary payload=0..3"
        if result is None or bool(result[3]) != bool(result[5]):
            raise argument_error(OPTION, text, "is not of the form NAME=LO..HI", repair)
        try:
            low, high = Fraction(result[2]), Fraction(result[4])
        except ValueError:
            raise argument_error(OPTION, text, "has an end that is no number", repair) from None
        if low > high:
            raise argument_error(OPTION, text, "is an empty range", "give the smaller end first")
        if result[1] == PAYLOAD and (result[3] or low < 0):
            rule = "is no mass: a payload is in kg, from 0 on"
            raise argument_error(OPTION, text, rule, "write --vary payload=0..3")
        if result[3]:
            low, high = 1 + low / 100, 1 + high / 100
        return cls(result[1], low, high, bool(result[3]))

    @property
    def text(self) -> str:
        ends = [100 * (x - 1) if self.relative else x for x in (self.low, self.high)]
        unit = "%" if self.relative else ""
        return f"{self.name}={'..'.join(decimal_text(x) + unit for x in ends)}"

    def matches(self, key: str) -> bool:
        return key == self.name or key.endswith(f"_{self.name}")

    def of(self, number: Number) -> Number:
        """The number with the range in place of its own.

        The value stays where it lies within. Else it is the nearest end, a member of the range and not the
        nominal value any more; ``outside`` names such numbers.
        """
        low, high = sorted(x * number.value if self.relative else x for x in (self.low, self.high))
        return replace(number, value=min(max(number.value, low), high), low=low, high=high)


# --- What an arm file says of a joint: friction, limits, encoder.


ROTOR = "_rotor_inertia"
PARTS = ("viscous", "coulomb", "torque_limit", "encoder", "gravity_bound")
_NAME = re.compile(r"[a-z][a-z0-9_]{0,30}")


@dataclass(frozen=True)
class JointEntry:
    """One joint as read; ``None`` where the file says nothing (or nothing usable)."""

    name: str
    viscous: Number | None
    coulomb: Number | None
    torque_limit: Number | None
    encoder: int | None
    gravity_bound: Number | None
    rotor: Number | None = None

    @property
    def rotors(self) -> dict[str, Number]:
        """Its rotor inertia, which is a number of M(q), under the name that reports use."""
        return {} if self.rotor is None else {f"{self.name}{ROTOR}": self.rotor}

    def numbers(self) -> dict[str, Number]:
        """The other numbers of the joint under the names that reports use."""
        result = {f"{self.name}_{part}": getattr(self, part) for part in PARTS if part != "encoder"}
        return {name: number for name, number in result.items() if number is not None}


def of_joints(joints: Sequence[JointEntry], spread: Fraction = Fraction(0)) -> dict[str, Any]:
    """What joints, base first, say of a `RobotModel`; friction without a range gets value·(1 ± spread)."""
    kept = {key: tuple(getattr(joint, key) for joint in joints) for key in PARTS}
    viscous = tuple(x.widened(spread) for x in kept["viscous"] if x is not None)
    return kept | {"joints": tuple(joint.name for joint in joints), "viscous": viscous}


def read_joints(top: ArmFields, key: str, tables: list[ArmFields], most: int) -> list[JointEntry]:
    """The joints of ``[[links]]`` or ``[[joints]]``, base first; names must differ."""
    if len(tables) > most:
        top.fail(key, f"has more than {most} joints", "give an arm of fewer joints")
    joints: list[JointEntry] = []
    for fields in tables:
        name, kind = fields.text("name", required=True), fields.text("type")
        if name and not _NAME.fullmatch(name):
            rule = "must be up to 31 small letters, digits and underscores, a letter first"
            fields.fail("name", rule, 'write a name like "shoulder"')
        if kind not in ("", "revolute", "continuous"):
            rule = "only revolute joints are understood"
            if kind == "prismatic":
                rule = "the paper assumes revolute joints: its bounds on M, C and g fail for a prismatic one"
            fields.fail("type", rule, "remove the joint, or hold it fixed and give the arm without it")
        if name and name in [other.name for other in joints]:
            fields.fail("name", "is used by another joint", "give each joint its own name")
        joints.append(read_motor(name, fields, required=True))
    return joints


def read_motor(name: str, fields: ArmFields, required: bool) -> JointEntry:
    """Friction, limits and encoder of a joint."""
    value, rotor = fields.data.get("rotor_inertia"), None
    if not isinstance(value, dict) or "value" in value:
        rotor = fields.quantity("rotor_inertia", "kg·m²", Sign.NONNEGATIVE)
    elif (table := fields.table("rotor_inertia")) is not None:  # of the rotor itself, which the gear squares
        own = table.quantity("rotor", "kg·m²", Sign.NONNEGATIVE, required=True)
        gear = table.quantity("gear", "", Sign.POSITIVE, required=True)
        table.close()
        if gear is not None and gear.ranged:
            table.fail("gear", "must be exact", "give a plain number")
        if own is not None and gear is not None:
            low, high = (None if end is None else end * gear.value**2 for end in (own.low, own.high))
            rotor = replace(own, value=own.value * gear.value**2, low=low, high=high)
    return JointEntry(
        name,
        fields.quantity("viscous", "N·m·s/rad", Sign.NONNEGATIVE, required=required),
        fields.quantity("coulomb", "N·m", Sign.NONNEGATIVE),
        fields.quantity("torque_limit", "N·m", Sign.POSITIVE),
        fields.integer("encoder", 1, 2**40),
        fields.quantity("gravity_bound", "N·m", Sign.NONNEGATIVE),
        rotor,
    )
