"""The kinds of fault, each as a rule that rewrites one place of a statement."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from decimal import ROUND_CEILING, ROUND_FLOOR, Context, Decimal
from fractions import Fraction
from itertools import islice
from typing import Any

from mpmath import mp

from lyapcheck.check.expressions.expression import variables
from lyapcheck.check.kinds.bound_every_n import BoundEveryN
from lyapcheck.claims import (
    Agrees,
    Constant,
    ForAll,
    ForSmall,
    Identity,
    Implies,
    NormBound,
    Relation,
    Statement,
    TrigonometricBound,
)
from tests.oracle.numbers import supremum
from tests.oracle.trees import names as names_in
from tests.refutations.statements import Part, Tree, expressions, places, put_at

PER_KIND = 4
"""How many faults of one kind are planted in one statement: the first, the last and some between."""

NodeRule = Callable[[Tree], Iterable[Tree]]
StatementRule = Callable[[Any], Iterable[Statement]]


@dataclass(frozen=True)
class Fault:
    """A statement that differs from one of a proof in one place."""

    part: Part
    kind: str
    number: int
    statement: Statement

    @property
    def name(self) -> str:
        """What a reader looks it up by."""
        return f"{self.part.where}: {self.kind} {self.number}"


def faults_of(part: Part) -> list[Fault]:
    """The faults planted in one statement."""
    result: list[Fault] = []
    for kind, rule in RULES.items():
        mutants = [mutant for mutant in rule(part.statement) if _is_sound_data(mutant, part.statement)]
        result += [Fault(part, kind, k + 1, mutant) for k, mutant in enumerate(_spread(mutants))]
    return result


def _is_sound_data(mutant: Statement, original: Statement) -> bool:
    """Whether a mutant differs from the original, and only in the names that the original has."""
    return mutant != original and _names(mutant) <= _names(original)


def _names(statement: Statement) -> frozenset[str]:
    declared = {v.name for v in getattr(statement, "variables", ())}
    return frozenset(declared).union(*(names_in(tree) for tree, _ in expressions(statement)))


def _spread(items: list[Statement]) -> list[Statement]:
    if len(items) <= PER_KIND:
        return items
    return [items[k * (len(items) - 1) // (PER_KIND - 1)] for k in range(PER_KIND)]


def _everywhere(rule: NodeRule, most: int = 400) -> StatementRule:
    """A rule on nodes applied at every node of every expression of a statement, one at a time."""

    def rewrite(statement: Statement) -> Iterator[Statement]:
        for tree, put in expressions(statement):
            for path, node in places(tree):
                for new in rule(node):
                    yield put(put_at(tree, path, new))

    return lambda statement: list(islice(rewrite(statement), most))


# On nodes of expressions ----------------------------------------------------------------------------------


def _flipped(node: Tree) -> Iterator[Tree]:
    if node[0] == "neg":
        yield node[1]
    elif node[0] == "add":
        for k, term in enumerate(node[1:], 1):
            if term[0] != "neg":
                yield (*node[:k], ("neg", term), *node[k + 1 :])


def _dropped(node: Tree) -> Iterator[Tree]:
    if node[0] in ("add", "mul") and len(node) > 2:
        for k in range(1, len(node)):
            rest = (*node[:k], *node[k + 1 :])
            yield rest if len(rest) > 2 else rest[1]


def _doubled(node: Tree) -> Iterator[Tree]:
    if node[0] == "add":
        for k, term in enumerate(node[1:], 1):
            yield (*node[:k], ("mul", ("num", "2"), term), *node[k + 1 :])


SWAPPED = {"gamma": "rho", "rho": "gamma", "L": "gamma"}


def _other_constant(node: Tree) -> Iterator[Tree]:
    if node[0] in SWAPPED:
        yield (SWAPPED[node[0]], node[1])
    elif node[0] == "var" and node[1] in SWAPPED:
        yield ("var", SWAPPED[node[1]])


def _no_root(node: Tree) -> Iterator[Tree]:
    if node[0] == "sqrt" and node[1][0] == "num":
        yield ("num", "1")
    elif node[0] == "mul" and node[1] == ("num", "3"):
        yield ("mul", ("sqrt", node[1]), *node[2:])


def _other_power(node: Tree) -> Iterator[Tree]:
    if node[0] == "pow":
        yield from (("pow", node[1], k) for k in (node[2] - 1, node[2] + 1) if k > 0)
    elif node[0] in ("h", "dh", "potential"):
        yield from ((node[0], m, node[2]) for m in (node[1] + 1, node[1] - 1) if m > 0)


def _decimal(kind: str, m: int) -> str:
    with mp.workdps(60):
        return "1" if m == 1 else str(supremum(kind, m, 60))


def _rounded(value: Fraction) -> list[str]:
    """The two neighbours with one significant digit less, at most three digits."""
    exact = Decimal(value.numerator) / Decimal(value.denominator)
    digits = min(3, max(1, len(exact.normalize().as_tuple().digits) - 1))
    both = (Context(digits, rounding).plus(exact) for rounding in (ROUND_FLOOR, ROUND_CEILING))
    return [str(Fraction(number)) for number in both]


def _badly_rounded(node: Tree) -> Iterator[Tree]:
    if node[0] == "num" and len(str(Fraction(node[1]))) > 2:
        yield from (("num", text) for text in _rounded(Fraction(node[1])))
    elif node[0] in SWAPPED:
        yield from (("num", text) for text in _rounded(Fraction(_decimal(*node))))


# On relations and on whole statements ---------------------------------------------------------------------


def _relations(statement: Any) -> Iterator[tuple[Relation, bool, Callable[[Relation], Statement]]]:
    """Every relation, whether it is a hypothesis, and how to put another in its place."""
    if isinstance(statement, (ForAll, Constant)):
        yield statement.relation, False, lambda r: replace(statement, relation=r)
    elif isinstance(statement, (Implies, ForSmall)):
        yield statement.conclusion, False, lambda r: replace(statement, conclusion=r)
        for k, hypothesis in enumerate(statement.hypotheses):
            yield hypothesis, True, _hypothesis(statement, k)


def _hypothesis(statement: Any, k: int) -> Callable[[Relation], Statement]:
    given = statement.hypotheses
    return lambda r: replace(statement, hypotheses=(*given[:k], r, *given[k + 1 :]))


def _reversed(statement: Statement) -> list[Statement]:
    return [put(Relation(r.right, r.operator, r.left)) for r, _, put in _relations(statement)]


def _strictness(statement: Statement) -> list[Statement]:
    """< for ≤ where it is claimed, ≤ for < where it is given, and open ends closed."""
    result = [
        put(replace(r, operator="<=" if given else "<"))
        for r, given, put in _relations(statement)
        if r.strict is given
    ]
    if isinstance(statement, ForAll):
        result += [replace(statement, open_low=False)] * statement.open_low
        result += [replace(statement, open_high=False)] * statement.open_high
    if isinstance(statement, (Implies, ForSmall)):
        for k, v in enumerate(statement.variables):
            if v.strict and v.low is not None:
                weak = (*statement.variables[:k], replace(v, strict=False), *statement.variables[k + 1 :])
                result.append(replace(statement, variables=weak))
    return result


def _without_hypothesis(statement: Statement) -> list[Statement]:
    if not isinstance(statement, (Implies, ForSmall)):
        return []
    given = statement.hypotheses
    return [replace(statement, hypotheses=given[:k] + given[k + 1 :]) for k in range(len(given))]


def _wider(statement: Statement) -> list[Statement]:
    """A half-line or an interval made longer than it was."""
    if not isinstance(statement, ForAll):
        return []
    result: list[Statement] = []
    if statement.low is not None:
        result += [replace(statement, low=None), replace(statement, low=statement.low - 1)]
    if statement.high is not None:
        result += [replace(statement, high=None), replace(statement, high=statement.high + 1)]
    return result


def _digits(text: str) -> list[str]:
    unit = Decimal(1).scaleb(int(Decimal(text).as_tuple().exponent))
    return [str(Decimal(text) + k * unit) for k in (1, -1, 3)]


def _wrong_digit(statement: Statement) -> list[Statement]:
    """A printed result or input with another last digit, or a bound of angles rounded down."""
    if isinstance(statement, TrigonometricBound):
        return [
            replace(
                statement, entries=(*statement.entries[:k], (f, Fraction(low)), *statement.entries[k + 1 :])
            )
            for k, (f, bound) in enumerate(statement.entries)
            if bound
            for low in (_rounded(bound)[0], str(bound * Fraction(9, 10)))
        ]
    if not isinstance(statement, Agrees):
        return []
    result: list[Statement] = [replace(statement, printed=text) for text in _digits(statement.printed)]
    for k, (name, text) in enumerate(statement.inputs):
        for other in _digits(text):
            inputs = (*statement.inputs[:k], (name, other), *statement.inputs[k + 1 :])
            result.append(replace(statement, inputs=inputs))
    return result


def _wrong_norms(statement: Statement) -> list[Statement]:
    """A norm too many or too few, or a factor twice."""
    if isinstance(statement, NormBound):
        return [replace(statement, power=1 - statement.power), replace(statement, n=statement.n + 4)]
    if not isinstance(statement, BoundEveryN):
        return []
    more: list[Statement] = []
    for k, (known, size) in enumerate(statement.norms):
        for other in (("mul", size, size), ("num", "1")):
            norms = (*statement.norms[:k], (known, other), *statement.norms[k + 1 :])
            more.append(replace(statement, norms=norms))
        more.append(replace(statement, norms=statement.norms[:k] + statement.norms[k + 1 :]))
    for name in sorted(variables(statement.right)):
        more.append(replace(statement, right=("mul", ("var", name), statement.right)))
    return more


def _halved(statement: Statement) -> list[Statement]:
    """Half of the bound, or twice one side of an identity."""
    if isinstance(statement, Identity):
        return [replace(statement, left=("mul", ("num", "2"), statement.left))]
    if isinstance(statement, NormBound):
        return [replace(statement, bound=("div", statement.bound, ("num", "2")))]
    if isinstance(statement, BoundEveryN):
        return [replace(statement, right=("div", statement.right, ("num", "2")))]
    return []


RULES: dict[str, StatementRule] = {
    "sign flipped": _everywhere(_flipped),
    "term or factor dropped": _everywhere(_dropped),
    "term doubled": _everywhere(_doubled),
    "≥ for ≤": _reversed,
    "γ for ρ": _everywhere(_other_constant),
    "√n missing": _everywhere(_no_root),
    "wrong power or member": _everywhere(_other_power),
    "strict for weak": _strictness,
    "constant rounded the wrong way": _everywhere(_badly_rounded),
    "printed digit": _wrong_digit,
    "hypothesis dropped": _without_hypothesis,
    "interval too wide": _wider,
    "norm or ε too many or too few": _wrong_norms,
    "factor of two": _halved,
}
