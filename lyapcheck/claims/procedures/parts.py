"""Statements that others decide: conjunctions, theorems by obligations, kinds that name their proofs."""

from __future__ import annotations

from dataclasses import replace

from lyapcheck.check.kinds.all_of import AllOf, EveryPart, OnePart
from lyapcheck.check.kinds.flow import Flow
from lyapcheck.check.kinds.stability import ByObligations, Property, Stable
from lyapcheck.check.kinds.stable_arm import StableArm
from lyapcheck.check.refusal import Refused
from lyapcheck.check.statement import Statement
from lyapcheck.check.systems.obligations import never_met
from lyapcheck.check.verify import verify
from lyapcheck.claims.procedures.implication import counterexample
from lyapcheck.claims.procedures.search import witness_of
from lyapcheck.claims.search_result import SearchResult, broken, find, procedure, shown, still_open
from lyapcheck.verdicts import Verdict

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
