"""Conjunctions: a proof of every part, or a refutation of one."""

from __future__ import annotations

from lyapcheck.check.certificates.proofs import EveryPart, OnePart
from lyapcheck.check.certificates.refusal import require
from lyapcheck.check.certificates.statements import AllOf
from lyapcheck.check.certificates.verify import Accepted, require_proved, rule, verify, weakest


@rule(AllOf, EveryPart)
def by_every_part(statement: AllOf, proof: EveryPart) -> Accepted:
    """Soundness: each part by its own proof."""
    require(len(proof.parts) == len(statement.parts), "parts", len(proof.parts), "is not one proof per part")
    pairs = zip(statement.parts, proof.parts, strict=True)
    return Accepted("proved", weakest([require_proved(part, own, name) for (name, part), own in pairs]))


@rule(AllOf, OnePart)
def by_one_part(statement: AllOf, proof: OnePart) -> Accepted:
    """Soundness: one false part makes the whole false."""
    require(0 <= proof.part < len(statement.parts), "part", proof.part, "does not exist")
    name, part = statement.parts[proof.part]
    found = verify(part, proof.proof)
    require(found.verdict == "refuted", name, found.verdict, "must be refuted")
    return found
