"""One certificate from its bytes to what it shows by itself."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass, replace
from typing import Any

from lyapcheck.check.certificate import Certificate, digest_of, judge, parse, read, theorems_of
from lyapcheck.check.codec import name_of, to_json
from lyapcheck.check.finding import Finding, shortened
from lyapcheck.check.kinds.all_of import AllOf, EveryPart, OnePart
from lyapcheck.check.kinds.for_all import Piece
from lyapcheck.check.kinds.theorem import THEOREMS
from lyapcheck.check.refusal import Refused, plain, require
from lyapcheck.check.statement import Proof, Statement
from lyapcheck.check.theorems.premises import unmet
from lyapcheck.check.verify import RULES


def certificate_of(content: bytes) -> Certificate:
    """A certificate from the bytes of a file.

    Raises:
        ValueError: they are not JSON in UTF-8.
        Refused: they are no certificate.
    """
    return read(parse(content.decode("utf-8")))


def judged(content: bytes, full: bool = False) -> Finding:
    """What a certificate shows by itself; whatever goes wrong is the reason why it is refused."""
    found = Finding()
    try:
        certificate = certificate_of(content)
        found = _about(certificate, full)
        grade = judge(certificate).grade
    except ValueError as error:
        return replace(found.refused(f"is not JSON in UTF-8 ({error})"), unreadable=True)
    except Refused as refusal:
        return found.refused(str(refusal))
    except (RecursionError, MemoryError) as error:
        return found.refused(f"is too large for the checker ({type(error).__name__})")
    return replace(found, grade=grade)


def lacking(content: bytes, used: Mapping[str, tuple[str, bytes]]) -> str:
    """What the claims behind the hypotheses of its theorems fail to state; empty if nothing is missing.

    Args:
        content: a certificate.
        used: digest and bytes of accepted certificates, by the claims that it uses.
    """
    stated: dict[str, Statement] = {}
    for claim, (digest, text) in used.items():
        premise = certificate_of(text)
        require(premise.digest == digest, claim, digest, "changed while it was judged")
        stated[claim] = premise.statement
    found = (unmet(theorem, stated) for theorem in theorems_of(certificate_of(content).statement))
    return plain(next((lacks for lacks in found if lacks is not None), ""))


def _about(certificate: Certificate, full: bool) -> Finding:
    claim, statement = certificate.claim, certificate.statement
    statement.require_well_formed()
    return Finding(
        digest=certificate.digest,
        label=shortened(claim.id, full),
        says=shortened(claim.says, full),
        m=claim.m,
        n=claim.n,
        statement=shortened(statement.text(), full),
        statement_digest=digest_of(to_json(statement)),
        verdict=certificate.verdict,
        uses=dict(sorted(certificate.uses.items())),
        shows=tuple(
            (digest_of(to_json(part)), verdict, shortened(part.text(), full))
            for part, verdict in shown_by(statement, certificate.proof, certificate.verdict)
        ),
        theorems=tuple(_granted(theorem.name) for theorem in theorems_of(statement)),
        rules=tuple(sorted(set(_rules(certificate)))),
    )


def shown_by(statement: Statement, proof: Proof, verdict: str) -> Iterator[tuple[Statement, str]]:
    """A statement and the parts of it that an accepted proof decides, with their verdicts."""
    yield statement, verdict
    if isinstance(statement, AllOf) and isinstance(proof, EveryPart):
        for (_, part), own in zip(statement.parts, proof.parts, strict=False):
            yield from shown_by(part, own, "proved")
    if isinstance(statement, AllOf) and isinstance(proof, OnePart) and 0 <= proof.part < len(statement.parts):
        yield from shown_by(statement.parts[proof.part][1], proof.proof, "refuted")


def _granted(name: str) -> tuple[str, str, tuple[str, ...]]:
    known = THEOREMS.get(name)
    if known is None:
        raise Refused("theorem", name, "is not one that the checker knows")
    granted: Any = known.granted
    return name, known.reference, (granted,) if isinstance(granted, str) else tuple(granted)


def _rules(certificate: Certificate) -> Iterator[tuple[str, str]]:
    """The rule of the proof and those inside it, each with the module that it is in."""
    kind, by = type(certificate.statement), type(certificate.proof)
    entered = RULES.get((kind, by))
    if entered is not None:
        yield f"{name_of(kind)} by {name_of(by)}", entered.__module__
    waiting: list[Any] = [certificate.statement, certificate.proof]
    while waiting:
        value = waiting.pop()
        if isinstance(value, (Statement, Proof, Piece)):
            yield name_of(type(value)), type(value).__module__
        if is_dataclass(value):
            waiting += (getattr(value, field.name) for field in fields(value))
        elif isinstance(value, tuple):
            waiting += (part for part in value if isinstance(part, tuple) or is_dataclass(part))


