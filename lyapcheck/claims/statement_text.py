"""Statements as a reader writes them, from the data that is decided."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from fractions import Fraction
from typing import Any

from lyapcheck.check.certificates.every_n import BoundEveryN, EveryN
from lyapcheck.check.certificates.rules.theorem import THEOREMS
from lyapcheck.check.certificates.statements import DampingBelow, Decreasing
from lyapcheck.claims.expression_text import expression_text, number_text
from lyapcheck.claims.statements import (
    Agrees,
    Constant,
    ForAll,
    ForSmall,
    Identity,
    Implies,
    Majorant,
    NormBound,
    NormChain,
    Relation,
    Statement,
    Theorem,
    TrigonometricBound,
    TrigonometricPositive,
    Variable,
)

LONGEST = 700
"""Characters beyond which a formula is no longer for reading."""


def statement_text(statement: Statement) -> str:
    """The statement in one line; empty for a kind that is data rather than a formula, or too long to read."""
    written = WRITTEN.get(type(statement))
    text = "" if written is None else written(statement)
    return text if len(text) <= LONGEST else ""


def relation_text(relation: Relation) -> str:
    """``left ≤ right``."""
    sign = "<" if relation.strict else "≤"
    return f"{expression_text(relation.left)} {sign} {expression_text(relation.right)}"


def _identity(statement: Identity) -> str:
    return f"{expression_text(statement.left)} = {expression_text(statement.right)}"


def _for_all(statement: ForAll) -> str:
    low = "−∞" if statement.low is None else number_text(statement.low)
    high = "∞" if statement.high is None else number_text(statement.high)
    left = "(" if statement.open_low or statement.low is None else "["
    right = ")" if statement.open_high or statement.high is None else "]"
    return f"{relation_text(statement.relation)} for all {statement.variable} in {left}{low}, {high}{right}"


def _constant(statement: Constant) -> str:
    return relation_text(statement.relation)


def _norm_bound(statement: NormBound) -> str:
    power = "" if statement.power == 0 else "·‖x‖" if statement.power == 1 else f"·‖x‖^{statement.power}"
    entry, bound = expression_text(statement.component), expression_text(statement.bound)
    return f"‖({entry})ᵢ‖ ≤ {bound}{power} for all x in R^{statement.n}, x = xᵢ in the i-th entry"


def _implies(statement: Implies) -> str:
    return _conditional(statement.variables, statement.hypotheses, statement.conclusion)


def _for_small(statement: ForSmall) -> str:
    body = _conditional(statement.variables, statement.hypotheses, statement.conclusion)
    return f"for every small enough {statement.small} > 0: {body}"


def _conditional(variables: Iterable[Variable], hypotheses: Iterable[Relation], conclusion: Relation) -> str:
    over = ", ".join(map(_range, variables))
    given = " and ".join(map(relation_text, hypotheses))
    start = f"for all {over}: " if over else ""
    return start + (f"if {given}, then " if given else "") + relation_text(conclusion)


def _range(variable: Variable) -> str:
    if variable.low is None:
        return f"{variable.name} in R"
    return f"{variable.name} {'>' if variable.strict else '≥'} {number_text(variable.low)}"


def _agrees(statement: Agrees) -> str:
    inputs = ", ".join(f"{name} = {_printed(value)}" for name, value in statement.inputs)
    given = f" for {inputs}" if inputs else ""
    formula, printed = expression_text(statement.formula), _printed(statement.printed)
    return f"{formula} is {printed}{given}, all to printed precision"


def _printed(number: str) -> str:
    return number.replace("-", "−")


def _norm_chain(statement: NormChain) -> str:
    factors = " · ".join(map(_factor, statement.factors))
    larger = [f"{small} ≤ {large}" for small, large in statement.smaller]
    using = f", with {' and '.join(larger)}" if larger else ""
    return f"{factors} ≤ {_majorant(statement.bound)}{using}"


def _factor(majorants: tuple[Majorant, ...]) -> str:
    shown = ", ".join(map(_majorant, majorants))
    return f"min({shown})" if len(majorants) > 1 else shown


def _majorant(majorant: Majorant) -> str:
    powers = [name if power == 1 else f"{name}^{power}" for name, power in majorant.powers]
    constant = expression_text(majorant.constant)
    return "·".join(([constant] if constant != "1" or not powers else []) + powers)


def _every_n(statement: EveryN) -> str:
    sides = f"{expression_text(statement.left)} = {expression_text(statement.right)}"
    return f"{sides} for every n{_with(statement)}"


def _bound_every_n(statement: BoundEveryN) -> str:
    sides = f"{expression_text(statement.left)} ≤ {expression_text(statement.right)}"
    norms = [
        f"{''.join(f'‖{expression_text(letter)}‖' for letter in known)} ≤ {expression_text(size)}"
        for known, size in statement.norms
    ]
    least = [f"{expression_text(number)} ≥ {expression_text(size)}" for number, size in statement.least]
    return f"{sides} for every n{_with(statement.terms)}, {', '.join(norms + least)}"


def _with(statement: EveryN) -> str:
    """What is known of the letters."""
    known = [f"{name}ᵀ = {name}" for name in statement.symmetric]
    known += [f"d/dt({expression_text(x)}) = {expression_text(value)}" for x, value in statement.rates]
    known += [f"{one.matrix}·{one.vector} = {expression_text(one.equals)}" for one in statement.given]
    return f", with {', '.join(known)}" if known else ""


def _theorem(statement: Theorem) -> str:
    known = THEOREMS.get(statement.name)
    if known is None:
        return f"by a theorem that the checker does not know, {statement.name}"
    given = ", ".join(f"{label} ({claim})" for label, claim in statement.hypotheses)
    return f"by {statement.name} ({known.reference}), {known.conclusion}; its hypotheses: {given}"


def _bounded(statement: TrigonometricBound) -> str:
    limits = [limit for _, limit in statement.entries if limit is not None]
    bounds = f" by {', '.join(map(number_text, limits))}" if limits else ""
    return f"{_entries(len(statement.entries))} bounded{bounds} in size, for all q"


def _positive(statement: TrigonometricPositive) -> str:
    return f"{_entries(len(statement.entries))} positive, for all q"


def _entries(count: int) -> str:
    return (
        "a polynomial in sines and cosines is"
        if count == 1
        else f"{count} polynomials in sines and cosines are"
    )


def _decreasing(statement: Decreasing) -> str:
    weights = f", Λ = {_diagonal(statement.coupling)}" if statement.coupling else ""
    gains = f"K_p = {_diagonal(statement.kp)}, K_v = {_diagonal(statement.kv)}"
    return (
        f"dV/dt < 0 at every state but the origin, for {gains}, ε₀ = {number_text(statement.eps0)}{weights}"
    )


def _damping_below(statement: DampingBelow) -> str:
    return (
        "for all κ > 0 and ε₀ > 0: if dV/dt < 0 at every state but the origin, for "
        f"K_p = {_diagonal(statement.kp)} and κ K_v with K_v = {_diagonal(statement.kv)}, then "
        f"κ·{number_text(max(statement.kv))} < {expression_text(statement.bound)}"
    )


def _diagonal(entries: Iterable[Fraction]) -> str:
    return f"diag({', '.join(map(number_text, entries))})"


WRITTEN: dict[type[Statement], Callable[[Any], str]] = {
    Identity: _identity,
    ForAll: _for_all,
    Constant: _constant,
    NormBound: _norm_bound,
    Implies: _implies,
    ForSmall: _for_small,
    Agrees: _agrees,
    NormChain: _norm_chain,
    TrigonometricBound: _bounded,
    TrigonometricPositive: _positive,
    Decreasing: _decreasing,
    DampingBelow: _damping_below,
    Theorem: _theorem,
    EveryN: _every_n,
    BoundEveryN: _bound_every_n,
}
