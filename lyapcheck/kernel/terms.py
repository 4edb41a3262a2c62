"""Expressions, numbers and arms as Coq writes them, in the words of ``formal/Definitions.v``.

A name of a variable becomes an identifier of its own, whatever it is, so that no certificate can bring words
of Coq's along; operations that Coq's reals do not have are not printed at all.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from fractions import Fraction
from typing import Any

from lyapcheck.check.expressions.expression import CONSTANTS, Tree
from lyapcheck.check.kinds.bound_every_n import BoundEveryN
from lyapcheck.check.kinds.every_n import EveryN
from lyapcheck.check.letters.grammar import letters
from lyapcheck.check.statement import Ends, Monomials, Relation, Variable


class NotPrinted(Exception):
    """What has no form in Coq; the text says what it is."""


FUNCTIONS = {"neg": "-", "abs": "Rabs", "log": "ln"}
FUNCTIONS |= {name: name for name in ("sqrt", "exp", "sin", "cos", "tan", "asin", "acos", "atan")}
FUNCTIONS |= {name: name for name in ("sinh", "cosh", "tanh")}
FAMILY = {"h": "h", "dh": "dh", "potential": "U"} | {name: name for name in CONSTANTS}
INFIX = {"add": " + ", "mul": " * ", "div": " / "}
SIGNS = {"<=": "<=", "<": "<"}


def identifier(name: str) -> str:
    """A variable; letters beyond ASCII are written by their numbers."""
    return "v_" + "".join(c if c.isascii() and c.isalnum() else f"_{ord(c):x}_" for c in name)


def rational(value: Fraction) -> str:
    """A real number."""
    over = "" if value.denominator == 1 else f" / {value.denominator}"
    return f"({value.numerator}{over})" if value < 0 or over else str(value.numerator)


LEAVES: dict[str, Callable[[list[Any]], str]] = {
    "num": lambda parts: rational(Fraction(parts[0])),
    "var": lambda parts: identifier(parts[0]),
    "pi": lambda parts: "PI",
}


def expression(tree: Tree) -> str:
    """A term of type R.

    Raises:
        NotPrinted: an operation has no form in Coq.
    """
    kind, *parts = tree
    if kind in LEAVES:
        return LEAVES[kind](parts)
    if kind == "pow":
        return f"({expression(parts[0])} ^ {int(parts[1])})"
    if kind in INFIX:
        return f"({INFIX[kind].join(map(expression, parts))})"
    if kind in FUNCTIONS:
        return f"({FUNCTIONS[kind]} {expression(parts[0])})"
    if kind in FAMILY:
        return f"({' '.join([FAMILY[kind], str(int(parts[0])), *map(expression, parts[1:])])})"
    if kind == "dot":
        return f"(dot n {vector(parts[0])} {vector(parts[1])})"
    raise NotPrinted(f"the operation {kind}")


def vector(tree: Tree) -> str:
    """A term of type vec: a letter, or the function of its entries."""
    if tree[0] == "vec":
        return identifier(tree[1])
    value = entry(tree, "i")
    return value.removesuffix(" i") if value.startswith("(apply_ ") else f"(fun i => {value})"


def matrix(tree: Tree) -> str:
    """A term of type mat: a letter, or the function of its entries."""
    return identifier(tree[1]) if tree[0] == "mat" else f"(fun i j => {entry(tree, 'i j')})"


def entry(tree: Tree, place: str) -> str:
    """The entry of a vector or matrix at a place; that of a diagonal matrix times a vector is a product.

    Raises:
        NotPrinted: a diagonal matrix is not applied to a vector.
    """
    kind, *parts = tree
    if kind in ("vec", "mat"):
        return f"{identifier(parts[0])} {place}"
    if kind == "sum":
        return f"({' + '.join(entry(part, place) for part in parts)})" if parts else "0"
    if kind == "scale":
        return f"({expression(parts[0])} * {entry(parts[1], place)})"
    if kind == "transpose":
        return entry(parts[0], " ".join(reversed(place.split())))
    if kind != "apply":
        raise NotPrinted(f"the matrix {kind} that is not applied")
    if parts[0][0] == "diag":
        return f"({identifier(parts[0][1])} {place} * {entry(parts[1], place)})"
    return f"(apply_ n {matrix(parts[0])} {vector(parts[1])}) {place}"


def relation(one: Relation) -> str:
    """A proposition."""
    return f"{expression(one.left)} {SIGNS[one.operator]} {expression(one.right)}"


def bound(variable: Variable) -> list[str]:
    """That a variable is in its range: nothing or one proposition."""
    if variable.low is None:
        return []
    return [f"{rational(variable.low)} {'<' if variable.strict else '<='} {identifier(variable.name)}"]


def quantified(names: Iterable[str], given: Iterable[str], conclusion: str) -> str:
    """``forall …, … -> conclusion``."""
    variables = " ".join(map(identifier, names))
    body = " -> ".join([*(f"({one})" for one in given), f"({conclusion})"])
    return f"forall {variables} : R, {body}" if variables else body


def exact(value: Fraction) -> str:
    """A number of type Q."""
    numerator = f"({value.numerator})" if value < 0 else str(value.numerator)
    return f"({numerator} # {value.denominator})%Q"


def exact_list(values: Iterable[Fraction]) -> str:
    """A list of numbers of type Q."""
    return f"[{'; '.join(map(exact, values))}]%Q"


def arm(mass: Sequence[Sequence[Monomials]], viscous: Sequence[Fraction]) -> str:
    """An arm without parameters: the monomials of each entry of M(q), as they stand in a certificate, and B.

    Raises:
        NotPrinted: its entries have parameters.
    """
    if any(len(powers) != 2 * len(mass) for row in mass for entry in row for powers, _ in entry):
        raise NotPrinted("an arm with uncertain parameters")
    return _arm(mass, viscous)


def any_arm(mass: Sequence[Sequence[Monomials]], parameters: Iterable[Ends]) -> str:
    """An arm of which M(q) alone is said something, and the ranges of its parameters."""
    return f"{_arm(mass, ())} {ranges_of(parameters)}"


def _arm(mass: Sequence[Sequence[Monomials]], viscous: Sequence[Fraction]) -> str:
    rows = [f"[{'; '.join(map(monomials, row))}]" for row in mass]
    return f"(Arm {len(mass)} [{'; '.join(rows)}] {exact_list(viscous)})"


def monomials(terms: Monomials) -> str:
    """A polynomial as its list of monomials."""
    shown = (f"([{'; '.join(map(str, powers))}]%nat, {exact(value)})" for powers, value in terms)
    return f"[{'; '.join(shown)}]"


# --- Statements for every n as propositions of Coq: vectors are functions, matrices functions of two indices.
#
# That the spectral norm of A is at most c is printed as ‖Ax‖ <= c‖x‖ for every x.


NAMELESS = re.compile(rf"\b{identifier('')}\b")
SORTS = {"var": "R", "vec": "vec", "mat": "mat"}


def ranges_of(parameters: Iterable[Ends]) -> str:
    """Ranges of parameters, or of friction, as a list."""
    return f"[{'; '.join(f'({exact(low)}, {exact(high)})' for low, high in parameters)}]"


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
