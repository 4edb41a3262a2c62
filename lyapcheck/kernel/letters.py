"""Statements for every n as propositions of Coq: vectors are functions, matrices functions of two indices.

That the spectral norm of A is at most c is printed as ‖Ax‖ <= c‖x‖ for every x.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from lyapcheck.check.expressions.expression import Tree
from lyapcheck.check.kinds.bound_every_n import BoundEveryN
from lyapcheck.check.kinds.every_n import EveryN
from lyapcheck.check.letters.grammar import letters
from lyapcheck.kernel.terms import NotPrinted, expression, identifier, vector

NAMELESS = re.compile(rf"\b{identifier('')}\b")
SORTS = {"var": "R", "vec": "vec", "mat": "mat"}


def letters_of(statement: EveryN | BoundEveryN) -> dict[str, list[str]]:
    """The names of its numbers, vectors and matrices, in order.

    Raises:
        NotPrinted: they are functions of time, or one is given by an equation.
    """
    identity = statement.identity if isinstance(statement, BoundEveryN) else statement
    if identity.given or {"rate"} & set(_operations((statement.left, statement.right))):
        raise NotPrinted("a derivative by time for every n")
    trees: Iterable[Tree] = (statement.left, statement.right)
    if isinstance(statement, BoundEveryN):
        trees = statement.terms_with_values()
    used = {letter for tree in trees for letter in letters(tree)}
    used |= {("mat", name) for name in identity.symmetric}
    return {kind: sorted(name for sort, name in used if sort == kind) for kind in SORTS}


def _operations(trees: Iterable[Tree]) -> Iterator[str]:
    for tree in trees:
        yield tree[0]
        yield from _operations(part for part in tree[1:] if isinstance(part, tuple))


def every_n(statement: EveryN | BoundEveryN) -> str:
    """The proposition.

    Raises:
        NotPrinted: naming what has no form in Coq.
    """
    identity = statement.identity if isinstance(statement, BoundEveryN) else statement
    names = letters_of(statement)
    over = [
        f"({' '.join(map(identifier, names[kind]))} : {sort})" for kind, sort in SORTS.items() if names[kind]
    ]
    given = [f"0 < {identifier(name)}" for name in identity.positive]
    given += [_symmetric(identifier(name)) for name in identity.symmetric]
    sides = f"{expression(statement.left)} = {expression(statement.right)}"
    if isinstance(statement, BoundEveryN):
        given += [f"0 <= {identifier(name)}" for name in sorted(statement.numbers)]
        given += [_norms(known, size) for known, size in statement.norms]
        given += [f"{expression(size)} <= {expression(number)}" for number, size in statement.least]
        sides = f"{expression(statement.left)} <= {expression(statement.right)}"
    body = " -> ".join([*(f"({one})" for one in given), f"({sides})"])
    return f"forall (n : nat) {' '.join(over)}, {body}"


def _symmetric(name: str) -> str:
    return f"forall i j, (i < n)%nat -> (j < n)%nat -> {name} i j = {name} j i"


def _norms(known: tuple[Tree, ...], size: Tree) -> str:
    """That a product of norms is at most an expression."""
    if known[0][0] in ("mat", "diag"):
        if len(known) > 1:
            raise NotPrinted("a product of norms with that of a matrix")
        # no letter has an empty name: its identifier is none of theirs
        applied = NAMELESS.sub("x", vector(("apply", known[0], ("vec", ""))))
        return f"forall x : vec, norm n {applied} <= {expression(size)} * norm n x"
    return f"{' * '.join(map(norm, known))} <= {expression(size)}"


def norm(letter: Tree) -> str:
    """The norm of a vector, the size of a number."""
    if letter[0] == "var":
        return f"Rabs {identifier(letter[1])}"
    if letter[0] == "vec":
        return f"norm n {identifier(letter[1])}"
    raise NotPrinted("a product of norms with that of a matrix")
