"""The modules that a verdict rests on: those in which its rules lie, and all that these import.

Kinds of statement and proof that no certificate at hand names are imported by name, and make no object: they
do not count. Of a module all counts, so that there are too many rather than too few.
"""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator
from functools import cache
from pathlib import Path

from lyapcheck import check

PACKAGE = "lyapcheck.check"
ROOT = Path(check.__file__).parent
CORE = tuple(f"{PACKAGE}.{name}" for name in ("recheck", "certificate"))
"""What every verdict goes through; the last one is imported by name."""
FUNCTIONS = f"{PACKAGE}.numbers.functions"
"""The bounded functions, which are imported by name."""
GENERAL = (
    "a statement means what its symbols mean for real numbers; whether a robot is so, no certificate says",
    "Python, its integers and fractions, and SHA-256, by which certificates name each other",
    "python-flint and FLINT: exact polynomials and matrices, and balls that contain what they enclose",
    "doubles of IEEE 754: each corner of a box is the rational number that its double is",
    "that the code of the checker itself is right: recheck --trusted lists it for each verdict",
)
"""What every verdict takes for granted; what a theorem does stands with it."""


def lies_in(places: str) -> list[str]:
    """The modules of a rule, from the places ``module:class`` of its statement and its proof."""
    return sorted({place.partition(":")[0] for place in places.split()})


def modules(rules: Iterable[tuple[str, str]]) -> list[str]:
    """All modules that some rules, pairs (name, places of its classes), rest on."""
    result: set[str] = set()
    waiting = {*CORE, *(module for _, places in rules for module in lies_in(places))}
    while waiting:
        result |= waiting
        waiting = {name for module in waiting for name in _imported(module)} - result
    return sorted(result)


@cache
def _imported(module: str) -> frozenset[str]:
    """The modules of the checker that one imports, wherever in its source, and the packages it is in."""
    names = set(_before(module))
    for node in ast.walk(ast.parse(source(module).read_bytes())):
        if isinstance(node, ast.ImportFrom):
            names |= {f"{node.module}", *(f"{node.module}.{part.name}" for part in node.names)}
    if FUNCTIONS in names:
        names |= {f"{FUNCTIONS}.{file.stem}" for file in source(FUNCTIONS).parent.glob("*.py")}
    return frozenset(name for name in names if f"{name}.".startswith(f"{PACKAGE}.") and source(name).exists())


def _before(module: str) -> Iterator[str]:
    while module != PACKAGE:
        module = module.rpartition(".")[0]
        yield module


def source(module: str) -> Path:
    """The file of a module of the checker."""
    path = ROOT.joinpath(*module.removeprefix(PACKAGE).strip(".").split("."))
    return path / "__init__.py" if path.is_dir() else path.with_suffix(".py")
