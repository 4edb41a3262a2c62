"""One search a file, chosen by the kind of statement; the checker judges what they find."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache
from typing import Any

from lyapcheck.check.expressions.defined import Undefined, require_defined
from lyapcheck.check.kinds.bound_every_n import BoundEveryN
from lyapcheck.check.kinds.compared import Compared
from lyapcheck.check.kinds.every_n import EveryN
from lyapcheck.check.kinds.gravity import GravityBelow
from lyapcheck.check.kinds.inertia import CoriolisBelow, MassAbove, MassBelow
from lyapcheck.check.kinds.loop_property import LoopProperty
from lyapcheck.check.kinds.resting import Resting
from lyapcheck.check.kinds.settling import Settling
from lyapcheck.check.kinds.theorem import THEOREMS, Application
from lyapcheck.check.refusal import Refused
from lyapcheck.check.statement import Proof
from lyapcheck.check.verify import verify
from lyapcheck.claims import state_statements as state_kinds
from lyapcheck.claims import statements as kinds
from lyapcheck.claims.finding import Finding, conjunction, shown, still_open
from lyapcheck.claims.procedures.compared import find_compared
from lyapcheck.claims.procedures.constants import find_constant
from lyapcheck.claims.procedures.every_n import find_every_n
from lyapcheck.claims.procedures.gravity import find_gravity_below
from lyapcheck.claims.procedures.identity import find_identity
from lyapcheck.claims.procedures.implication import find_implies
from lyapcheck.claims.procedures.inertia import find_mass_above, find_upper
from lyapcheck.claims.procedures.loop_property import find_loop_property
from lyapcheck.claims.procedures.norm_bounds import find_bound_every_n
from lyapcheck.claims.procedures.norms import find_norm_bound
from lyapcheck.claims.procedures.one_variable import find_for_all
from lyapcheck.claims.procedures.printed import find_agrees
from lyapcheck.claims.procedures.settling import find_resting, find_settling
from lyapcheck.claims.procedures.small import find_for_small
from lyapcheck.claims.procedures.states import find_damping_below, find_decreasing
from lyapcheck.claims.procedures.trigonometric import find_bounds, find_positive
from lyapcheck.verdicts import Grade


def propose(statement: kinds.Statement | kinds.Missing) -> Finding:
    """What the search for the kind of a statement finds, if it stands up to the rules that will judge it.

    Not a verdict: that is for a fresh process of the checker to give, see ``fresh_check``.
    """
    if isinstance(statement, kinds.Missing):
        return still_open(statement.reason, "not applicable")
    try:
        statement.require_well_formed()
        finding = find(statement)
    except Refused as refusal:
        return still_open(f"{refusal}; correct the statement", "form of the statement")
    except (ValueError, ArithmeticError) as problem:
        return still_open(
            _without_value(statement) or f"the search ends with {problem}; simplify it", "search"
        )
    return finding if finding.proof is None else _verified(statement, finding, finding.proof)


def _verified(statement: kinds.Statement, finding: Finding, proof: Proof) -> Finding:
    """The finding with the grade that the rules give it, or why they refuse it."""
    try:
        accepted = verify(statement, proof)
    except Undefined as undefined:
        return still_open(str(undefined), finding.method, **finding.evidence)
    except Refused as refusal:
        fault = f"what the search found is refused by the checker ({refusal}); report this as a fault"
        return still_open(_without_value(statement) or fault, finding.method, **finding.evidence)
    if accepted.verdict != finding.verdict.value:
        raise AssertionError(f"the search says {finding.verdict.value}, the checker {accepted.verdict}")
    return replace(finding, grade=Grade[accepted.grade.upper()])


def _without_value(statement: kinds.Statement) -> str:
    """Which term is not shown to have a value, and what to do; empty if all are."""
    if isinstance(statement, kinds.AllOf):
        return next(filter(None, (_without_value(part) for _, part in statement.parts)), "")
    try:
        for tree, domain in statement.terms():
            require_defined(tree, domain)
    except Refused as undefined:
        return str(undefined)
    return ""


@lru_cache(maxsize=1024)
def find(statement: kinds.Statement) -> Finding:
    """What the search for the kind of a statement finds; not yet judged. Claims share facts: each once."""
    for kind, procedure in PROCEDURES.items():
        if isinstance(statement, kind):
            return procedure(statement)
    raise TypeError(f"no procedure decides a {type(statement).__name__}")


def _find_all(statement: kinds.AllOf) -> Finding:
    return conjunction((name, find(part)) for name, part in statement.parts)


def _apply_theorem(statement: kinds.Theorem) -> Finding:
    """The step itself holds; whether its hypotheses do is for the chain of claims to say."""
    if statement.name not in THEOREMS:
        known = "; ".join(sorted(THEOREMS))
        return still_open(f"the checker knows no theorem of that name, only: {known}", "theorem")
    try:
        verify(statement, Application())
    except Refused as refusal:
        return still_open(f"{refusal}; correct the hypotheses or the numbers of the loop", "theorem")
    hypotheses = dict(statement.hypotheses)
    return shown(Application(), f"theorem: {statement.name}", hypotheses=hypotheses)


PROCEDURES: dict[type[kinds.Statement], Callable[[Any], Finding]] = {
    kinds.Identity: find_identity,
    EveryN: find_every_n,
    BoundEveryN: find_bound_every_n,
    kinds.ForAll: find_for_all,
    kinds.Constant: find_constant,
    kinds.NormBound: find_norm_bound,
    kinds.Implies: find_implies,
    kinds.ForSmall: find_for_small,
    kinds.Agrees: find_agrees,
    kinds.TrigonometricBound: find_bounds,
    kinds.TrigonometricPositive: find_positive,
    LoopProperty: find_loop_property,
    MassAbove: find_mass_above,
    MassBelow: find_upper,
    CoriolisBelow: find_upper,
    Compared: find_compared,
    GravityBelow: find_gravity_below,
    state_kinds.Decreasing: find_decreasing,
    state_kinds.DampingBelow: find_damping_below,
    Settling: find_settling,
    Resting: find_resting,
    kinds.Theorem: _apply_theorem,
    kinds.AllOf: _find_all,
}
