"""Conjunctions: a proof of every part, or a refutation of one."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields
from typing import Any

from lyapcheck.check.refusal import require
from lyapcheck.check.statement import Proof, Statement, Total
from lyapcheck.check.verify import Accepted, all_proved, rule, verify

ARM = {
    "mass": "M",
    "links": "M",
    "parameters": "range of parameters",
    "viscous": "B",
    "dry": "dry friction",
    "gravity": "g",
    "potential": "potential",
    "fall": "free fall",
}
"""What fields of these names say of which arm a statement is about; links stand for M."""


def arm_of(statement: Any) -> Iterator[tuple[str, object]]:
    """Which arm a statement is about, as data by name.

    g is only what has an entry for each of two or more joints: one torque, and a Hessian, are called so too.
    Nothing is said by fields that a statement calls ``unused``, as it gives its arm in another way.
    """
    if isinstance(statement, AllOf):
        for _, part in statement.parts:
            yield from arm_of(part)
        return
    for field in fields(statement):
        if field.name in getattr(statement, "unused", ()):
            continue
        value, fact = getattr(statement, field.name), ARM.get(field.name)
        if field.name in ("everywhere", "arm"):
            yield from arm_of(value)
        elif field.name == "joints" and isinstance(value, int):
            yield "number of joints", value
        elif fact == "B":
            yield fact, tuple(b if isinstance(b, tuple) else (b, b) for b in value)
        elif fact is not None and (fact != "g" or 1 < len(value) == statement.joints):
            yield fact, value
            if fact in ("M", "g"):
                yield "number of joints", len(value)


@dataclass(frozen=True)
class AllOf(Total):
    """Every part holds; each part has a name for the report."""

    parts: tuple[tuple[str, Statement], ...]

    def require_well_formed(self) -> None:
        require(len(self.parts) > 0, "parts", "none", "a conjunction needs at least one part")
        said: dict[str, tuple[str, object]] = {}
        for name, part in self.parts:
            part.require_well_formed()
            for fact, value in arm_of(part):
                before, other = said.setdefault(fact, (name, value))
                rule = f"has another {fact} than {before}: state what is about another arm by itself"
                require(value == other, "part", name, rule)

    @property
    def theorems(self) -> tuple[tuple[str, str], ...]:
        return tuple(pair for _, part in self.parts for pair in part.theorems)

    def decided(self, proof: Proof) -> Iterator[tuple[int, Statement, Proof]]:
        """All parts of what is proved, the one that is refuted."""
        one = [(proof.part, proof.proof)] if isinstance(proof, OnePart) else []
        for k, own in enumerate(proof.parts) if isinstance(proof, EveryPart) else one:
            yield k, self.parts[k][1], own

    def decided_text(self, proof: Proof) -> str:
        """Where one of several parts refutes the whole, that part first."""
        if not isinstance(proof, OnePart) or len(self.parts) == 1:
            return self.text()
        part = self.parts[proof.part][1].decided_text(proof.proof)
        return f"({proof.part + 1}) {part}, which is part of: {self.text()}"

    @property
    def granted(self) -> tuple[str, ...]:
        return tuple(dict.fromkeys(line for _, part in self.parts for line in part.granted))

    def text(self) -> str:
        """The parts by number; their names are the author's."""
        if len(self.parts) == 1:
            return self.parts[0][1].text()
        return "; ".join(f"({k}) {part.text()}" for k, (_, part) in enumerate(self.parts, 1))


@dataclass(frozen=True)
class EveryPart(Proof):
    """A proof of each part, in order."""

    rule = "every part"
    parts: tuple[Proof, ...]


@dataclass(frozen=True)
class OnePart(Proof):
    """A refutation of one part."""

    rule = "one part"
    part: int
    proof: Proof


@rule(AllOf, EveryPart)
def by_every_part(statement: AllOf, proof: EveryPart) -> Accepted:
    """Soundness: each part by its own proof."""
    return all_proved(statement.parts, proof.parts, "parts")


@rule(AllOf, OnePart)
def by_one_part(statement: AllOf, proof: OnePart) -> Accepted:
    """Soundness: one false part makes the whole false."""
    require(0 <= proof.part < len(statement.parts), "part", proof.part, "does not exist")
    name, part = statement.parts[proof.part]
    result = verify(part, proof.proof)
    require(result.verdict == "refuted", name, result.verdict, "must be refuted")
    return result
