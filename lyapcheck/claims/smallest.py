"""Small witnesses: a refuted claim again at as few joints as it fails for, with numbers of the task at hand.

A search that only wants a claim to fail ends at angles of fifty radians. Here the letters of a statement take
the values that they have for an arm and its gains, one error is moved, and few joints are taken.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import product
from math import sqrt
from typing import Any

from lyapcheck.certificate import Certificate
from lyapcheck.check.certificate import About
from lyapcheck.check.expressions.domain import Comparison
from lyapcheck.check.kinds.all_of import AllOf, OnePart
from lyapcheck.check.kinds.for_all import ForAll
from lyapcheck.check.kinds.implies import Implies
from lyapcheck.check.kinds.norm_bound import NormBound, vector_relation
from lyapcheck.check.kinds.norm_bound import entries as entries_of
from lyapcheck.check.statement import Proof, Relation, Statement, Variable
from lyapcheck.claims.fresh_check import judge_afresh
from lyapcheck.claims.handover import CaseData, Key, ScriptRequest
from lyapcheck.claims.procedures.implication import bound_of
from lyapcheck.claims.procedures.search import Point, first_refutation, witness_data, witness_of
from lyapcheck.claims.script import ask, find_script
from lyapcheck.claims.statements import Missing

ANGLES = tuple(
    map(Fraction, ("1", "1/2", "2", "1/4", "3/2", "3", "4/5", "4/3", "5/4", "9/10", "49/50", "1/8", "0"))
)
"""rad, none beyond π: the roundest first."""
SHARES = tuple(Fraction(k, 1000) for k in (500, 750, 900, 950, 980, 990, 995, 999))
"""Of the interval (18), in which a witness has its ε₀."""
FREE = ("e", "x", "eps0")
"""Letters that may be moved; all others stand at their values."""

Hand = Mapping[str, Sequence[Fraction]]
"""For each letter, without the number of its joint, the values to try."""


@dataclass(frozen=True)
class RefutedBelow:
    """A refuted statement with its witness, accepted by the checker.

    Args:
        id: of the claim.
        m: the member of the family, none if the claim does not depend on it.
        n: the number of joints.
        relation: what fails at the point.
        point: exact values of the letters.
        moved: the letter over which both sides are worth drawing.
        certificate: of the refutation.
        data: both sides between decimals, and the point as text.
    """

    id: str
    m: int | None
    n: int
    relation: Relation
    point: Point
    moved: str
    certificate: Certificate
    data: Mapping[str, Any]


def smallest_witnesses(
    script: str, wanted: Mapping[str, Sequence[int]], model: Any, gain_sets: Mapping[int, Any]
) -> dict[str, RefutedBelow]:
    """For each claim the fewest joints, and the roundest point, at which it fails.

    Args:
        script: the proof script.
        wanted: refuted claims, each with the m for which it is; without any it does not depend on m.
        model: the arm whose numbers the letters take; claims about an arm are about this one.
        gain_sets: the gains for each m.

    Returns:
        Those that a fresh checker accepts; a claim of which no such witness was found is left out.
    """
    if not wanted or not gain_sets:
        return {}
    path, joints = find_script(script), model.n
    cases: list[CaseData] = [
        (m, n, model if n == joints else None, gains)
        for n in range(1, joints + 1)
        for m, gains in sorted(gain_sets.items())
    ]
    handover = ask(ScriptRequest(str(path), path.name, tuple(cases), only=tuple(wanted)))
    result: dict[Key, RefutedBelow] = {}
    for claim in handover.claims:
        if claim.id not in wanted:
            continue
        for (m, n, _, gains), answer in zip(cases, claim.answers, strict=True):
            stated = handover.stated(answer)
            if isinstance(stated, Missing) or m not in (wanted[claim.id] or (m,)):
                continue
            about = About(claim.id, claim.says, m if "m" in answer.read else None, n, handover.name)
            if (witness := _smallest(stated, values_at_hand(m, n, model, gains), about)) is not None:
                result[claim.id, None] = witness
                break
    judged = judge_afresh({key: one.certificate for key, one in result.items()})
    return {key[0]: one for key, one in result.items() if judged[key].verdict == "refuted"}


def values_at_hand(m: int, n: int, model: Any, gains: Any) -> dict[str, list[Fraction]]:
    """The letters of bounds and gains, from an arm and its gains; ε₀ inside the interval (18).

    References: ``reyes2019family`` (16), (18).
    """
    from lyapcheck.claims.bounds import above
    from lyapcheck.claims.expressions import gamma, rho
    from lyapcheck.constants import robot_bounds

    bounds = robot_bounds(model)
    friction = [number.value for number in model.viscous]
    c = {
        "gamma": above(gamma(m)),
        "rho": above(rho(m)),
        "kp": min(gains.kp),
        "kv": max(gains.kv),
        "b": min(friction),
        "beta": rounded_up(bounds.beta_M),
        "kc": rounded_up(bounds.k_c),
    }
    root, largest = sqrt(n), max(friction)
    if c["kv"] * c["gamma"] * Fraction(root) >= c["b"]:  # (18) is empty: half of what (19) admits
        c["kv"] = Fraction(f"{float(c['b'] / c['gamma']) / root / 2:.2g}")
    g, r, kp, kv, b, beta, kc = map(float, c.values())
    flat, whole = root * g * float(largest) + n * r * g * kv, n * g * g * kp
    end = whole * (b - root * g * kv) / (whole * (beta * (r + g) + g * kc) + flat**2 / 4)
    inside = [Fraction(f"{float(share) * end:.4g}") for share in SHARES]
    most = max(gains.kp)
    return {
        **{name: [value] for name, value in c.items()},
        "more": [largest - c["b"]],
        "share": [Fraction(1)],
        "kp_min": [c["kp"]],
        "eps0": inside,
        "e": list(ANGLES),
        "x": list(ANGLES),
        "kp_of_joint": [*gains.kp, most],
        "kv_of_joint": list(gains.kv),
    }


def rounded_up(bound: Fraction) -> Fraction:
    """A bound to two decimal places, not below it."""
    return -(-bound * 100 // 1) / Fraction(100)


def _smallest(statement: Statement, hand: Hand, about: About) -> RefutedBelow | None:
    for inner, wrap in _parts(statement):
        for relation, known, points in _tries(inner, hand):
            failure = first_refutation(relation.comparison, points, known)
            if failure is not None:
                proof: Proof = witness_of(failure)
                for part in reversed(wrap):
                    proof = OnePart(part, proof)
                certificate = Certificate(about, statement, "refuted", "enclosure", proof)
                return RefutedBelow(
                    id=about.id,
                    m=about.m,
                    n=about.n or 1,
                    relation=relation,
                    point=failure[1],
                    moved=_moved(failure[1]),
                    certificate=certificate,
                    data=witness_data(failure),
                )
    return None


def _parts(statement: Statement) -> Iterator[tuple[Statement, list[int]]]:
    """The statement itself, or the parts of a conjunction, each with the way to it."""
    if isinstance(statement, AllOf):
        for k, (_, part) in enumerate(statement.parts):
            for inner, way in _parts(part):
                yield inner, [k, *way]
    else:
        yield statement, []


Try = tuple[Relation, list[Comparison], Iterator[Point]]


def _tries(statement: Statement, hand: Hand) -> Iterator[Try]:
    """What may fail, under which conditions, and where to look for that."""
    match statement:
        case Implies(variables, hypotheses, conclusion):
            known = [one.comparison for one in hypotheses]
            known += [bound_of(v) for v in variables if v.low is not None]
            yield conclusion, known, _points(variables, hand)
        case NormBound():
            first, *others = entries_of(statement)
            rest = dict.fromkeys(others, Fraction(0))
            yield vector_relation(statement), [], ({first: t, **rest} for t in hand["x"])
        case ForAll(relation):
            name, inside = statement.variable, statement.interval
            yield relation, [], ({name: t} for t in hand["x"] if t in inside)


def _points(variables: Sequence[Variable], hand: Hand) -> Iterator[Point]:
    """One joint is moved, the others rest: letters with numbers are those of the joints."""
    split = {v.name: _stem(v.name, hand) for v in variables}
    joints = sorted({number for stem, number in split.values() if stem == "e" and number}) or [""]
    for joint in joints:
        choices = [_choices(stem, number, joint, hand) for stem, number in split.values()]
        yield from (dict(zip(split, values, strict=True)) for values in product(*choices))


def _stem(name: str, hand: Hand) -> tuple[str, str]:
    """A letter without the number of its joint, and that number; ε₀ has none."""
    result = re.fullmatch(r"([a-z]+)([1-9]\d*)", name)
    return (result[1], result[2]) if result and name not in hand else (name, "")


def _choices(stem: str, number: str, moved: str, hand: Hand) -> Sequence[Fraction]:
    if not number:
        return hand.get(stem, (Fraction(1),))
    index = int(number) - 1
    if stem in ("kp", "kv") and index < len(hand["kv_of_joint"]):
        own = hand[f"{stem}_of_joint"][index]
        return (own, max(hand[f"{stem}_of_joint"])) if number == moved and stem == "kp" else (own,)
    return hand["e"] if stem == "e" and number == moved else (Fraction(0),)


def _moved(point: Point) -> str:
    """The letter that a drawing moves: an error that is not zero, else ε₀."""
    named = [name for name in point if name in FREE or name.rstrip("0123456789") in FREE]
    errors = [name for name in named if name != "eps0"]
    away = [name for name in errors if point[name]]
    return next(iter(away or errors or named), "")
