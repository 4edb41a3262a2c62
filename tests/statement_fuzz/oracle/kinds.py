"""For each kind of statement: how an objection to it is looked for, how a counterexample is judged.

A kind that is not entered is never objected to, and its counterexamples are not judged.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from random import Random
from typing import Any

from tests.statement_fuzz.oracle.region import Objection

Objections = Callable[[Any, Random], Objection | None]
Judgements = Callable[[Any, Mapping[str, Any]], bool | None]

OBJECTIONS: dict[str, Objections] = {}
JUDGEMENTS: dict[str, Judgements] = {}


def objections_to(kind: str) -> Callable[[Objections], Objections]:
    """Enter a function that looks for an objection to statements of a kind."""

    def enter(function: Objections) -> Objections:
        OBJECTIONS[kind] = function
        return function

    return enter


def judges(kind: str) -> Callable[[Judgements], Judgements]:
    """Enter a function that says whether a witness refutes a statement; ``None``: not known."""

    def enter(function: Judgements) -> Judgements:
        JUDGEMENTS[kind] = function
        return function

    return enter


def objection(statement: Any, seed: int) -> Objection | None:
    """Why a statement is not true, if that is found."""
    _load()
    function = OBJECTIONS.get(type(statement).__name__)
    return None if function is None else function(statement, Random(seed))


def confirms(statement: Any, witness: Mapping[str, Any]) -> bool | None:
    """Whether a witness, as a decision gives it, refutes a statement; ``None`` where that is not known."""
    _load()
    function = JUDGEMENTS.get(type(statement).__name__)
    return None if function is None else function(statement, witness)


def known() -> frozenset[str]:
    """The kinds of statement that the oracle knows something against."""
    _load()
    return frozenset(OBJECTIONS)


def _load() -> None:
    from tests.statement_fuzz.oracle import (  # noqa: F401
        arms,
        bounds,
        chains,
        decreasing,
        every_n,
        printed,
        properties,
        proposed,
        relations,
        resting,
        same_harmonics,
        small,
        stability,
    )
