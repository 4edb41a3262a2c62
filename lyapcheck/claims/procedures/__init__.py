"""One decision procedure a file, chosen by the kind of statement."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from lyapcheck.claims import statements as kinds
from lyapcheck.claims.decision import Decision, conjunction, proved, undecided
from lyapcheck.claims.procedures.chain import decide_chain
from lyapcheck.claims.procedures.constants import decide_constant
from lyapcheck.claims.procedures.identity import decide_identity
from lyapcheck.claims.procedures.implication import decide_implies
from lyapcheck.claims.procedures.norms import decide_norm_bound
from lyapcheck.claims.procedures.one_variable import decide_for_all
from lyapcheck.claims.procedures.printed import decide_agrees
from lyapcheck.claims.procedures.small import decide_for_small
from lyapcheck.claims.procedures.trigonometric import decide_bounds, decide_positive
from lyapcheck.verdicts import Grade


def decide(statement: kinds.Statement) -> Decision:
    """The decision on a statement, by the procedure of its kind."""
    for kind, procedure in PROCEDURES.items():
        if isinstance(statement, kind):
            return procedure(statement)
    raise TypeError(f"no procedure decides a {type(statement).__name__}")


def _decide_all(statement: kinds.AllOf) -> Decision:
    return conjunction((name, decide(part)) for name, part in statement.parts)


def _apply_theorem(statement: kinds.Theorem) -> Decision:
    """The step itself holds; whether its hypotheses do is for the chain of claims to say."""
    return proved(Grade.EXACT, f"theorem: {statement.name}", hypotheses=dict(statement.hypotheses))


def _missing(statement: kinds.Missing) -> Decision:
    return undecided(statement.reason, "not applicable")


PROCEDURES: dict[type[kinds.Statement], Callable[[Any], Decision]] = {
    kinds.Identity: decide_identity,
    kinds.ForAll: decide_for_all,
    kinds.Constant: decide_constant,
    kinds.NormBound: decide_norm_bound,
    kinds.Implies: decide_implies,
    kinds.ForSmall: decide_for_small,
    kinds.Agrees: decide_agrees,
    kinds.NormChain: decide_chain,
    kinds.TrigonometricBound: decide_bounds,
    kinds.TrigonometricPositive: decide_positive,
    kinds.Theorem: _apply_theorem,
    kinds.AllOf: _decide_all,
    kinds.Missing: _missing,
}
