"""Theorems about closed loops as data: those of the shipped proofs with one to three things changed.

A change takes another letter, number or sign, leaves out a term or a condition, or asks another theorem.
"""

from __future__ import annotations

import runpy
from collections.abc import Callable, Iterator
from dataclasses import fields, is_dataclass, replace
from fractions import Fraction
from functools import lru_cache
from pathlib import Path
from random import Random
from typing import Any

from tests.statement_fuzz.generators import Made, generates
from tests.statement_fuzz.subject import Case, Relation, Stable

Tree = tuple[Any, ...]
Path_ = tuple[int | str, ...]
PROOFS = Path(__file__).parents[3] / "proofs"
SCRIPTS = (
    "feedforward",
    "kelly_gravity",
    "kelly_santibanez",
    "kelly_tanh",
    "pd_plus",
    "pid",
    "slotine_li",
    "takegaki_arimoto",
    "tomei",
)
OPERATIONS = {
    *["add", "apply", "diag", "div", "dot", "mat", "mul", "neg", "num", "pow", "scale", "sum", "var", "vec"]
}
FRICTION = ("none", "any", "positive")
NAMED = ("var", "vec", "mat", "diag")
FACTORS = ("-1", "0", "2", "1/2", "10", "1/10")


@lru_cache(maxsize=1)
def theorems() -> tuple[Any, ...]:
    """The theorems of the shipped proofs, those that are there to be refused among them."""
    result: list[Any] = []
    for name in SCRIPTS:
        for claim in runpy.run_path(str(PROOFS / f"{name}.py"))["proof"].claims.values():
            statement = claim.statement(Case(2, 2))
            if isinstance(statement, Stable) and statement not in result:
                result.append(statement)
    return tuple(result)


@generates("Stable", 0.6)
def changed(random: Random) -> Made:
    """A theorem with one to three changes."""
    argument = random.choice(theorems()).argument
    for _ in range(random.choice((1, 1, 1, 2, 2, 3))):
        argument = random.choices((_expression, _condition, _kind), (88, 6, 6))[0](argument, random)
    return Made(Stable(argument), "a shipped theorem, changed")


def _expression(argument: Any, random: Random) -> Any:
    places = list(_trees(argument, ()))
    path, tree = random.choice(places)
    operation, *parts = tree
    new: Tree = ("scale" if operation in ("vec", "mat", "diag", "sum", "apply", "scale") else "mul",)
    new += (("num", random.choice(FACTORS)), tree)
    if operation in NAMED and random.random() < 0.7:
        names = sorted({other[1] for _, other in places if other[0] == operation})
        new = (operation, random.choice(names))
    elif operation in ("sum", "add") and len(parts) > 1:
        left_out = random.randrange(len(parts))
        new = (operation, *(part for k, part in enumerate(parts) if k != left_out))
    elif operation == "num":
        new = ("num", str(Fraction(parts[0]) * Fraction(random.choice(FACTORS))))
    return _put(argument, path, new)


def _condition(argument: Any, random: Random) -> Any:
    if not argument.where:
        return argument
    k = random.randrange(len(argument.where))
    one = argument.where[k]
    new = random.choice(((), (Relation(one.right, one.operator, one.left),)))
    return replace(argument, where=(*argument.where[:k], *new, *argument.where[k + 1 :]))


def _kind(argument: Any, random: Random) -> Any:
    system = argument.system
    changes: list[Callable[[], Any]] = [
        lambda: replace(argument, gravity=not argument.gravity),
        lambda: replace(argument, small=not argument.small),
        lambda: replace(argument, local=not argument.local),
        lambda: replace(argument, theorem=random.choice(("strict", "LaSalle", "uniform", "exponential"))),
        lambda: replace(
            argument, system=replace(system, friction=random.choice(("none", "any", "positive")))
        ),
        lambda: replace(argument, system=replace(system, desired=not system.desired)),
    ]
    return random.choice(changes)()


def _trees(value: Any, path: Path_) -> Iterator[tuple[Path_, Tree]]:
    """All expressions in an argument and their places; those of the members of a class stay as they are."""
    if isinstance(value, tuple):
        if value and isinstance(value[0], str) and value[0] in OPERATIONS:
            yield path, value
        for k, part in enumerate(value):
            yield from _trees(part, (*path, k))
    elif is_dataclass(value):
        for field in fields(value):
            if field.name != "member":
                yield from _trees(getattr(value, field.name), (*path, field.name))


def _put(value: Any, path: Path_, new: Tree) -> Any:
    if not path:
        return new
    first, *rest = path
    if isinstance(first, str):
        return replace(value, **{first: _put(getattr(value, first), tuple(rest), new)})
    return (*value[:first], _put(value[first], tuple(rest), new), *value[first + 1 :])
