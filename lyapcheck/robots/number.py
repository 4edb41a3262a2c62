"""A number of an arm with where it comes from and how far it can be trusted."""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction

from lyapcheck.files.decimals import decimal_text


@dataclass(frozen=True)
class Number:
    """One exact number of an arm, with unit, source and, where it is uncertain, a range.

    Args:
        value: the nominal value, exactly as written.
        unit: SI unit as text (``"kg·m²"``), empty for a count.
        source: where the value is printed, or why it was chosen.
        assumed: true when no source prints the number for this arm.
        low: smallest value it may have; ``None`` when the number has no range.
        high: largest value it may have; ``None`` when the number has no range.
        note: what a reader of a result that rests on this number must know.

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
        """Whether the number may differ from its nominal value."""
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
