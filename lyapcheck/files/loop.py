"""What a ``[loop]`` table says, in a gain file or an arm file: how a computer runs the controller::

[loop]
rate = 400                    # Hz; or period = "2.5 ms"
longest = "3 ms"              # optional: the longest interval between two readings
delay = 1                     # optional: whole samples from reading to torque, 1 without
velocity = "difference"       # or "measured"
filter = [0.5, 0.5]           # optional: taps of a filter of the velocity; or lowpass = 50, in Hz
encoder = "17 bits"           # optional: of every joint; or its counts a turn
unknown_payload = 2           # optional: kg at the last link that the controller does not know
gravity_error = 5             # optional: % by which the controller's g(q) may be wrong
within = 90                   # optional: degrees, prove stability for starts at rest this near to the goal
"""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from fractions import Fraction
from math import isfinite
from typing import Any

from lyapcheck.errors import argument_error
from lyapcheck.files.decimals import decimal_text, of_physical_size
from lyapcheck.files.fields import Fields

VELOCITIES = ("difference", "measured")
MOST_DELAY, MOST_TAPS, MOST_COUNTS = 1_000, 100, 2**40
SHORTEST, LONGEST = Fraction(1, 10**7), Fraction(10)
"""Of a period, s."""
MOST_ERROR = 1_000
"""Of g(q), %."""
FARTHEST = 3_600
"""Of a start, degrees."""
_UNITS = {"s": 1, "ms": 10**3, "us": 10**6, "µs": 10**6, "μs": 10**6}
_TIME = re.compile(rf"([0-9]{{1,9}}(?:\.[0-9]{{1,15}})?) ?({'|'.join(_UNITS)})")
_BITS = re.compile(r"([0-9]{1,2}) ?bits?")


@dataclass(frozen=True)
class LoopEntry:
    """Describe the sampled loop. An entry that is ``None`` comes from the files, or is the default.

    Args:
        period: nominal sampling period, s.
        longest: longest interval between two readings, s.
        delay: whole samples from a reading to its torque.
        velocity: ``difference`` or ``measured``.
        filter: taps of a filter of the velocity, the newest first.
        lowpass: cut-off of a first-order filter of the velocity, Hz.
        encoder: counts per turn of every joint.
        unknown_payload: largest unknown mass at the centre of mass of the last link, kg.
        gravity_error: largest relative error of each gravity torque.
        within: largest initial error, degrees, for a proof of stability of the sampled loop from rest.
    """

    period: Fraction | None = None
    longest: Fraction | None = None
    delay: int | None = None
    velocity: str | None = None
    filter: tuple[Fraction, ...] | None = None
    lowpass: Fraction | None = None
    encoder: int | None = None
    unknown_payload: Fraction | None = None
    gravity_error: Fraction | None = None
    within: Fraction | None = None

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            if name in ("velocity", "filter") or value is None:
                continue
            zero = name in ("delay", "unknown_payload", "gravity_error")
            if isinstance(value, bool) or not isfinite(value) or value < 0 or (value == 0 and not zero):
                rule = "must be a positive number"
                raise argument_error(name, value, rule, "correct the sign or the value")
            if isinstance(value, float):  # the decimal that was typed
                object.__setattr__(self, name, Fraction(repr(float(value))))

    def over(self, other: LoopEntry) -> LoopEntry:
        """The other, with what this one says in place; a period goes with its longest, a filter alone."""
        dropped: dict[str, Any] = {} if self.period is None else {"longest": None}
        if self.filter is not None or self.lowpass is not None:
            dropped |= {"filter": None, "lowpass": None}
        given = {name: value for name, value in vars(self).items() if value is not None}
        return replace(other, **(dropped | given))

    @property
    def toml(self) -> str:
        periods = {name: getattr(self, name) for name in ("period", "longest")}
        lines = [f'{name} = "{decimal_text(10**6 * x)} us"' for name, x in periods.items() if x is not None]
        if self.period is not None and "/" in lines[0]:
            lines[0] = f"rate = {decimal_text(1 / self.period)}"
        for name in ("delay", "lowpass", "encoder", "unknown_payload", "within"):
            value = getattr(self, name)
            lines += [] if value is None else [f"{name} = {decimal_text(value)}"]
        lines += [] if self.velocity is None else [f'velocity = "{self.velocity}"']
        lines += [] if self.filter is None else [f"filter = [{', '.join(map(decimal_text, self.filter))}]"]
        if self.gravity_error is not None:
            lines.append(f"gravity_error = {decimal_text(100 * self.gravity_error)}")
        return "\n".join(["[loop]", *lines])


NOTHING = LoopEntry()


def read_loop(table: Fields | None) -> LoopEntry:
    """What a table says; problems are noted there."""
    if table is None:
        return NOTHING
    rate, period, longest = _positive(table, "rate", "Hz"), _time(table, "period"), _time(table, "longest")
    if rate is not None:
        period = 1 / rate
    if period is not None and not SHORTEST <= period <= LONGEST:
        rule = "must be a period from 0.1 µs to 10 s"
        table.fail("period" if rate is None else "rate", rule, "give the rate of the controller")
    for one, other in (("rate", "period"), ("filter", "lowpass")):
        if one in table.data and other in table.data:
            table.fail(other, f"does not go together with {one}", f"keep {one} or {other}, not both")
    if period is not None and longest is not None and longest < period:
        table.fail("longest", "must not be shorter than the period", "give the longest interval, or none")
    velocity = table.choice("velocity", VELOCITIES, VELOCITIES[0])
    delay = table.integer("delay", 0, MOST_DELAY)
    how = velocity if "velocity" in table.data else None
    taps, lowpass, encoder = _taps(table), _positive(table, "lowpass", "Hz"), _encoder(table)
    unknown = table.number("unknown_payload", positive=False), _share(table), _within(table)
    result = LoopEntry(period, longest, delay, how, taps, lowpass, encoder, *unknown)
    table.close()
    return result


def _positive(table: Fields, key: str, unit: str) -> Fraction | None:
    value = table.raw(key)
    if isinstance(value, str):
        repair = f"give it without its unit, such as 400 for 400 {unit}"
        table.fail(key, f"must be a number, in {unit}", repair)
        return None
    return table.number(key)


def _time(table: Fields, key: str) -> Fraction | None:
    """A text of a number and its unit, in s."""
    value = table.raw(key)
    if value is None:
        return None
    match = _TIME.fullmatch(value.strip()) if isinstance(value, str) else None
    if match is None or not Fraction(match[1]):
        table.fail(key, "must be a time with its unit s, ms or us", 'give it as text, such as "2.5 ms"')
        return None
    return Fraction(match[1]) / _UNITS[match[2]]


def _taps(table: Fields) -> tuple[Fraction, ...] | None:
    value = table.raw("filter")
    if value is None:
        return None
    numbers = isinstance(value, list) and all(
        isinstance(x, int | Fraction) and not isinstance(x, bool) and of_physical_size(x) for x in value
    )
    if not numbers or not 1 <= len(value) <= MOST_TAPS or not any(value):
        rule = f"must be 1 to {MOST_TAPS} taps of a filter, numbers that are not all 0"
        table.fail("filter", rule, "give one for each past difference, the newest first, such as 0.5, 0.5")
        return None
    return tuple(map(Fraction, value))


def _encoder(table: Fields) -> int | None:
    value = table.raw("encoder")
    if value is None:
        return None
    match = _BITS.fullmatch(value.strip()) if isinstance(value, str) else None
    counts: object = 1 << int(match[1]) if match else value
    if isinstance(counts, bool) or not isinstance(counts, int) or not 2 <= counts <= MOST_COUNTS:
        rule = "must be bits or counts a turn, from 1 bit to 40 bits"
        table.fail("encoder", rule, 'give it as "17 bits", or as 131072')
        return None
    return counts


def _share(table: Fields) -> Fraction | None:
    percent = table.number("gravity_error", positive=False)
    if percent is not None and percent > MOST_ERROR:
        table.fail("gravity_error", f"must be at most {MOST_ERROR} %", "give the error in % of g(q)")
        return None
    return None if percent is None else percent / 100


def _within(table: Fields) -> Fraction | None:
    within = table.number("within")
    if within is not None and within > FARTHEST:
        table.fail("within", f"must be at most {FARTHEST} degrees", "give the largest start, such as 90")
        return None
    return within
