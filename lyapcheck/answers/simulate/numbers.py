"""Numbers of a run for people and for programs."""

from __future__ import annotations

import math
from collections.abc import Iterable
from fractions import Fraction

from lyapcheck.output.digits import NONE, at_least, at_most, shown


def cell(value: float | None, form: str) -> str:
    """A number in a form, a dash where there is none."""
    return shown(value, form)


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


def row(values: Iterable[float]) -> str:
    """Numbers in parentheses."""
    return f"({', '.join(shown(value, 'g') for value in values)})"
