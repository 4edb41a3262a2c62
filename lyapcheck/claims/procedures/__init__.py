"""One search a file, entered for its kinds of statement; the checker judges what they find.

Every file of the folder is imported; nothing else need know of a new one.
"""

from __future__ import annotations

from dataclasses import replace
from importlib import import_module
from pkgutil import iter_modules

from lyapcheck.check.expressions.signs import Undefined
from lyapcheck.check.kinds.all_of import AllOf
from lyapcheck.check.refusal import Refused
from lyapcheck.check.statement import Proof, Statement
from lyapcheck.check.verify import verify
from lyapcheck.claims.search_result import SearchResult, find, still_open
from lyapcheck.claims.statements import Missing
from lyapcheck.extensions import folders
from lyapcheck.verdicts import Grade

__path__ += folders(__name__)


def propose(statement: Statement | Missing) -> SearchResult:
    """What the search for the kind of a statement finds, if it stands up to the rules that will judge it.

    Not a verdict: that is for a fresh process of the checker to give, see ``decision``.
    """
    if isinstance(statement, Missing):
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


def _verified(statement: Statement, finding: SearchResult, proof: Proof) -> SearchResult:
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


def _without_value(statement: Statement) -> str:
    """Which term is not shown to have a value, and what to do; empty if all are."""
    if isinstance(statement, AllOf):
        return next(filter(None, (_without_value(part) for _, part in statement.parts)), "")
    try:
        statement.require_defined()
    except Refused as undefined:
        return str(undefined)
    return ""


for _file in iter_modules(__path__):
    import_module(f"{__name__}.{_file.name}")
