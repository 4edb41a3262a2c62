"""What a claim says, where it stands, what it rests on, and which procedure decides it."""

from __future__ import annotations

import inspect
from textwrap import fill

from lyapcheck.claims.case import Lacking
from lyapcheck.claims.claim import Claim, Proof
from lyapcheck.claims.procedures import PROCEDURES
from lyapcheck.claims.run import paper_case
from lyapcheck.claims.script import check_ids, find_script, load_proof
from lyapcheck.claims.statements import AllOf, Statement

WIDTH = 88


def explain(claim_id: str, script: str = "published.py") -> str:
    """The explanation of one claim, as text.

    Raises:
        InputError: no such script, or no such claim in it.
    """
    path = find_script(script)
    proof = load_proof(path, path.name)
    check_ids(proof, (claim_id,), path.name)
    claim = proof.claims[claim_id]
    lines = [
        f"{claim.id}  {claim.says}",
        f"where    {claim.place or 'not said'}",
        f"uses     {', '.join(claim.uses) or 'no other claim'}",
        f"used by  {', '.join(_users(proof, claim_id)) or 'no other claim'}",
        *_how(claim),
        f"run      lyapcheck check {path.name} --only {claim_id}",
    ]
    return "\n".join(lines) + "\n"


def _users(proof: Proof, used: str) -> list[str]:
    return [claim.id for claim in proof.claims.values() if used in claim.uses]


def _how(claim: Claim) -> list[str]:
    try:
        statement = claim.statement(paper_case(2))
    except Lacking as lack:
        return [f"decided  {lack}"]
    lines = [f"kind     {_kind(statement)}"]
    for text in dict.fromkeys(_procedures(statement)):
        lines.append(fill(text, WIDTH, initial_indent="decided  ", subsequent_indent="         "))
    return lines


def _kind(statement: Statement) -> str:
    if isinstance(statement, AllOf):
        return "all of: " + "; ".join(f"{name} ({_kind(part)})" for name, part in statement.parts)
    return type(statement).__name__


def _procedures(statement: Statement) -> list[str]:
    """How each part is decided: the opening of the docstring of the procedure's module."""
    if isinstance(statement, AllOf):
        return [text for _, part in statement.parts for text in _procedures(part)]
    procedure = next(p for kind, p in PROCEDURES.items() if isinstance(statement, kind))
    module = inspect.getmodule(procedure)
    return [" ".join((inspect.getdoc(module) or "").split("References:")[0].split())]
