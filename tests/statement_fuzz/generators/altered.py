"""Certificates of the arena with something of the statement, or of the proof, put otherwise."""

import copy
import json
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from pathlib import Path
from types import SimpleNamespace

from lyapcheck.check.codec import from_json
from lyapcheck.check.refusal import Refused
from lyapcheck.check.statement import Proof, Statement, Witness
from lyapcheck.check.verify import verify
from lyapcheck.verdicts import Verdict
from tests.statement_fuzz.generators import Made, generates

GOOD = Path(__file__).parents[2] / "arena" / "good"
FACTORS = ("1001/1000", "999/1000", "101/100", "99/100", "2", "1/2", f"{10**30}", f"1/{10**30}")
MOST_CHANGES = 3
PLAIN = {
    "Identity",
    "ForAll",
    "Constant",
    "NormBound",
    "Implies",
    "ForSmall",
    "Agrees",
    "BoundEveryN",
    "EveryN",
}
LARGEST = 200_000
"""Characters: larger certificates take too long for their part."""


@dataclass(frozen=True)
class Altered:
    """A statement, and a proof of it or of another one like it; what is known is known of the statement."""

    statement: Statement
    proof: Proof

    def decide(self):
        """What the checker takes the proof to show; whatever goes wrong shows nothing."""
        verdict, reason = Verdict.UNDECIDED, ""
        try:
            self.statement.require_well_formed()
            verdict = Verdict(verify(self.statement, self.proof).verdict)
        except Exception as refusal:  # as ``check.certificate`` does
            reason = str(refusal)
        point = {name: str(value) for name, value in getattr(self.proof, "point", ())}
        witness = {"point": point} if isinstance(self.proof, Witness) else None
        return SimpleNamespace(verdict=verdict, method=self.proof.rule, reason=reason, witness=witness)


@lru_cache(maxsize=1)
def _texts():
    """Of each certificate that stands alone, and of theorems, which stand in folders with their premises."""
    read = {path: path.read_text(encoding="utf-8") for path in sorted(GOOD.rglob("*.json"))}
    own = (text for path, text in read.items() if path.parent == GOOD or '"Stable' in text)
    return tuple(text for text in own if len(text) <= LARGEST)


@generates("Planted", 2)
def planted(random):
    """A statement of the shipped proofs in which something was changed, to be decided anew."""
    while True:
        data = json.loads(random.choice(_texts()))["statement"]
        while data["kind"] == "AllOf":
            data = random.choice(data["parts"])[1]
        kind = data["kind"]
        if kind not in PLAIN:
            continue
        _change(random, data)
        try:
            statement = from_json(Statement, data, "statement")
            statement.require_well_formed()
        except (Refused, ValueError, TypeError):
            continue
        return Made(statement, f"planted in {kind}")


@generates("Altered", 0.001)
def altered(random):
    """The first of some alterations that still reads as a statement with a proof."""
    while True:
        data = json.loads(random.choice(_texts()))
        for _ in range(random.randint(1, MOST_CHANGES)):
            _change(random, data[random.choice(("statement", "statement", "proof"))])
        try:
            statement = from_json(Statement, data["statement"], "statement")
            return Made(
                Altered(statement, from_json(Proof, data["proof"], "proof")), data["statement"]["kind"]
            )
        except (Refused, ValueError, TypeError):
            continue


def _change(random, data):
    """One value or one list, in place."""
    values, lists = [], []
    for place, value in _places(data):
        (lists if isinstance(value, list) and value else values).append((place, value))
    if lists and random.random() < 0.3:
        _rearrange(random, random.choice(lists)[1], [entry for _, entry in lists])
        return
    place, value = random.choice(values)
    if place:
        whole = data
        for step in place[:-1]:
            whole = whole[step]
        whole[place[-1]] = _other(random, value, [text for _, text in values if isinstance(text, str)])


def _places(value, place=()):
    """All lists and values but objects."""
    if isinstance(value, dict):
        for key, part in value.items():
            yield from _places(part, (*place, key))
        return
    yield place, value
    for k, part in enumerate(value if isinstance(value, list) else ()):
        yield from _places(part, (*place, k))


def _other(random, value, texts):
    if isinstance(value, bool) or value is None:
        return random.choice((not value, "0", "1", None))
    if isinstance(value, int):
        return random.choice((value + 1, value - 1, 2 * value, -value, 0, 1, -1, 3))
    try:
        number = Fraction(value)
    except (TypeError, ValueError, ZeroDivisionError):
        return random.choice((*texts, "<", "<=", "0")) if isinstance(value, str) else value
    scaled = number * Fraction(random.choice(FACTORS))
    return str(random.choice((scaled, -number, 0, number + 1, number - 1)))


def _rearrange(random, entries, others):
    k, kind = random.randrange(len(entries)), random.random()
    if kind < 0.3:
        del entries[k]
    elif kind < 0.55:
        entries.insert(k, copy.deepcopy(entries[k]))
    elif kind < 0.8:
        other = random.randrange(len(entries))
        entries[k], entries[other] = entries[other], entries[k]
    else:
        entries[k] = copy.deepcopy(random.choice(others))
