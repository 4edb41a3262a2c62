"""Certificates as they are written; reading and judging them is for ``lyapcheck.check.certificate``."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, is_dataclass
from fractions import Fraction
from functools import cache, cached_property
from typing import Any

from lyapcheck.check import certificate as read
from lyapcheck.check.certificate import SCHEMA, canonical, digest_of_text
from lyapcheck.check.codec import TAGS, left_out, name_of


@cache
def made_with() -> dict[str, str]:
    """What the certificates of this process are made with."""
    from importlib.metadata import version  # loads what reads mail, which the gate can do without

    return {name: version(name) for name in ("lyapcheck", "python-flint")}


@dataclass(frozen=True)
class Certificate(read.Certificate):
    """A certificate that can be written, with its digest; of the versions in use, unless others are given."""

    versions: Mapping[str, str] = field(default_factory=made_with)

    def __repr__(self) -> str:
        return f"<Certificate: {self.claim.id}, {self.verdict}>"

    @classmethod
    def of(cls, one: read.Certificate) -> Certificate:
        """The same as one that was read."""
        return cls(**{each.name: getattr(one, each.name) for each in fields(one)})

    def content(self) -> dict[str, Any]:
        """The document without its digest."""
        return {
            "schema": SCHEMA,
            "claim": to_json(self.claim),
            "statement": to_json(self.statement),
            "verdict": self.verdict,
            "grade": self.grade,
            "proof": to_json(self.proof),
            "uses": dict(self.uses),
            "versions": dict(self.versions),
        }

    @cached_property
    def _parts(self) -> dict[str, str]:
        """The document without its digest, part by part in canonical JSON."""
        return {key: canonical(part) for key, part in self.content().items()}

    @cached_property
    def digest(self) -> str:
        """The digest of the document."""
        whole = ",".join(f"{json.dumps(key)}:{self._parts[key]}" for key in sorted(self._parts))
        return digest_of_text(f"{{{whole}}}")

    def text(self) -> str:
        """The document as it is written to a file: the same bytes for the same certificate."""
        parts = {**self._parts, "digest": canonical(self.digest)}
        return "{\n" + ",\n".join(f"{json.dumps(key)}: {parts[key]}" for key in sorted(parts)) + "\n}\n"


def to_json(value: Any) -> Any:
    """Data as JSON values."""
    if isinstance(value, tuple):  # first: M(q) of seven joints has half a million entries
        return [to_json(part) for part in value]
    if isinstance(value, Fraction):
        return str(value)
    if is_dataclass(value) and not isinstance(value, type):
        usual, parts = left_out(type(value)), vars(value)
        own = {
            each.name: to_json(parts[each.name])
            for each in fields(value)
            if each.name not in usual or parts[each.name] != usual[each.name]
        }
        tag = next(({key: name_of(type(value))} for base, key in TAGS.items() if isinstance(value, base)), {})
        return tag | own
    return value
