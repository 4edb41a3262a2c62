"""Bounds k_gi of gravity torques: those that a source states, and whether the arm's own model keeps them."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, fields, replace
from fractions import Fraction
from functools import lru_cache
from itertools import combinations, product
from typing import TYPE_CHECKING, Any

from lyapcheck.check.loop.chain import RigidLink, lever_bound
from lyapcheck.check.loop.field import size_of
from lyapcheck.check.numbers.harmonics import Uncertain, by_parameters
from lyapcheck.control.judgement import JudgedStatement, judged_statement, proves
from lyapcheck.files.decimals import decimal_text
from lyapcheck.robots.dynamics import FEW_JOINTS, Chain, TooManyTerms
from lyapcheck.robots.trig import to_terms

if TYPE_CHECKING:
    from lyapcheck.check.kinds.gravity import GravityBelow, Levers
    from lyapcheck.check.statement import Proof, Statement
    from lyapcheck.robots import RobotModel

Point = tuple[Fraction, ...]
FEW_POSTURES = 4
"""Up to so many joints all postures of quarter turns are looked at."""
FEW_LEVERS = 7
"""Up to so many joints each choice of moments along axes is tried."""
FINEST = 1e-7
DIGITS = 10**9


@dataclass(frozen=True)
class RefutedBound:
    """A stated bound that the arm itself breaks.

    Args:
        joint: from 0.
        bound: N·m, as it is stated.
        refuted: the checker's verdict on the bound, with the posture.
        reached: N·m, what gravity exerts there at least.
        own: whether the arm as its file gives it breaks it, and not only one in ranges supposed beside it.
    """

    joint: int
    bound: Fraction
    refuted: JudgedStatement
    reached: Fraction
    own: bool


@dataclass(frozen=True)
class Gravity:
    """The bounds to judge by, what there is to say of them, and the stated ones that are false."""

    bounds: tuple[Fraction, ...]
    notes: tuple[str, ...] = ()
    refuted: tuple[RefutedBound, ...] = ()


def computed_bounds(model: RobotModel) -> tuple[Fraction, ...]:
    """The smaller of two bounds: sizes of the harmonics of g_i, and for a chain masses and distances.

    Raises:
        TooManyTerms: no links are known, and g is too long to be written out.

    Soundness: of each the checker has a rule, ``HarmonicSizes`` and ``Levers``.
    """
    ranges = model.ranges
    known = None if (proofs := levers(model)) is None else [proof.bound(ranges) for proof in proofs]
    try:
        sizes = [size_of(torque_of(model, i), ranges) for i in range(model.n)]
    except TooManyTerms:
        if known is None:
            raise
        return tuple(known)
    return tuple(map(min, sizes, known or sizes))


@lru_cache(maxsize=64)
def levers(model: RobotModel) -> tuple[Levers, ...] | None:
    """Links that show a bound of each g_i; ``None`` where they are unknown, or more than masses uncertain."""
    from lyapcheck.check.kinds.gravity import Levers

    heavy = model.heaviest
    if heavy is None:
        return None
    dynamics = model.dynamics
    assert isinstance(dynamics, Chain)
    of = [{name: Fraction(int(name == one)) for name in model.parameters} for one in ("", *model.parameters)]
    none, *units = ([link.mass for link in dynamics.fixed(values).links] for values in of)
    shares = tuple(tuple(map(Fraction.__sub__, unit, none)) for unit in units)
    links = tuple(replace(link, mass=mass) for link, mass in zip(heavy.links, none, strict=True))
    return tuple(Levers(links, shares, heavy.fall, i, least_along(heavy, i)) for i in range(model.n))


def bounding(bound: Statement, model: RobotModel, i: int) -> Iterator[Proof]:
    """What may show a bound of |g_i|, i from 0: of g written out, or of the links."""
    from lyapcheck.check.kinds.chain import NoTorque, OwnLevers
    from lyapcheck.check.kinds.gravity import GravityBelow
    from lyapcheck.check.kinds.inertia import Bisection, HarmonicSizes

    known = (levers(model) or ())[i : i + 1]
    if isinstance(bound, GravityBelow):
        yield from (HarmonicSizes(), *known, *([Bisection()] if model.n <= FEW_JOINTS else []))
    else:
        yield from (NoTorque(), *(OwnLevers(one.along) for one in known))


def least_along(chain: Chain, i: int) -> tuple[int, ...]:
    """For which joints behind one `lever_bound` is least; beyond a few all or none."""
    rough, fall = (_rough(chain.links), _rough(chain.fall))
    behind = range(i + 1, chain.n)
    few = chain.n - i <= FEW_LEVERS
    choices = [(joint,) for joint in behind] if few else [tuple(behind)]
    subsets = (sum(some, ()) for k in range(len(choices) + 1) for some in combinations(choices, k))
    return min(subsets, key=lambda along: lever_bound(rough, fall, i, along, math.sqrt))


def _rough(part: Any) -> Any:
    """Links, vectors and numbers in floating point."""
    if isinstance(part, RigidLink):
        return replace(part, **{one.name: _rough(getattr(part, one.name)) for one in fields(part)})
    return tuple(map(_rough, part)) if isinstance(part, tuple) else float(part)


@lru_cache(maxsize=64)
def settled(model: RobotModel, stated: tuple[Fraction | None, ...], own: RobotModel) -> Gravity:
    """The stated bounds where the model keeps them for all of its ranges, and computed ones elsewhere.

    Args:
        model: the arm, with ranges that may be supposed beside those of its file.
        stated: bounds in N·m; ``None`` where nobody states one.
        own: the arm as its file gives it.

    Soundness: a stated bound counts where a computed one is not above it, or ``lyapcheck.check.verify``
        proves it.
    """
    from lyapcheck.check.kinds.inertia import Bisection

    bounds: list[Fraction] = []
    notes: list[str] = []
    refuted: list[RefutedBound] = []
    for i, (bound, most) in enumerate(zip(stated, computed_bounds(model), strict=True)):
        if bound is None or bound >= most:
            bounds.append(most if bound is None else bound)
            continue
        why = "is not shown to be kept by the arm"
        try:
            at = exceeded(model, i, bound)
            its_own = at if own is model or at is None else exceeded(own, i, bound)
            few = model.n <= FEW_JOINTS
            kept = at is None and few and proves(_statement(model, i, bound), Bisection())
        except TooManyTerms:
            at, its_own, kept = None, None, False
        if its_own is not None:
            refuted.append(RefutedBound(i, bound, *its_own, True))
            why = "is refuted by the arm's own model"
        elif at is not None:
            refuted.append(RefutedBound(i, bound, *at, False))
            why = "is kept by the arm of the file, not over its ranges"
        bounds.append(bound if kept else most)
        if not kept:
            used = f"{decimal_text(most)} N·m from the model is used"
            notes.append(f"gravity bound of {model.joints[i]} = {decimal_text(bound)} N·m {why}: {used}")
    return Gravity(tuple(bounds), tuple(notes), tuple(refuted))


@lru_cache(maxsize=64)
def torque_of(model: RobotModel, i: int) -> Uncertain:
    """g_i as harmonics, by the powers of the parameters."""
    return by_parameters(to_terms(model.gravity[i]), model.n)


def _statement(model: RobotModel, i: int, bound: Fraction) -> GravityBelow:
    from lyapcheck.check.kinds.gravity import GravityBelow

    return GravityBelow(model.n, (tuple(to_terms(model.gravity[i])),), model.ranges, bound)


def exceeded(model: RobotModel, i: int, bound: Fraction) -> tuple[JudgedStatement, Fraction] | None:
    """A posture at which the checker finds gravity above a bound, with what it exerts there at least."""
    from lyapcheck.check.kinds.inertia import PostureWitness
    from lyapcheck.check.numbers.polynomials import Enclosure

    statement = _statement(model, i, bound)
    for turns, parameters in steep_postures(model, i):
        q = tuple(Fraction(round(float(x) * math.pi / 2 * DIGITS), DIGITS) for x in turns)
        its = judged_statement(statement, [PostureWitness(q, parameters, ())])
        if its.shown == "refuted":
            return its, Enclosure.from_arb(abs(statement.at(q, parameters)[0])).lower
    return None


def steep_postures(model: RobotModel, i: int) -> Iterator[tuple[Point, Point]]:
    """Postures in quarters of a turn, with parameters, at which |g_i| is about largest; only proposed."""
    parts = [
        (powers, [(k, float(a), float(b)) for k, (a, b) in terms.items()])
        for powers, terms in torque_of(model, i).items()
    ]
    ends = [number.bounds for number in model.parameters.values()]

    def size(place: Sequence[float]) -> float:
        total = 0.0
        for powers, terms in parts:
            scale = math.prod(
                float(pair[int(place[model.n + k])]) ** power
                for k, (pair, power) in enumerate(zip(ends, powers, strict=True))
            )
            for k, a, b in terms:
                angle = math.pi / 2 * sum(f * x for f, x in zip(k, place, strict=False))
                total += scale * (a * math.cos(angle) + b * math.sin(angle))
        return abs(total)

    choices = [(0.0, 1.0, 2.0, 3.0)] * model.n + [(1.0, 0.0)] * len(ends)
    start = [0.0] * model.n + [1.0] * len(ends)
    if model.n <= FEW_POSTURES and len(ends) <= FEW_POSTURES:
        start = max(map(list, product(*choices)), key=size)
    quarter = _climbed(start, size, lambda x, k: choices[k])
    best, step = quarter, 0.5
    while step > FINEST:

        def near(x: float, k: int, step: float = step) -> Sequence[float]:
            return (x + step, x - step) if k < model.n else choices[k]

        finer = _climbed(best, size, near)
        step, best = (step / 2 if finer == best else step), finer
    for place in (quarter, best):
        turns = tuple(Fraction(round(x * DIGITS), DIGITS) for x in place[: model.n])
        yield turns, tuple(pair[int(end)] for pair, end in zip(ends, place[model.n :], strict=True))


def _climbed(
    place: list[float],
    size: Callable[[Sequence[float]], float],
    choices: Callable[[float, int], Sequence[float]],
) -> list[float]:
    """One coordinate after the other at its best of some choices, until none is better."""
    best, reached = place, size(place)
    for _ in range(50):
        before = reached
        for k in range(len(best)):
            for x in choices(best[k], k):
                tried = [*best[:k], x, *best[k + 1 :]]
                value = size(tried)
                if value > reached * (1 + 1e-12):
                    best, reached = tried, value
        if reached == before:
            break
    return best
