"""Many statements: decided and judged one after the other, counted by kind."""

from __future__ import annotations

import hashlib
import json
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

import lyapcheck.check
from lyapcheck.check.codec import from_json
from lyapcheck.check.statement import Statement
from tests.statement_fuzz.generators import Made, draw
from tests.statement_fuzz.judge import Judged, judge


@dataclass(frozen=True)
class Recorded:
    """A fault of an earlier run, of which the words are left."""

    words: str

    @property
    def kind(self) -> str:
        """The kind of statement."""
        return self.words.partition(",")[0]

    @property
    def signature(self) -> tuple[str, ...]:
        """What faults of the same sort have in common."""
        return (self.words.partition("\n")[0],)

    def text(self) -> str:
        """The fault with the statement."""
        return self.words

    def now(self) -> str:
        """What today's program makes of the statement; how it was made, and so its truth, is not kept."""
        statement = from_json(Statement, json.loads(self.words.partition("\n")[2]), "statement")
        judged = judge(Made(statement, "recorded"))
        against = f"but {judged.fault}" if judged.fault else "and nothing is against it"
        return f"Today: {judged.verdict}, {against}."


@dataclass
class Tally:
    """Counts of verdicts by kind and by family, the faults with the index of their statements, and by digest
    of ``lyapcheck/check`` how many statements that checker judged."""

    verdicts: Counter[tuple[str, str]] = field(default_factory=Counter)
    families: Counter[tuple[str, str, str]] = field(default_factory=Counter)
    faults: list[tuple[int, Judged | Recorded]] = field(default_factory=list)
    checkers: Counter[str] = field(default_factory=Counter)

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
            self.checkers + other.checkers,
        )

    def data(self) -> dict[str, Any]:
        """The counts as plain data; of the faults their number and words."""
        return {
            "verdicts": [[*key, count] for key, count in sorted(self.verdicts.items())],
            "families": [[*key, count] for key, count in sorted(self.families.items())],
            "faults": [[index, judged.text()] for index, judged in self.faults],
            "checkers": dict(self.checkers),
        }

    @classmethod
    def of(cls, data: dict[str, Any]) -> Tally:
        """The tally of some data."""
        verdicts = Counter({(kind, verdict): count for kind, verdict, count in data["verdicts"]})
        families = Counter({(kind, name, verdict): count for kind, name, verdict, count in data["families"]})
        faults: list[tuple[int, Judged | Recorded]] = [
            (index, Recorded(text)) for index, text in data["faults"]
        ]
        return cls(verdicts, families, faults, Counter(data["checkers"]))

    @property
    def statements(self) -> int:
        """How many were judged."""
        return sum(self.verdicts.values())


@dataclass
class Run:
    """The statements of a seed, of all generators or of ``only`` one, as far as they are judged."""

    seed: int
    only: str | None
    tally: Tally = field(default_factory=Tally)

    def data(self) -> dict[str, Any]:
        """The run as plain data."""
        return {"seed": self.seed, "only": self.only} | self.tally.data()

    @classmethod
    def of(cls, data: dict[str, Any]) -> Run:
        """The run of some data."""
        return cls(data["seed"], data["only"], Tally.of(data))


def run(seed: int, indices: Iterable[int], only: str | None = None) -> Tally:
    """The statements of a seed with these indices."""
    tally = Tally()
    for index in indices:
        tally.enter(index, judge(draw(seed, index, only), index))
    tally.checkers[checker()] = tally.statements
    return tally


@cache
def checker() -> str:
    """The first digits of the SHA-256 of the sources of ``lyapcheck/check``."""
    sources = sorted(Path(lyapcheck.check.__file__).parent.rglob("*.py"))
    return hashlib.sha256(b"".join(source.read_bytes() for source in sources)).hexdigest()[:12]
