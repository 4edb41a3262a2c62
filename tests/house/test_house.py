"""The architecture: what may import what, and that every module can be the first that is imported."""

import ast
import re
from functools import cache
from graphlib import TopologicalSorter
from pathlib import Path

TOP = Path(__file__).parents[2] / "lyapcheck"


@cache
def modules():
    """The modules of the package by name."""
    result = {}
    for path in TOP.rglob("*.py"):
        parts = path.relative_to(TOP.parent).with_suffix("").parts
        result[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return result


@cache
def imported(module, types=False):
    """The modules of the package that one imports as it is loaded; those for types alone if asked."""
    return tuple(_imported(ast.parse(modules()[module].read_text(encoding="utf-8")), types))


def _imported(tree, types):
    waiting = [tree]
    while waiting:
        node = waiting.pop()
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda)):
            continue
        if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING":
            waiting += [*node.orelse, *(node.body if types else [])]
            continue
        if isinstance(node, ast.ImportFrom) and node.module:
            for alias in node.names:
                inner = f"{node.module}.{alias.name}"
                yield inner if inner in modules() else node.module
        elif isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        waiting += ast.iter_child_nodes(node)


def test_no_modules_import_each_other_in_a_circle():
    """So each can be imported first. A package's ``__init__`` is loaded before what is inside it."""
    graph = {}
    for module in modules():
        needed = {name for name in imported(module) if name in modules()}
        for name in tuple(needed):
            parents = [name.rsplit(".", k)[0] for k in range(1, name.count(".") + 1)]
            needed |= {parent for parent in parents if not f"{module}.".startswith(f"{parent}.")}
        graph[module] = needed - {module}
    TopologicalSorter(graph).prepare()


def test_no_two_modules_need_each_others_types():
    """What prints a result takes a type from below it, not the answer that calls it."""
    known = set(modules()) - {TOP.name}  # the public interface names all that it offers
    graph = {module: set(imported(module, types=True)) & known - {module} for module in known}
    TopologicalSorter(graph).prepare()


def test_every_work_that_is_referred_to_stands_in_the_bibliography():
    works = (TOP.parent / "proofs" / "references.bib").read_text(encoding="utf-8")
    known = set(re.findall(r"^@\w+\{(\w+),", works, re.MULTILINE))
    named = {
        key
        for path in modules().values()
        for key in re.findall(r"``([a-z]+\d{4}[a-z]*)``", path.read_text(encoding="utf-8"))
    }
    assert named
    assert named <= known
