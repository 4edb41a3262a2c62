"""Statements at random, one module a kind; :func:`draw` makes one from a seed and an index.

To add a kind: a function from ``Random`` to :class:`Made`, entered with :func:`generates`, in a module of
``MODULES``.
"""

from dataclasses import dataclass
from importlib import import_module
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


MODULES = (
    *("one_variable", "relations", "identities", "vectors", "arms", "controlled"),
    *("loops", "flows", "altered"),
)
GENERATORS = {}


def generates(name, weight):
    """Enter a generator, and how often it is asked."""

    def enter(function):
        GENERATORS[name] = weight, function
        return function

    return enter


def draw(seed, index, only=None):
    """The statement of a seed and an index, always the same; of one generator, if ``only`` names it."""
    _load()
    random = Random(f"{seed}:{index}")
    names = [only] if only is not None else list(GENERATORS)
    name = random.choices(names, [GENERATORS[n][0] for n in names])[0]
    return GENERATORS[name][1](random)


def names():
    """The names of all generators."""
    _load()
    return tuple(GENERATORS)


def _load():
    for name in MODULES:
        import_module(f"{__name__}.{name}")
