"""One search a file, entered for its kinds of statement; the checker judges what they find.

Every file of the folder is imported; nothing else need know of a new one.
"""

from __future__ import annotations

from dataclasses import replace
from importlib import import_module
from pkgutil import iter_modules

from lyapcheck.check.expressions.signs import Undefined
from lyapcheck.check.kinds.all_of import AllOf, EveryPart, OnePart
from lyapcheck.check.kinds.flow import Flow
from lyapcheck.check.kinds.stability import ByObligations, Property, Stable
from lyapcheck.check.kinds.stable_arm import StableArm
from lyapcheck.check.refusal import Refused
from lyapcheck.check.statement import Proof, Statement
from lyapcheck.check.systems.obligations import never_met
from lyapcheck.check.verify import verify
from lyapcheck.claims.procedures.implication import counterexample
from lyapcheck.claims.procedures.search import witness_of
from lyapcheck.claims.search_result import SearchResult, broken, find, procedure, shown, still_open
from lyapcheck.claims.statements import Missing
from lyapcheck.extensions import folders
from lyapcheck.verdicts import Grade, Verdict

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


# --- Statements that others decide: conjunctions, theorems by obligations, kinds that name their proofs.


METHOD = "obligations of a theorem"
SHORT = 60
"""Characters up to which an obligation that fails is written out."""


def proposed_word(verdict: Verdict) -> str:
    """What a search thinks of one part, which no checker has judged by itself."""
    return "proposed" if verdict is Verdict.PROVED else verdict.value


@procedure(AllOf)
def find_all(statement: AllOf) -> SearchResult:
    """Each part by the search for its kind: one is refuted, or one open, or there is a proof of each."""
    named = [(name, find(part)) for name, part in statement.parts]
    rows = [{"part": name, "verdict": proposed_word(f.verdict), "method": f.method} for name, f in named]
    evidence = {"parts": rows}
    for wanted in (Verdict.REFUTED, Verdict.UNDECIDED):
        for index, (name, result) in enumerate(named):
            if result.verdict is wanted:
                reason = f"{name}: {result.reason}" if result.reason else name
                proof = OnePart(index, result.proof) if result.proof is not None else None
                return replace(result, reason=reason, proof=proof, evidence={**result.evidence, **evidence})
    methods = "; ".join(dict.fromkeys(result.method for _, result in named))
    proofs = tuple(result.proof for _, result in named if result.proof is not None)
    return shown(EveryPart(proofs), methods, **evidence)


@procedure(Stable, StableArm, Property, Flow)
def find_stable(statement: Stable | StableArm | Property | Flow) -> SearchResult:
    """Decide the obligations up to one that fails: the conclusion is open then, as it is sufficient only."""
    never = never_met(statement.argument) if isinstance(statement, Stable | Property) else None
    point = None if never is None else counterexample(never)
    if never is not None and point is None:
        return still_open("conditions: no constants were found that meet them; a theorem needs some", METHOD)
    proofs, rows = [], []
    for name, obligation in statement.obligations():
        one = find(obligation)
        rows.append({"part": name, "verdict": proposed_word(one.verdict), "method": one.method})
        if not one.is_proof or one.proof is None:
            text = obligation.text()
            what = text if len(text) <= SHORT else "it"
            why = one.reason or f"{what} is {one.verdict.value}, {one.method}"
            return still_open(f"{name}: {why}", METHOD, parts=rows)
        proofs.append(one.proof)
    met = None if point is None else witness_of(point)
    return shown(ByObligations(tuple(proofs), met), METHOD, parts=rows)


@procedure(Statement)
def find_attempt(statement: Statement) -> SearchResult:
    """Of a kind without a search of its own: what it thinks worth trying; the first that its rules accept."""
    reason = f"no search is known for a {type(statement).__name__}, and it names no proofs to try"
    for proof in statement.attempts():
        try:
            verdict = verify(statement, proof).verdict
        except Refused as refusal:
            reason = str(refusal)
            continue
        if verdict == "proved":
            return shown(proof, proof.rule)
        return broken(proof, proof.rule, {"shown by": proof.rule})
    return still_open(reason, "attempts")


for _file in iter_modules(__path__):
    import_module(f"{__name__}.{_file.name}")
