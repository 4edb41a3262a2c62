"""What a claim says, where it stands, what it rests on, and which procedure decides it."""

from __future__ import annotations

import inspect
from dataclasses import dataclass

from lyapcheck.claims.case import Case, Lacking
from lyapcheck.claims.claim import Claim, Proof
from lyapcheck.claims.procedures import PROCEDURES
from lyapcheck.claims.run import paper_case
from lyapcheck.claims.script import SHIPPED, check_ids, find_script, load_proof
from lyapcheck.claims.statements import AllOf, Statement, Theorem

SHOWN_MEMBER = 2
"""The m at which statements are written out: the first with a peak."""

BY_THEOREM = (
    "A theorem applied: the checker compares the hypotheses that are named with those of the theorem, and "
    "looks into the claim behind each, which must state what the hypothesis comes to for this loop."
)


@dataclass(frozen=True)
class Part:
    """One thing that a claim asks to be decided.

    Args:
        name: of the part; empty where the claim is one statement.
        kind: of the statement.
        says: the statement as it is decided; empty where it is too long to read.
    """

    name: str
    kind: str
    says: str


@dataclass(frozen=True)
class Explanation:
    """A claim explained; ``str`` of it is what ``lyapcheck explain`` prints.

    Args:
        id: of the claim.
        says: the claim in words.
        script: the proof script that makes it.
        title: of the proof.
        place: where the text makes it, empty where that is not said.
        reference: the text.
        uses: the claims it rests on, and what they say.
        used_by: the claims that rest on it, and what they say.
        case: the m, n and arm at which the parts are written out; empty where they depend on none of them.
        parts: what is decided.
        lacking: why nothing can be decided for the paper's arm, empty where it can.
        procedures: how it is decided, one paragraph a procedure.
    """

    id: str
    says: str
    script: str
    title: str
    place: str
    reference: str
    uses: tuple[tuple[str, str], ...]
    used_by: tuple[tuple[str, str], ...]
    case: str
    parts: tuple[Part, ...]
    lacking: str
    procedures: tuple[str, ...]

    def __str__(self) -> str:
        """Plain text, a paragraph a question."""
        from lyapcheck.claims.explain_formats import text

        return text(self)

    def _repr_html_(self) -> str:
        """For a notebook."""
        from lyapcheck.claims.explain_formats import html

        return html(self)


def explain(claim_id: str, script: str | None = None) -> Explanation:
    """One claim explained.

    Args:
        claim_id: such as ``7a``; ``(7a)`` and ``7A`` mean the same where no other claim has that id.
        script: the proof script that makes it; by default the first of those that come with lyapcheck.

    Raises:
        InputError: no such script, or no such claim.

    Example:
        >>> found = explain("16.6")
        >>> found.place, [used for used, _ in found.uses]
        ('(16), term 6', ['15'])
        >>> print(explain("T1.torque.m2.elbow").parts[0].says)
        150 = 15
    """
    proof, name = _proof_with(claim_id, script)
    claim = proof.claims[_meant(claim_id, proof) or claim_id]
    lacking, statement, case = "", None, paper_case(SHOWN_MEMBER)
    try:
        statement = claim.statement(case)
    except Lacking as lack:
        lacking = str(lack)
    users = [other for other in proof.claims.values() if claim.id in other.uses]
    return Explanation(
        id=claim.id,
        says=claim.says,
        script=name,
        title=proof.title,
        place=claim.place,
        reference=proof.reference,
        uses=tuple(_named(proof.claims[used]) for used in claim.uses if used in proof.claims),
        used_by=tuple(map(_named, users)),
        case=_shown_case(case),
        parts=() if statement is None else tuple(_parts("", statement)),
        lacking=lacking,
        procedures=() if statement is None else tuple(dict.fromkeys(_procedures(statement))),
    )


def _proof_with(claim_id: str, script: str | None) -> tuple[Proof, str]:
    """The proof that makes a claim, and the name of its script."""
    paths = [find_script(name) for name in (SHIPPED if script is None else (script,))]
    every = Proof("", "")
    for path in paths:
        proof = load_proof(path, path.name)
        if _meant(claim_id, proof):
            return proof, path.name
        every.claims |= proof.claims
    check_ids(every, (claim_id,), ", ".join(path.name for path in paths))
    raise AssertionError("unreachable: an id that no proof has was accepted")


def _meant(claim_id: str, proof: Proof) -> str | None:
    """The id that was meant: as written, or without brackets, or in other letters where only one fits."""
    bare = claim_id.strip().removeprefix("(").removesuffix(")")
    for wanted in (claim_id, bare):
        if wanted in proof.claims:
            return wanted
    near = [known for known in proof.claims if known.casefold() == bare.casefold()]
    return near[0] if len(near) == 1 else None


def _named(claim: Claim) -> tuple[str, str]:
    return claim.id, claim.says


def _shown_case(case: Case) -> str:
    shown = [
        f"{name} = {value}" for name, value in (("m", case.the_m), ("n", case.the_n)) if name in case.read
    ]
    if "robot" in case.read and case.the_robot is not None:
        shown.append(case.the_robot.name)
    return ", ".join(shown)


def _parts(name: str, statement: Statement) -> list[Part]:
    if isinstance(statement, AllOf):
        return [
            found
            for inner, part in statement.parts
            for found in _parts(f"{name}, {inner}" if name else inner, part)
        ]
    return [Part(name, type(statement).__name__, statement.text())]


def _procedures(statement: Statement) -> list[str]:
    """How each part is decided: the opening of the docstring of the procedure's module."""
    if isinstance(statement, AllOf):
        return [text for _, part in statement.parts for text in _procedures(part)]
    if isinstance(statement, Theorem):
        return [BY_THEOREM]
    procedure = next(p for kind, p in PROCEDURES.items() if isinstance(statement, kind))
    described = inspect.getdoc(inspect.getmodule(procedure)) or ""
    return [described.split("References:")[0].replace("``", "").strip()]
