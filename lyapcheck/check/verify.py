"""The one judge: whether a proof shows that a statement is true or false."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from typing import Any, TypeVar

from flint import ctx

from lyapcheck.check.refusal import Refused
from lyapcheck.check.statement import Proof, Statement

BITS = 128
GRADES = ("enclosure", "exact")
"""From the weaker to the stronger."""


@dataclass(frozen=True)
class Accepted:
    """What a proof shows: ``proved`` or ``refuted``, by ``exact`` arithmetic or an ``enclosure``."""

    verdict: str
    grade: str


Rule = Callable[[Any, Any], Accepted]
RULES: dict[tuple[type[Statement], type[Proof]], Rule] = {}
DOUBTS: dict[type[Statement], Callable[[Any], None]] = {}
"""What looks for faults of the checker in what it is about to prove: it can refuse, and accept nothing."""
_SHOWN: ContextVar[dict[tuple[Statement, Proof], Accepted] | None] = ContextVar("shown", default=None)
S = TypeVar("S", bound=Statement)
P = TypeVar("P", bound=Proof)


def rule(kind: type[S], by: type[P]) -> Callable[[Callable[[S, P], Accepted]], Callable[[S, P], Accepted]]:
    """Enter a function as the rule by which one class of proofs decides one kind of statement."""

    def enter(judge: Callable[[S, P], Accepted]) -> Callable[[S, P], Accepted]:
        RULES[kind, by] = judge
        return judge

    return enter


def rule_for(kind: type[Statement], by: type[Proof]) -> Rule | None:
    """The rule by which proofs of one class decide a kind, or what it derives from."""
    known = RULES.get((kind, by))
    return known or next((RULES[base, by] for base in kind.__mro__ if (base, by) in RULES), None)


@contextmanager
def each_once() -> Iterator[None]:
    """Judge each pair of statement and proof once inside, also where others rest on it.

    Soundness: a verdict depends on the pair alone. Only for pairs that the codec has read: what a script
    derives from these classes may call itself equal to anything.
    """
    token = _SHOWN.set({})
    try:
        yield
    finally:
        _SHOWN.reset(token)


def verify(statement: Statement, proof: Proof) -> Accepted:
    """What a proof, which is untrusted data, shows about a statement; refused, with a reason, if nothing.

    Verdict and grade are recomputed, never taken from the proof.

    Soundness: rests on the functions entered with :func:`rule`, on the judgement that every term has a value
        (``expressions.defined``), and on nothing that searches. Whatever goes wrong inside them, an overflow
        or a division by zero included, is a refusal.
    """
    shown = _SHOWN.get()
    if shown is None:
        return _verified(statement, proof)
    if (statement, proof) not in shown:
        shown[statement, proof] = _verified(statement, proof)
    return shown[statement, proof]


def _verified(statement: Statement, proof: Proof) -> Accepted:
    try:
        statement.require_well_formed()
        judge = rule_for(type(statement), type(proof))
        if judge is None:
            kind = type(statement).__name__
            raise Refused("rule", proof.rule, f"is not a way to decide a statement of kind {kind}")
        with ctx.workprec(BITS):
            accepted = judge(statement, proof)
            if accepted.verdict == "proved":
                statement.require_defined()
                if type(statement) in DOUBTS:
                    DOUBTS[type(statement)](statement)
            return accepted
    except Refused:
        raise
    except Exception as error:
        raise Refused(
            "rule", proof.rule, f"cannot be carried out ({type(error).__name__}: {error})"
        ) from error


def require_proved(statement: Statement, proof: Proof, subject: str) -> str:
    """The grade of the proof of a statement that another one needs."""
    result = verify(statement, proof)
    if result.verdict != "proved":
        raise Refused(subject, result.verdict, "must be proved")
    return result.grade


def all_proved(named: Iterable[tuple[str, Statement]], proofs: Sequence[Proof], subject: str) -> Accepted:
    """What proofs of statements show together, one for each in order; refused if one is not proved."""
    wanted = list(named)
    if len(proofs) != len(wanted):
        raise Refused(subject, len(proofs), f"must be {len(wanted)}")
    pairs = zip(wanted, proofs, strict=True)
    return Accepted("proved", weakest([require_proved(one, own, name) for (name, one), own in pairs]))


def weakest(grades: Iterable[str]) -> str:
    """The weakest of some grades; exact for none."""
    return min(grades, key=GRADES.index, default=GRADES[-1])
