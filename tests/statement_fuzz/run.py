"""Many statements: decided and judged one after the other, counted by kind."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field

from tests.statement_fuzz.generators import draw
from tests.statement_fuzz.judge import Judged, judge


@dataclass
class Tally:
    """Counts of verdicts by kind and by family, and the faults with the index of their statements."""

    verdicts: Counter[tuple[str, str]] = field(default_factory=Counter)
    families: Counter[tuple[str, str, str]] = field(default_factory=Counter)
    faults: list[tuple[int, Judged]] = field(default_factory=list)

    def enter(self, index: int, judged: Judged) -> None:
        """Count one statement."""
        self.verdicts[judged.kind, judged.verdict] += 1
        self.families[judged.kind, judged.made.family, judged.verdict] += 1
        if judged.fault:
            self.faults.append((index, judged))

    def __add__(self, other: Tally) -> Tally:
        return Tally(
            self.verdicts + other.verdicts,
            self.families + other.families,
            sorted([*self.faults, *other.faults], key=lambda f: f[0]),
        )

    @property
    def statements(self) -> int:
        """How many were judged."""
        return sum(self.verdicts.values())


def run(seed: int, indices: Iterable[int], only: str | None = None) -> Tally:
    """The statements of a seed with these indices."""
    tally = Tally()
    for index in indices:
        tally.enter(index, judge(draw(seed, index, only), index))
    return tally
