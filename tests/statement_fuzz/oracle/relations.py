"""The kinds of statement that are relations over a box: what each means."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from fractions import Fraction
from random import Random
from typing import Any

from tests.statement_fuzz.oracle import kinds
from tests.statement_fuzz.oracle.evaluate import Tree, names
from tests.statement_fuzz.oracle.region import Axis, Objection, Region, Relation
from tests.statement_fuzz.oracle.search import objection_to


def _relation(r: Any) -> Relation:
    return Relation(r.left, r.operator, r.right)


def _axes(variables: Any) -> tuple[Axis, ...]:
    return tuple(Axis(v.name, v.low, open_low=v.low is not None and v.strict) for v in variables)


def _reals(*trees: Tree, but: tuple[Axis, ...] = ()) -> tuple[Axis, ...]:
    taken = {axis.name for axis in but}
    return (*but, *(Axis(name) for name in sorted(names(*trees) - taken)))


def identity(statement: Any) -> Region:
    """Equal for all reals, or for the variables as declared."""
    declared = _axes(getattr(statement, "variables", None) or ())
    axes = _reals(statement.left, statement.right, but=declared)
    return Region(axes, (Relation(statement.left, "=", statement.right),))


def for_all(statement: Any) -> Region:
    """Over an interval."""
    ends = (statement.low, statement.high, statement.open_low, statement.open_high)
    return Region((Axis(statement.variable, *ends),), (_relation(statement.relation),))


def constant(statement: Any) -> Region:
    """Between numbers."""
    return Region((), (_relation(statement.relation),))


def implies(statement: Any) -> Region:
    """Over lower bounds, under hypotheses."""
    given = tuple(map(_relation, statement.hypotheses))
    return Region(_axes(statement.variables), (_relation(statement.conclusion),), given)


def norm_bound(statement: Any) -> Region:
    """Written out in the entries, all squared."""
    entries = [("var", f"x{k + 1}") for k in range(statement.n)]
    of = [("pow", _put(statement.component, entry), 2) for entry in entries]
    right = statement.bound
    if statement.power:
        right = ("mul", right, ("sqrt", ("add", *(("pow", entry, 2) for entry in entries))))
    axes = tuple(Axis(entry[1]) for entry in entries)
    return Region(axes, (Relation(("sqrt", ("add", *of)), "<=", right),))


def _put(tree: Tree, entry: Tree) -> Tree:
    if tree[0] == "var":
        return entry
    return tuple(_put(part, entry) if isinstance(part, tuple) else part for part in tree)


def trigonometric_bound(statement: Any) -> Region:
    """Both signs of each entry; an entry without a bound is only asked to be defined."""
    claims = []
    for tree, bound in statement.entries:
        limit = ("num", str(bound)) if bound is not None else ("abs", tree)
        claims += [Relation(tree, "<=", limit), Relation(("neg", tree), "<=", limit)]
    return Region(_reals(*(tree for tree, _ in statement.entries)), tuple(claims))


def trigonometric_positive(statement: Any) -> Region:
    """Each entry above 0."""
    zero: Tree = ("num", "0")
    return Region(_reals(*statement.entries), tuple(Relation(zero, "<", tree) for tree in statement.entries))


def _entries(statement: Any) -> list[Region]:
    """One region for each relation: a witness gives the variables of one entry, and no others."""
    whole = REGIONS[type(statement).__name__](statement)
    return [Region(_reals(claim.left, claim.right), (claim,)) for claim in whole.claims]


REGIONS: dict[str, Callable[[Any], Region]] = {
    "Identity": identity,
    "ForAll": for_all,
    "Constant": constant,
    "Implies": implies,
    "NormBound": norm_bound,
    "TrigonometricBound": trigonometric_bound,
    "TrigonometricPositive": trigonometric_positive,
}
"""The kinds that are a box with relations; one more is one more function here."""


def _enter(kind: str, region: Callable[[Any], Region]) -> None:
    @kinds.objections_to(kind)
    def look(statement: Any, random: Random) -> Objection | None:
        return objection_to(region(statement), random)

    @kinds.judges(kind)
    def judge(statement: Any, witness: Mapping[str, Any]) -> bool | None:
        point = {name: Fraction(text) for name, text in witness.get("point", {}).items()}
        parts = _entries(statement) if kind.startswith("Trigonometric") else [region(statement)]
        outcomes = [part.fails_at(point) for part in parts]
        return True if True in outcomes else None if None in outcomes else False


for _kind, _region in REGIONS.items():
    _enter(_kind, _region)


@kinds.objections_to("AllOf")
def look_at_parts(statement: Any, random: Random) -> Objection | None:
    """An objection to some part."""
    result = (kinds.objection(part, random.getrandbits(32)) for _, part in statement.parts)
    return next((one for one in result if one is not None), None)


@kinds.judges("AllOf")
def judge_parts(statement: Any, witness: Mapping[str, Any]) -> bool | None:
    """Whether the point refutes some part."""
    outcomes = [kinds.confirms(part, witness) for _, part in statement.parts]
    return True if True in outcomes else None if None in outcomes else False
