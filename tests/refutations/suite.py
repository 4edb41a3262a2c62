"""Planting the faults, asking the oracle which of them are false, and deciding those."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import lru_cache
from typing import TypeVar

import numpy as np

from lyapcheck.claims.procedures import propose
from lyapcheck.claims.statements import Statement
from lyapcheck.verdicts import Verdict
from tests import oracle
from tests.refutations.mutations import Fault, faults_of
from tests.refutations.statements import Part, parts

LEAST = 150
"""How many planted faults there must be."""
MANY, FEW = 4, 14
"""Where some faults are enough they are planted in one statement of so many of a kind; ``python -m
tests.refutations`` plants all."""

SEED = 1871
KINDS = (
    *("Identity", "ForAll", "Constant", "NormBound", "Implies", "ForSmall", "Agrees", "BoundEveryN"),
    *("TrigonometricBound", "TrigonometricPositive", "EveryN"),
)
Item = TypeVar("Item")
Decide = Callable[[Statement], Verdict]


@dataclass(frozen=True)
class Outcome:
    """What came of a fault that is false."""

    fault: Fault
    verdict: Verdict


@dataclass(frozen=True)
class Planted:
    """The faults that are false; ``others`` counts those not known to be false, by kind.

    ``broken`` are statements that are false as they stand, ``unjudged`` those of a kind the oracle has no
    numbers for: in neither are faults planted.
    """

    false: tuple[Fault, ...]
    others: Counter[str]
    broken: tuple[str, ...]
    unjudged: tuple[str, ...]


@lru_cache(maxsize=3)
def planted(one_in: int = 1) -> Planted:
    """Every fault in every statement of the proofs, or in one in so many of a kind, that holds as it is."""
    kinds: dict[type[Statement], list[Part]] = {}
    for part in parts():
        kinds.setdefault(type(part.statement), []).append(part)
    return plant(part for result in kinds.values() for part in result[::one_in])


def plant(originals: Iterable[Part]) -> Planted:
    """The faults of some statements, each different mutant once."""
    judged, unjudged = _split(originals, lambda part: type(part.statement).__name__ in KINDS)
    broken, sound = _split(judged, lambda part: _is_false(part.statement))
    mutants = {fault.statement: fault for part in sound for fault in reversed(faults_of(part))}
    false, others = _split(mutants.values(), lambda fault: _is_false(fault.statement))
    return Planted(
        tuple(sorted(false, key=lambda fault: fault.name)),
        Counter(fault.kind for fault in others),
        tuple(part.where for part in broken),
        tuple(part.where for part in unjudged),
    )


def _is_false(statement: Statement) -> bool:
    return oracle.objection(statement, SEED) is not None


def _split(items: Iterable[Item], test: Callable[[Item], bool]) -> tuple[list[Item], list[Item]]:
    """The items that pass a test, and the others."""
    passed: list[Item] = []
    failed: list[Item] = []
    for item in items:
        (passed if test(item) else failed).append(item)
    return passed, failed


def verdict_of(statement: Statement) -> Verdict:
    """The verdict of lyapcheck; what overflows while it looks for points is no point."""
    with np.errstate(all="ignore"):
        return propose(statement).verdict


def outcomes(faults: Iterable[Fault], by: Decide = verdict_of) -> list[Outcome]:
    """What a decision procedure says of each fault."""
    return [Outcome(fault, by(fault.statement)) for fault in faults]


def wrongly_proved(result: Iterable[Outcome]) -> list[str]:
    """The names of the false statements that were proved."""
    return [outcome.fault.name for outcome in result if outcome.verdict is Verdict.PROVED]
