"""The code that a verdict rests on: the modules of its rules and what these import, and a fixed core.

The core reads and judges every certificate; it counts as itself, since what it imports beyond that is there
for other kinds of statement. A rule counts with all that its module imports, as the sources say.
"""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator
from functools import cache
from pathlib import Path

PACKAGE = "lyapcheck.check"
ROOT = Path(__file__).parent
CORE = tuple(
    f"{PACKAGE}.{name}"
    for name in (
        "certificate",
        "codec",
        "expressions.grammar",
        "files",
        "finding",
        "guard",
        "judging",
        "limits",
        "recheck",
        "refusal",
        "statement",
        "verify",
        "worker",
    )
)
"""Command line and rendering are not among them: they decide nothing."""
FOLDERS = (f"{PACKAGE}.numbers.functions",)
"""Packages of which every file is imported; so each counts."""


def modules(rules: Iterable[tuple[str, str]]) -> dict[str, int]:
    """The modules that some rules rest on, each with its lines."""
    found = set(CORE)
    for name in {module for _, module in rules}:
        found |= closure(name)
    return {name: lines(name) for name in sorted(found)}


@cache
def closure(module: str) -> frozenset[str]:
    """A module with all of the checker that it imports, directly or not."""
    found, waiting = {module}, [module]
    while waiting:
        new = {name for name in imported(waiting.pop()) if name not in found}
        found |= new
        waiting += new
    return frozenset(found)


@cache
def imported(module: str) -> frozenset[str]:
    """The modules of the checker that one names in its imports, wherever they stand, or has in its folder."""
    inside = source(module).parent.glob("[!_]*.py") if module in FOLDERS else ()
    named = _named(ast.parse(source(module).read_bytes()))
    return frozenset((*named, *(f"{module}.{file.stem}" for file in inside)))


def _named(tree: ast.Module) -> Iterator[str]:
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and f"{node.module}.".startswith(f"{PACKAGE}."):
            for alias in node.names:
                inner = f"{node.module}.{alias.name}"
                yield inner if source(inner).exists() else str(node.module)
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names if f"{alias.name}.".startswith(f"{PACKAGE}."))


def source(module: str) -> Path:
    """The file of a module of the checker."""
    path = ROOT.joinpath(*module.removeprefix(PACKAGE).strip(".").split("."))
    return path / "__init__.py" if path.is_dir() else path.with_suffix(".py")


def lines(module: str) -> int:
    """How many lines the file of a module has, comments and all."""
    return len(source(module).read_bytes().splitlines())
