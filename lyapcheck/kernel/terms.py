"""Expressions, numbers, arms and loops as Coq writes them, in the words of ``formal/Definitions.v``.

A name of a variable becomes an identifier of its own, whatever it is, so that no certificate can bring words
of Coq's along; operations that Coq's reals do not have are not printed at all.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from fractions import Fraction
from typing import Any

from lyapcheck.check.expressions.expression import CONSTANTS, Tree
from lyapcheck.check.expressions.normal_form import is_zero
from lyapcheck.check.kinds.bound_every_n import BoundEveryN
from lyapcheck.check.kinds.decreasing import Decreasing
from lyapcheck.check.kinds.every_n import EveryN
from lyapcheck.check.kinds.stable_arm import StableArm
from lyapcheck.check.letters import letters
from lyapcheck.check.letters.words import Words
from lyapcheck.check.statement import Ends, Monomials, Relation, Variable
from lyapcheck.check.systems.argument import Argument
from lyapcheck.check.systems.system import DDQD, DG, DQD, GD, B, C, D, G, M, S, System, W, minus


class NotPrinted(Exception):
    """What has no form in Coq; the text says what it is."""


FUNCTIONS = {"neg": "-", "abs": "Rabs", "log": "ln"}
FUNCTIONS |= {name: name for name in ("sqrt", "exp", "sin", "cos", "tan", "asin", "acos", "atan")}
FUNCTIONS |= {name: name for name in ("sinh", "cosh", "tanh")}
FAMILY = {"h": "h", "dh": "dh", "potential": "U"} | {name: name for name in CONSTANTS}
INFIX = {"add": " + ", "mul": " * ", "div": " / "}


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
    return f"{expression(one.left)} {one.operator} {expression(one.right)}"


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
    given += [
        f"forall i j, (i < n)%nat -> (j < n)%nat -> {name} i j = {name} j i"
        for name in map(identifier, identity.symmetric)
    ]
    sides = f"{expression(statement.left)} = {expression(statement.right)}"
    if isinstance(statement, BoundEveryN):
        given += [f"0 <= {identifier(name)}" for name in sorted(statement.numbers)]
        given += [_norms(known, size) for known, size in statement.norms]
        given += [f"{expression(size)} <= {expression(number)}" for number, size in statement.least]
        sides = f"{expression(statement.left)} <= {expression(statement.right)}"
    body = " -> ".join([*(f"({one})" for one in given), f"({sides})"])
    return f"forall (n : nat) {' '.join(over)}, {body}"


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


# --- Which systems are loops that ``formal/Definitions.v`` knows: under (6) or (21) with h_m, and V of (13).
#
# Letters may have any names; torques and energies are compared as the checker compares numbers for every n.


X: Tree = ("var", "x")
EPS0: Tree = ("var", "eps0")
TEST: Tree = ("vec", "x")
GLOBAL = {False: ("strict", "LaSalle"), True: ("uniform",)}
"""Theorems that conclude global asymptotic stability: of a goal at rest, and uniform of one that moves."""


def member_of(argument: Argument) -> int:
    """The m for which a theorem says that (6) with h_m makes the goal of every arm with friction stable.

    With (21) instead of (6) if the goal moves.

    Raises:
        NotPrinted: it is about another loop, or says something else.
    """
    system = argument.system
    if argument.theorem not in GLOBAL[system.desired] or argument.local:
        raise NotPrinted(f"the conclusion of the theorem {argument.theorem}")
    if len(system.gains) != 2 or system.states or system.disturbed:
        raise NotPrinted("a loop that is not (11)")
    if system.friction != "positive":
        raise NotPrinted("arms without friction")
    if [(f.of, f.gain) for f in system.functions] != [("e", ""), ("w", "")] or system.increases:
        raise NotPrinted("a loop without a function of q̃ and one of q̇")
    if not _same(("dot", TEST, system.torque), ("dot", TEST, _torque(system))):
        raise NotPrinted("a torque that is neither (6) nor (21)")
    values = [f.member.value if f.member else () for f in system.functions]
    if any(len(value) != 3 or value[0] != "h" or value[2] != X for value in values):
        raise NotPrinted("a function that is not of the family h_m")
    if values[0] != values[1]:
        raise NotPrinted("two functions that differ")
    return int(values[0][1])


def member_of_energy(argument: Argument) -> int:
    """The same m, if V is that of (13).

    Raises:
        NotPrinted: it is another one.
    """
    m = member_of(argument)
    if argument.gravity or not _same(argument.energy, _energy(argument.system)):
        raise NotPrinted("V that is not (13)")
    return m


def on_one_arm(statement: StableArm) -> Decreasing:
    """That dV/dt < 0 for V of (13), the arm, the gains and ε₀.

    Raises:
        NotPrinted: V is another one, or ε₀ has no number.
    """
    numbers, m = dict(statement.numbers), member_of_energy(statement.argument)
    if "eps0" not in numbers:
        raise NotPrinted("V of (13) without a number for ε₀")
    (_, kp), (_, kv) = statement.gains
    ends: tuple[tuple[Fraction, Fraction], ...] = tuple((b, b) for b in statement.arm.viscous)
    return Decreasing(statement.arm.mass, ends, (), "hyperbolic", m, kp, kv, numbers["eps0"], ())


def _torque(system: System) -> Tree:
    """(6): K_p h − K_v k + g(q); (21): with M q̈_d + C(q, q̇) q̇_d + B q̇_d besides."""
    kp, kv = (("diag", name) for name in system.gains)
    h, k = (("vec", f.name) for f in system.functions)
    more: tuple[Tree, ...] = (GD, DG)
    if system.desired:
        more = (("apply", M, DDQD), ("apply", ("sum", C, D), DQD), ("apply", B, DQD), G)
    return ("sum", ("apply", kp, h), minus(("apply", kv, k)), *more)


def _energy(system: System) -> Tree:
    """(13): ½ yᵀMy + Σ k_pi U(e_i), y = w − ε₀ s h."""
    name = system.functions[0].name
    y: Tree = ("sum", W, ("scale", ("neg", ("mul", EPS0, S)), ("vec", name)))
    kinetic: Tree = ("div", ("dot", y, ("apply", M, y)), ("num", "2"))
    return ("add", kinetic, ("dot", ("vec", system.gains[0]), ("vec", f"U{name}")))


def _same(left: Tree, right: Tree) -> bool:
    """Whether two numbers are equal for every n."""
    return is_zero(Words(("M",), {}, {}).number(("add", left, ("neg", right))))
