"""The code that a verdict rests on: the definitions that can be reached from those that read and judge it.

A definition is a function, a method, a class without its methods, or a constant of a module. From one that is
reached the sources lead to others, always to too many rather than too few:

- a name leads to what the module defines or imports under it, annotations of functions aside;
- a method of a class that is reached counts where its name stands behind a dot anywhere in code that is
  reached, whatever stands before the dot, or in a text; so do those whose names Python itself calls;
- a rule counts where both its kind of statement and its kind of proof do, or what they derive from;
- what runs when a module is imported, and is no definition, counts with the first definition of that module.

Kinds of statement and proof are reached by the certificate at hand, which is all that makes objects of them.
"""

from __future__ import annotations

import ast
import io
import tokenize
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

from lyapcheck import check

PACKAGE = "lyapcheck.check"
ROOT = Path(check.__file__).parent
CORE = (f"{PACKAGE}.recheck:recheck", f"{PACKAGE}.worker:serve")
"""What every verdict goes through."""
BY_NAME = (f"{PACKAGE}.judging", f"{PACKAGE}.numbers.functions")
"""Modules that are imported by name as the checker runs: their functions are reached behind a dot."""
Function = ast.FunctionDef | ast.AsyncFunctionDef


@dataclass
class Definition:
    """A definition: where it stands and what it leads to.

    ``code`` are the parts of its source that count, ``lines`` those that it takes; a class has ``methods``.
    """

    module: str
    name: str
    code: list[ast.AST]
    lines: set[int]
    methods: dict[str, str] = field(default_factory=dict)
    names: set[str] = field(default_factory=set)
    behind_dots: set[str] = field(default_factory=set)
    judges: tuple[str, ...] = ()

    @property
    def place(self) -> str:
        """``module:name``."""
        return f"{self.module}:{self.name}"


@dataclass(frozen=True)
class Size:
    """Lines of code, and with documentation, comments and blanks inside definitions."""

    code: int
    lines: int


def modules(rules: Iterable[tuple[str, str]]) -> dict[str, Size]:
    """The modules that some rules, pairs (name, places of its classes), rest on, and how much of each.

    Lines of imports count where a definition that is reached uses what they import.
    """
    result = reached(place for _, places in rules for place in places.split())
    return {name: _size(name, result) for name in sorted({place.split(":")[0] for place in result})}


def totals(result: dict[str, Size]) -> tuple[int, int]:
    """Lines of code, and all lines."""
    return sum(size.code for size in result.values()), sum(size.lines for size in result.values())


def reached(places: Iterable[str] = ()) -> frozenset[str]:
    """The definitions, as ``module:name``, that the core and some places lead to."""
    return _reached(frozenset(places))


@cache
def _reached(places: frozenset[str]) -> frozenset[str]:
    known, result, dots = definitions(), set[str](), set[str]()
    waiting = {*CORE, *places}
    while waiting:
        result |= waiting
        new = [known[place] for place in waiting]
        dots |= {name for one in new for name in one.behind_dots}
        named = {name for one in new for name in (*one.names, *_at_import(one.module))}
        waiting = {*named, *_beside(known, result, dots)} & set(known) - result
    return frozenset(result)


def _beside(known: dict[str, Definition], result: set[str], dots: set[str]) -> Iterator[str]:
    """What is reached without its own name: methods, functions of modules imported by name, and rules."""
    for place, one in known.items():
        if place in result:
            yield from (own for name, own in one.methods.items() if name in dots or name.startswith("__"))
        elif one.judges:
            yield from [place] * (result >= set(one.judges))
        elif one.name in dots and f"{one.module}.".startswith(tuple(f"{name}." for name in BY_NAME)):
            yield place


@cache
def definitions() -> dict[str, Definition]:
    """All definitions of the checker by place."""
    result: dict[str, Definition] = {}
    for file in ROOT.rglob("*.py"):
        inner = file.relative_to(ROOT).with_suffix("").parts
        module = ".".join((PACKAGE, *(inner[:-1] if inner[-1] == "__init__" else inner)))
        result |= {one.place: one for one in _defined(module)}
    for one in result.values():
        for node in (node for part in one.code for node in _running(part)):
            _lead(one, node)
    return result


def _defined(module: str) -> Iterator[Definition]:
    for node in tree(module).body:
        span = _span(node)
        if isinstance(node, ast.ClassDef):
            methods = [part for part in node.body if isinstance(part, Function)]
            for part in methods:
                yield Definition(module, f"{node.name}.{part.name}", [part], _span(part))
                span -= _span(part)
            rest = [part for part in node.body if not isinstance(part, Function)]
            named = {part.name: f"{module}:{node.name}.{part.name}" for part in methods}
            yield Definition(module, node.name, [*node.bases, *node.decorator_list, *rest], span, named)
        elif isinstance(node, Function):
            yield Definition(module, node.name, [node], span, judges=_judges(module, node))
        elif isinstance(node, (ast.Assign, ast.AnnAssign)):
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            names = (part for target in targets for part in ast.walk(target) if isinstance(part, ast.Name))
            yield from (Definition(module, name.id, [node], span) for name in names)
        elif not isinstance(node, (ast.Import, ast.ImportFrom)) and not _is_text(node):
            yield Definition(module, f"line {node.lineno}", [node], span)


def _judges(module: str, node: Function) -> tuple[str, ...]:
    """The kinds of statement and proof of a rule."""
    calls = [one for one in node.decorator_list if isinstance(one, ast.Call)]
    named = [call for call in calls if isinstance(call.func, ast.Name) and call.func.id == "rule"]
    return tuple(
        place for call in named for part in call.args for place in _places(module, ast.unparse(part))
    )


def _lead(one: Definition, node: ast.AST) -> None:
    """Note what a node of the source of a definition leads to."""
    if isinstance(node, ast.Name):
        one.names |= _places(one.module, node.id)
    elif isinstance(node, ast.Attribute):
        one.behind_dots.add(node.attr)
        if isinstance(node.value, ast.Name):
            one.names |= _places(one.module, f"{node.value.id}.{node.attr}")
    elif isinstance(node, ast.Constant) and isinstance(node.value, str) and node.value.isidentifier():
        one.behind_dots.add(node.value)


def _places(module: str, name: str) -> set[str]:
    """What a name means in a module, or a name in a module that it imports."""
    first, _, inner = name.partition(".")
    meant = _imports(module).get(first, f"{module}:{first}")
    if inner:
        module, meant = meant.replace(":", "."), f"{meant.replace(':', '.')}:{inner}"
    where, _, name = meant.partition(":")
    again = where != module and source(where).exists() and name in _imports(where)
    return _places(where, name) if again else {meant}


@cache
def _imports(module: str) -> dict[str, str]:
    """The place of each name that a module imports from the checker, wherever in its source."""
    result: dict[str, str] = {}
    for node in ast.walk(tree(module)):
        if isinstance(node, ast.ImportFrom) and f"{node.module}.".startswith(f"{PACKAGE}."):
            result |= {part.asname or part.name: f"{node.module}:{part.name}" for part in node.names}
    return result


@cache
def _at_import(module: str) -> tuple[str, ...]:
    return tuple(one.place for one in _defined(module) if one.name.startswith("line "))


def _running(node: ast.AST) -> Iterator[ast.AST]:
    """The nodes of a source that may run: annotations of functions and their variables do not."""
    inside_function = isinstance(node, Function)
    waiting = [node]
    while waiting:
        part = waiting.pop()
        yield part
        for name, value in ast.iter_fields(part):
            idle = name == "returns" or (
                name == "annotation" and (inside_function or isinstance(part, ast.arg))
            )
            if not idle:
                parts = value if isinstance(value, list) else [value]
                waiting += (inner for inner in parts if isinstance(inner, ast.AST))


def _size(module: str, result: frozenset[str]) -> Size:
    known = [one for one in definitions().values() if one.module == module and one.place in result]
    lines = set[int]().union(*(one.lines for one in known))
    used = {
        part.id for one in known for top in one.code for part in ast.walk(top) if isinstance(part, ast.Name)
    }
    for node in tree(module).body:
        if isinstance(node, (ast.Import, ast.ImportFrom)):
            names = {(part.asname or part.name).split(".")[0] for part in node.names}
            lines |= _span(node) if names & used else set()
    return Size(len(lines & code_lines(module)), len(lines))


@cache
def code_lines(module: str) -> frozenset[int]:
    """The lines of a module with code on them: no documentation, comments or blanks."""
    skipped = (tokenize.COMMENT, tokenize.NL, tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT)
    text, result = io.StringIO(source(module).read_text("utf-8")), set[int]()
    for token in tokenize.generate_tokens(text.readline):
        if token.type not in (*skipped, tokenize.ENDMARKER):
            result.update(range(token.start[0], token.end[0] + 1))
    return frozenset(result).difference(*(_span(node) for node in ast.walk(tree(module)) if _is_text(node)))


def _is_text(node: ast.AST) -> bool:
    return isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)


def _span(node: ast.AST) -> set[int]:
    """The lines that a node of a source takes, its decorators among them."""
    parts = [node, *getattr(node, "decorator_list", [])]
    return set(range(min(part.lineno for part in parts), node.end_lineno + 1))  # type: ignore[attr-defined]


@cache
def tree(module: str) -> ast.Module:
    """The source of a module, parsed."""
    return ast.parse(source(module).read_bytes())


def source(module: str) -> Path:
    """The file of a module of the checker."""
    path = ROOT.joinpath(*module.removeprefix(PACKAGE).strip(".").split("."))
    return path / "__init__.py" if path.is_dir() else path.with_suffix(".py")
