"""One certificate as a JSON document: a claim, its statement, the verdict and the proof, under a digest.

    {"schema", "claim": {"id", "says", "m", "n", "proof"}, "statement": {"kind", …}, "verdict", "grade",
     "proof": {"rule", …}, "uses": {claim id: digest of its certificate}, "versions", "digest"}

The digest is the SHA-256 of the document without it, as JSON with sorted keys and no spaces, in UTF-8. So a
certificate fixes, through the digests under ``uses``, all that it rests on.
"""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, fields, is_dataclass, replace
from json import JSONDecodeError
from typing import Any, NoReturn

from lyapcheck.check.codec import from_json, is_text, name_of, require_keys
from lyapcheck.check.expressions.grammar import MAX_NAME
from lyapcheck.check.judgement import MAX_BYTES, MAX_NESTING, Judgement, shortened
from lyapcheck.check.refusal import Refused, plain, require
from lyapcheck.check.statement import Piece, Proof, Statement
from lyapcheck.check.verify import Accepted, verify

SCHEMA = "lyapcheck/certificate/1"
MAX_INTEGER = 20
TOO_DEEP = f"is nested deeper than {MAX_NESTING} levels"
DIGEST = re.compile(r"[0-9a-f]{64}")


@dataclass(frozen=True)
class About:
    """The claim that a certificate is about: its id and words, its m and n, and the proof script."""

    id: str
    says: str
    m: int | None
    n: int | None
    proof: str


@dataclass(frozen=True)
class Certificate:
    """A claim with its statement, what is said to be shown, and the proof.

    ``uses`` gives, for each claim that this one rests on, the digest of its certificate; a refutation has
    none. ``grade`` is that of this step alone.
    """

    claim: About
    statement: Statement
    verdict: str
    grade: str
    proof: Proof
    uses: Mapping[str, str] = field(default_factory=dict)
    versions: Mapping[str, str] = field(default_factory=dict)


def canonical(value: Any) -> str:
    """JSON with sorted keys and no spaces."""
    return json.dumps(value, sort_keys=True, ensure_ascii=False, separators=(",", ":"))


def digest_of(content: Any) -> str:
    """The SHA-256 of the canonical JSON."""
    return digest_of_text(canonical(content))


def digest_of_text(text: str) -> str:
    """The SHA-256 of a text."""
    return hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()


def parse(text: str) -> Any:
    """The JSON value of a text, without floats, duplicate keys or endless integers.

    Raises:
        ValueError: the text is not JSON.
        Refused: it is, but of a kind that no certificate contains.
    """
    require(len(text) <= MAX_BYTES, "size", len(text), f"is above {MAX_BYTES} characters")
    try:
        value = json.loads(
            text,
            parse_float=_no_float,
            parse_constant=_no_float,
            parse_int=_integer,
            object_pairs_hook=_object,
        )
    except RecursionError:
        raise Refused("document", "", TOO_DEEP) from None
    # what is nested too deeply for all that follows; level by level, as this must not nest either
    level: list[Any] = [[value]]
    depth = 0
    while level:
        require(depth <= MAX_NESTING, "document", "", TOO_DEEP)
        whole = (part.values() if isinstance(part, dict) else part for part in level)
        level = [part for inner in whole for part in inner if isinstance(part, (dict, list))]
        depth += 1
    return value


def sealed(data: Any) -> dict[str, Any]:
    """What a document of this schema says beside its digest; refused if that is another one."""
    require(isinstance(data, dict), "document", data, "must be an object")
    require(data.get("schema") == SCHEMA, "schema", data.get("schema"), f"must be {SCHEMA}")
    content = {key: value for key, value in data.items() if key != "digest"}
    digest = data.get("digest")
    require(digest == digest_of(content), "digest", digest, "is not that of the content")
    return content


def read(data: Any) -> Certificate:
    """A certificate from its JSON value; refused if it is none. The proof in it is not judged."""
    content = sealed(data)
    require_keys(
        content, {"schema", "claim", "statement", "verdict", "grade", "proof", "uses", "versions"}, "document"
    )
    for digest in (uses := _texts(content["uses"], "uses")).values():
        require(DIGEST.fullmatch(digest) is not None, "uses", digest, "is not a digest")
    claim = from_json(About, content["claim"], "claim")
    for name in (claim.id, *uses):
        require(0 < len(name) <= MAX_NAME, "id of a claim", name, f"must have 1 to {MAX_NAME} characters")
    for name, count in (("m", claim.m), ("n", claim.n)):
        require(count is None or count >= 1, f"claim.{name}", count, "must be at least 1")
    return Certificate(
        claim,
        from_json(Statement, content["statement"], "statement"),
        from_json(str, content["verdict"], "verdict"),
        from_json(str, content["grade"], "grade"),
        from_json(Proof, content["proof"], "proof"),
        uses,
        _texts(content["versions"], "versions"),
    )


def judge(certificate: Certificate) -> Accepted:
    """What a certificate shows, given what it uses; refused if that is nothing, or not what it says."""
    accepted = verify(certificate.statement, certificate.proof)
    for name in ("verdict", "grade"):
        said, result = getattr(certificate, name), getattr(accepted, name)
        require(said == result, name, said, f"the proof gives {result}")
    if accepted.verdict == "refuted":
        require(not certificate.uses, "uses", ", ".join(certificate.uses), "a refutation rests on nothing")
    return accepted


def _texts(data: Any, where: str) -> dict[str, str]:
    require(isinstance(data, dict), where, data, "must be an object")
    for key in data:
        require(is_text(key), where, key, "is not plain Unicode text in NFC")
    return {key: from_json(str, value, f"{where}.{key}") for key, value in data.items()}


def _no_float(text: str) -> NoReturn:
    raise Refused("number", text, "must be an integer, or a fraction as text")


def _integer(text: str) -> int:
    require(len(text) <= MAX_INTEGER, "number", text, "is too long an integer; fractions are text")
    return int(text)


def _object(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    result = dict(pairs)
    require(len(result) == len(pairs), "object", ", ".join(key for key, _ in pairs), "has a key twice")
    return result


# --- One certificate from its bytes to what it shows by itself.


def certificate_of(content: bytes) -> tuple[Certificate, Any]:
    """A certificate from the bytes of a file, and its JSON value; refused if they are none."""
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
        claim = certificate.claim
        result = replace(
            result,
            claim=claim.id,
            label=plain(claim.id),
            says=shortened(" ".join(claim.says.split()).replace("”", "’’"), full),
            m=claim.m,
            n=claim.n,
            verdict=certificate.verdict,
            uses=dict(sorted(certificate.uses.items())),
        )
        grade = judge(certificate).grade
        statement, proof, verdict = certificate.statement, certificate.proof, certificate.verdict
        decided = decided_by(statement, proof, verdict, data["statement"])
        shows = tuple((digest_of(part), said, where) for part, said, where in decided)
        return replace(
            result,
            grade=grade,
            statement=shortened(statement.decided_text(proof), full),
            statement_digest=shows[0][0],
            shows=shows,
            theorems=statement.theorems if verdict == "proved" else (),
            granted=statement.granted,
            rules=tuple(sorted(set(_rules(certificate)))),
        )
    except (UnicodeDecodeError, JSONDecodeError) as error:
        return replace(result.refused(f"is not JSON in UTF-8 ({error})"), unreadable=True)
    except Refused as refusal:
        return result.refused(str(refusal))
    except Exception as error:
        return result.refused(f"cannot be judged ({type(error).__name__}: {error})")


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
        elif isinstance(value, tuple) and not (
            value and isinstance(value[0], str) and not any(map(is_dataclass, value))
        ):  # an expression, or a pair of texts, has no proofs or statements in it
            waiting += value


def _place(cls: type) -> str:
    return f"{cls.__module__}:{cls.__name__}"


def _values(value: Any) -> list[Any]:
    return [getattr(value, field.name) for field in fields(value)]
