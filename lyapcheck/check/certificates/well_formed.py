"""Whether a statement says something at all: one function a kind."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from fractions import Fraction
from itertools import chain
from typing import Any

from lyapcheck.check.certificates import statements as kinds
from lyapcheck.check.certificates.every_n import BoundEveryN, EveryN
from lyapcheck.check.certificates.refusal import Refused, require
from lyapcheck.check.certificates.theorems import Theorem
from lyapcheck.check.certificates.trees import require_expressions
from lyapcheck.check.functions import variables
from lyapcheck.check.letters.grammar import LETTERS, letters, require_sort

MAX_JOINTS = 100
MAX_INPUTS = 16
MAX_ARM = 9
MAX_POWER = 40
MAX_LENGTH = 400
CONSTANTS = ("eps", "kp", "b_min", "b_max", "kv_max", "beta", "kc", "vd", "eps0")
"""The names in the form of a loop."""
DECIMAL = re.compile(r"[+-]?([0-9]+(\.[0-9]*)?|\.[0-9]+)([eE][+-]?[0-9]{1,3})?")


def require_well_formed(statement: kinds.Statement) -> None:
    """Refuse a statement that the rules should not have to look at.

    Raises:
        Refused: an unknown operation, an undeclared variable, an empty interval, a size out of reach.
    """
    form = FORMS.get(type(statement))
    if form is None:
        raise Refused("kind", type(statement).__name__, "is not a kind of statement that the checker knows")
    form(statement)


def _identity(statement: kinds.Identity) -> None:
    require_expressions((statement.left, statement.right))


def _for_all(statement: kinds.ForAll) -> None:
    _relations([statement.relation], [statement.variable])
    low, high = statement.low, statement.high
    if low is not None and high is not None:
        require(low <= high, "interval", f"[{low}, {high}]", "is empty")


def _constant(statement: kinds.Constant) -> None:
    _relations([statement.relation], [])


def _norm_bound(statement: kinds.NormBound) -> None:
    require(1 <= statement.n <= MAX_JOINTS, "n", statement.n, f"must be from 1 to {MAX_JOINTS}")
    require(statement.power in (0, 1), "power", statement.power, "must be 0 or 1")
    require_expressions([statement.component], ["x"])
    require_expressions([statement.bound], [])


def _implies(statement: kinds.Implies) -> None:
    _relations((*statement.hypotheses, statement.conclusion), [v.name for v in statement.variables])


def _for_small(statement: kinds.ForSmall) -> None:
    names = [*(v.name for v in statement.variables), statement.small, *statement.bounded]
    _relations((*statement.hypotheses, statement.conclusion), names)


def _agrees(statement: kinds.Agrees) -> None:
    names = [name for name, _ in statement.inputs]
    _distinct("inputs", names)
    require(len(names) <= MAX_INPUTS, "inputs", len(names), f"must be at most {MAX_INPUTS}")
    require_expressions([statement.formula], names)
    for text in (*(text for _, text in statement.inputs), statement.printed):
        plain = len(text) <= MAX_LENGTH and DECIMAL.fullmatch(text) is not None
        require(plain, "printed number", text, "is not a decimal")


def _norm_chain(statement: kinds.NormChain) -> None:
    for majorant in (statement.bound, *chain.from_iterable(statement.factors)):
        require_expressions([majorant.constant], [])
        _distinct("powers", [name for name, _ in majorant.powers])
        for name, power in majorant.powers:
            require(power >= 0, f"power of {name}", power, "a majorant has no negative power")


def _bounds(statement: kinds.TrigonometricBound) -> None:
    require_expressions(tree for tree, _ in statement.entries)


def _positive(statement: kinds.TrigonometricPositive) -> None:
    require_expressions(statement.entries)


def _decreasing(statement: kinds.Decreasing) -> None:
    n = len(statement.viscous)
    require(1 <= n <= MAX_ARM, "joints", n, f"must be from 1 to {MAX_ARM}")
    for subject in ("mass", "kp", "kv"):
        size = len(getattr(statement, subject))
        require(size == n, subject, size, f"must be {n}, one a joint")
    coupling = len(statement.coupling)
    require(coupling in (0, n), "coupling", coupling, f"must be empty or {n}, one a joint")
    require(all(len(row) == n for row in statement.mass), "mass", "a row", f"must have {n} entries")
    length = 2 * n + len(statement.parameters)
    for powers, _ in chain.from_iterable(chain.from_iterable(statement.mass)):
        fits = len(powers) == length and all(0 <= p <= MAX_POWER for p in powers)
        require(fits, "exponents", powers, f"must be {length} numbers from 0 to {MAX_POWER}")
    for low, high in (*statement.viscous, *statement.parameters):
        require(low <= high, "range", f"[{low}, {high}]", "is empty")
    require(len(statement.parameters) <= MAX_INPUTS, "parameters", len(statement.parameters), "are too many")


def _damping(statement: kinds.DampingBelow) -> None:
    """The fields that it shares with ``Decreasing``, at any ε₀."""
    _decreasing(statement.with_damping(Fraction(1), Fraction(1)))
    require(all(k > 0 for k in statement.kv), "kv", statement.kv, "must be positive")
    require_expressions([statement.bound], [])


def _theorem(statement: Theorem) -> None:
    loop = statement.loop
    _distinct("hypotheses", [name for name, _ in statement.hypotheses])
    _distinct("numbers", [name for name, _ in loop.numbers])
    require(1 <= loop.n <= MAX_JOINTS, "n", loop.n, f"must be from 1 to {MAX_JOINTS}")
    require_expressions((loop.h, loop.slope, loop.potential), ["x"])
    require_expressions(loop.form, CONSTANTS)
    _relations(loop.condition, list(CONSTANTS[1:]))


def _every_n(statement: EveryN) -> None:
    """One name for one letter; what is given is solved for vectors that it does not contain itself."""
    require_sort(statement.left, "number", rate=True)
    require_sort(statement.right, "number", rate=True)
    used = letters(statement.left) | letters(statement.right)
    sorts = {letter: sort for sort, letter in LETTERS.items()}
    for letter, value in statement.rates:
        require(len(letter) == 2 and letter[0] in sorts, "rates", letter, "has no derivative of its own")
        for tree in (letter, value):
            require_sort(tree, sorts[letter[0]])
            used |= letters(tree)
    for known in statement.given:
        require_sort(("mat", known.matrix), "matrix")
        require_sort(known.equals, "vector")
        used |= letters(known.equals) | {("mat", known.matrix), ("vec", known.vector)}
        solved = {("vec", other.vector) for other in statement.given}
        require(not solved & letters(known.equals), "given", known.vector, "occurs on a right side")
    _distinct("letters", sorted(name for _, name in used))
    _distinct("rates", [letter[1] for letter, _ in statement.rates])
    _distinct("given", [f"{known.matrix} {known.vector}" for known in statement.given])
    _distinct("symmetric", list(statement.symmetric))
    for name in statement.symmetric:
        require(("mat", name) in used, "symmetric", name, "is not a matrix of the statement")


def _bound_every_n(statement: BoundEveryN) -> None:
    _every_n(statement.terms)
    used = letters(statement.left)
    for known, size in statement.norms:
        for letter in known:
            sort = next((sort for sort, kind in LETTERS.items() if letter[:1] == (kind,)), "matrix")
            require_sort(letter, sort)
            require(letters(letter) == {letter} or letter[0] == "diag", "norms", letter, "is not a letter")
            used |= letters(letter)
        require_expressions([size])
    for number, size in statement.least:
        require_sort(number, "number")
        require_expressions([size])
        used |= letters(number)
    sizes = (statement.right, *(size for _, size in (*statement.norms, *statement.least)))
    require_expressions(sizes)
    used |= {("var", name) for size in sizes for name in variables(size)}
    _distinct("letters", sorted(name for _, name in used))


def _all_of(statement: kinds.AllOf) -> None:
    require(len(statement.parts) > 0, "parts", "none", "a conjunction needs at least one part")


FORMS: dict[type, Callable[[Any], None]] = {
    kinds.Identity: _identity,
    kinds.ForAll: _for_all,
    kinds.Constant: _constant,
    kinds.NormBound: _norm_bound,
    kinds.Implies: _implies,
    kinds.ForSmall: _for_small,
    kinds.Agrees: _agrees,
    kinds.NormChain: _norm_chain,
    kinds.TrigonometricBound: _bounds,
    kinds.TrigonometricPositive: _positive,
    kinds.Decreasing: _decreasing,
    kinds.DampingBelow: _damping,
    Theorem: _theorem,
    kinds.AllOf: _all_of,
    EveryN: _every_n,
    BoundEveryN: _bound_every_n,
}
"""The kinds of statement, each with what makes one well formed."""


def _relations(relations: Iterable[kinds.Relation], names: list[str]) -> None:
    _distinct("variables", names)
    for relation in relations:
        require_expressions((relation.left, relation.right), names)


def _distinct(subject: str, names: list[str]) -> None:
    require(len(set(names)) == len(names), subject, ", ".join(names), "one is given twice")
