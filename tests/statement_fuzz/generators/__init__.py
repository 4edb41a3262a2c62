"""Statements at random, one module a kind; :func:`draw` makes one from a seed and an index.

To add a kind: a function from ``Random`` to :class:`Made`, entered with :func:`generates`, in a module that
``_load`` names.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from random import Random
from typing import Any

TRUE = "true"
FALSE = "false"
NEITHER = "neither"
UNPROVABLE = "unprovable"


@dataclass(frozen=True)
class Made:
    """A statement with what is known of it by construction.

    ``truth`` is TRUE, FALSE, NEITHER (undefined somewhere, false nowhere), UNPROVABLE (false or undefined)
    or ``None`` where only the oracle can say.
    """

    statement: Any
    family: str
    truth: str | None = None


Generator = Callable[[Random], Made]
GENERATORS: dict[str, tuple[float, Generator]] = {}


def generates(name: str, weight: float) -> Callable[[Generator], Generator]:
    """Enter a generator, and how often it is asked."""

    def enter(function: Generator) -> Generator:
        GENERATORS[name] = weight, function
        return function

    return enter


def draw(seed: int, index: int, only: str | None = None) -> Made:
    """The statement of a seed and an index, always the same; of one generator, if ``only`` names it."""
    _load()
    random = Random(f"{seed}:{index}")
    names = [only] if only is not None else list(GENERATORS)
    name = random.choices(names, [GENERATORS[n][0] for n in names])[0]
    return GENERATORS[name][1](random)


def names() -> tuple[str, ...]:
    """The names of all generators."""
    _load()
    return tuple(GENERATORS)


def _load() -> None:
    from tests.statement_fuzz.generators import (  # noqa: F401
        altered,
        arms,
        chains,
        constants,
        controlled,
        every_n,
        for_all,
        identities,
        implications,
        moving_arms,
        norms,
        printed,
        properties,
        proposed,
        resting,
        small,
        stability,
        trigonometric,
    )
