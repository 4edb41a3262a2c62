"""One certificate from its bytes to what it shows by itself."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields, is_dataclass, replace
from json import JSONDecodeError
from typing import Any

from lyapcheck.check.certificate import Certificate, digest_of, judge, parse, read, sealed
from lyapcheck.check.codec import name_of
from lyapcheck.check.judgement import Judgement, shortened
from lyapcheck.check.refusal import Refused, plain
from lyapcheck.check.statement import Piece, Proof, Statement
from lyapcheck.check.verify import each_once

__all__ = ["certificate_of", "decided_by", "each_once", "judged"]


def certificate_of(content: bytes) -> tuple[Certificate, Any]:
    """A certificate from the bytes of a file, and its JSON value.

    Raises:
        UnicodeDecodeError, JSONDecodeError: they are not JSON in UTF-8.
        Refused: they are no certificate.
    """
    data = parse(content.decode("utf-8"))
    return read(data), data


def judged(content: bytes, full: bool = False) -> Judgement:
    """What a certificate shows by itself; whatever goes wrong is the reason why it is refused."""
    result = Judgement()
    try:
        data = parse(content.decode("utf-8"))
        sealed(data)
        result = replace(result, digest=data["digest"])
        certificate = read(data)
        result = _claimed(certificate, data, full)
        return _shown(result, certificate, data, judge(certificate).grade, full)
    except (UnicodeDecodeError, JSONDecodeError) as error:
        return replace(result.refused(f"is not JSON in UTF-8 ({error})"), unreadable=True)
    except Refused as refusal:
        return result.refused(str(refusal))
    except Exception as error:
        return result.refused(f"cannot be judged ({type(error).__name__}: {error})")


def _claimed(certificate: Certificate, data: Any, full: bool) -> Judgement:
    """What it says of itself."""
    claim = certificate.claim
    return Judgement(
        digest=data["digest"],
        claim=claim.id,
        label=plain(claim.id),
        says=shortened(" ".join(claim.says.split()).replace("”", "’’"), full),
        m=claim.m,
        n=claim.n,
        verdict=certificate.verdict,
        uses=dict(sorted(certificate.uses.items())),
    )


def _shown(result: Judgement, certificate: Certificate, data: Any, grade: str, full: bool) -> Judgement:
    """What it shows, now that its proof is accepted."""
    statement = certificate.statement
    decided = decided_by(statement, certificate.proof, certificate.verdict, data["statement"])
    shown = certificate.verdict == "proved"
    shows = tuple((digest_of(part), verdict, where) for part, verdict, where in decided)
    return replace(
        result,
        grade=grade,
        statement=shortened(statement.decided_text(certificate.proof), full),
        statement_digest=shows[0][0],
        shows=shows,
        theorems=statement.theorems if shown else (),
        granted=statement.granted,
        rules=tuple(sorted(set(_rules(certificate)))),
    )


def decided_by(
    statement: Statement, proof: Proof, verdict: str, data: Any, where: str = ""
) -> Iterator[tuple[Any, str, str]]:
    """A statement and its parts, as data, that an accepted proof decides; the verdict, and which part."""
    yield data, verdict, where
    for k, part, own in statement.decided(proof):
        inner = f"{where}.{k + 1}" if where else f"part {k + 1}"
        yield from decided_by(part, own, verdict, data["parts"][k][1], inner)


def _rules(certificate: Certificate) -> Iterator[tuple[str, str]]:
    """The rule of the proof, and the kinds and rules inside it, each with the classes that it is of."""
    kind, by = type(certificate.statement), type(certificate.proof)
    yield f"{name_of(kind)} by {name_of(by)}", f"{_place(kind)} {_place(by)}"
    waiting: list[Any] = [*_values(certificate.statement), *_values(certificate.proof)]
    while waiting:
        value = waiting.pop()
        if isinstance(value, (Statement, Proof, Piece)):
            yield name_of(type(value)), _place(type(value))
        if is_dataclass(value):
            waiting += _values(value)
        elif isinstance(value, tuple) and not _is_expression(value):
            waiting += value


def _place(cls: type) -> str:
    return f"{cls.__module__}:{cls.__name__}"


def _is_expression(value: tuple[Any, ...]) -> bool:
    """Whether a tuple is an expression, or a pair of texts: no proofs or statements in it."""
    return value != () and isinstance(value[0], str) and not any(map(is_dataclass, value))


def _values(value: Any) -> list[Any]:
    return [getattr(value, field.name) for field in fields(value)]
