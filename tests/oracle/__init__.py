"""What statements mean, point by point, in an arithmetic that shares no code with lyapcheck.

Expressions are partial real functions. At a point an expression has a value, has certainly none, or is too
close to call, which never is an objection. A kind that is not entered is never objected to.
"""

from dataclasses import dataclass
from importlib import import_module
from random import Random

MODULES = "boxes", "small", "letters", "bounds", "laws", "loop", "properties", "stability", "sampled", "flows"
OBJECTIONS, JUDGEMENTS = {}, {}


@dataclass(frozen=True)
class Objection:
    """Why a statement is not true: it is ``false`` or ``undefined`` at a place."""

    what: str
    place: str

    def __str__(self):
        return f"{self.what} at {self.place}"


def objections_to(*kinds):
    """Enter a function (statement, random) that looks for an objection to statements of some kinds."""
    return lambda function: OBJECTIONS.update(dict.fromkeys(kinds, function)) or function


def judges(*kinds):
    """Enter a function (statement, point) that says whether a point refutes a statement; None: not known."""
    return lambda function: JUDGEMENTS.update(dict.fromkeys(kinds, function)) or function


def objection(statement: object, seed: int = 0) -> Objection | None:
    """Why a statement is not true, if that is found."""
    function = _entered(OBJECTIONS).get(type(statement).__name__)
    return None if function is None else function(statement, Random(seed))


def confirms(statement, point):
    """Whether a point, as a witness gives it, refutes a statement; ``None`` where that is not known."""
    function = _entered(JUDGEMENTS).get(type(statement).__name__)
    return None if function is None else function(statement, point)


def known():
    """The kinds of statement that the oracle knows something against."""
    return frozenset(_entered(OBJECTIONS))


def _entered(table):
    for name in MODULES:
        import_module(f"{__name__}.{name}")
    return table
