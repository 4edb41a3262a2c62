"""The statements of the proofs in proofs/, each part by itself, and the expressions inside them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields, is_dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Any

from lyapcheck.answers.check.run import paper_case
from lyapcheck.claims.case import Lacking
from lyapcheck.claims.script import load_proof
from lyapcheck.claims.statements import AllOf, Missing, Statement

PROOFS = Path(__file__).parents[2] / "proofs"
MEMBER = 2
"""The member of the family that claims about m are planted for: the first whose constants are not all 1."""

Tree = tuple[Any, ...]
Path_ = tuple[int, ...]
EXPRESSIONS = ("left", "right", "component", "formula", "constant")
CONTAINERS = ("relation", "conclusion", "hypotheses", "factors", "bound", "entries")


@dataclass(frozen=True)
class Part:
    """A statement of a proof that has no parts of its own."""

    proof: str
    claim: str
    name: str
    statement: Statement

    @property
    def where(self) -> str:
        """What a reader looks it up by."""
        return f"{self.proof} {self.claim}" + (f" ({self.name})" if self.name else "")


@lru_cache(maxsize=1)
def parts() -> tuple[Part, ...]:
    """Every statement of every proof for the paper's case, in the order of the scripts."""
    result: list[Part] = []
    for path in sorted(PROOFS.glob("*.py")):
        proof = load_proof(path)
        for claim in proof.claims.values():
            try:
                statement = claim.statement(paper_case(MEMBER))
            except Lacking:
                continue
            result += [Part(proof.name, claim.id, name, part) for name, part in _leaves("", statement)]
    return tuple(result)


def _leaves(name: str, statement: Statement) -> Iterator[tuple[str, Statement]]:
    if isinstance(statement, AllOf):
        for label, part in statement.parts:
            yield from _leaves(f"{name}, {label}" if name else label, part)
    elif not isinstance(statement, Missing):
        yield name, statement


def is_tree(value: object) -> bool:
    """Whether a value is an expression rather than a tuple of other things."""
    return isinstance(value, tuple) and bool(value) and isinstance(value[0], str)


def expressions(value: Any, name: str = "") -> Iterator[tuple[Tree, Callable[[Tree], Any]]]:
    """Every expression in a statement, with how to put another one in its place."""
    if is_tree(value):
        yield value, lambda tree: tree
    elif is_dataclass(value) and not isinstance(value, type):
        for field in fields(value):
            if field.name in EXPRESSIONS + CONTAINERS:
                for tree, put in expressions(getattr(value, field.name)):
                    yield tree, _in_field(value, field.name, put)
    elif isinstance(value, tuple):
        for index, item in enumerate(value):
            for tree, put in expressions(item):
                yield tree, _in_tuple(value, index, put)


def _in_field(owner: Any, name: str, put: Callable[[Tree], Any]) -> Callable[[Tree], Any]:
    return lambda tree: replace(owner, **{name: put(tree)})


def _in_tuple(owner: tuple[Any, ...], index: int, put: Callable[[Tree], Any]) -> Callable[[Tree], Any]:
    return lambda tree: (*owner[:index], put(tree), *owner[index + 1 :])


def places(tree: Tree, path: Path_ = ()) -> Iterator[tuple[Path_, Tree]]:
    """Every node of an expression and the way to it."""
    yield path, tree
    for index, child in enumerate(tree):
        if isinstance(child, tuple):
            yield from places(child, (*path, index))


def put_at(tree: Tree, path: Path_, new: Tree) -> Tree:
    """The expression with another node at a place."""
    if not path:
        return new
    index, *rest = path
    return (*tree[:index], put_at(tree[index], tuple(rest), new), *tree[index + 1 :])
