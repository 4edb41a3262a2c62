"""Proofs by corners, by links and by a larger K_v: of statements, and of what became of them.

A statement is made at the largest ε₀ for which a proof is found, so that what is a little more is false. Then
statement, proof or both are changed at random.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import fields, is_dataclass, replace
from fractions import Fraction
from random import Random
from typing import Any

from lyapcheck.check.kinds.at_corners import MassAtCorners
from lyapcheck.check.kinds.decreasing import (
    BoxTree,
    Decreasing,
    LargerKv,
    PositiveAndDecreasing,
)
from lyapcheck.check.kinds.inertia import Bisection, Links, MassAbove
from lyapcheck.check.loop.chain import RigidLink
from lyapcheck.check.loop.closed_loop import ClosedLoop
from lyapcheck.robots.dynamics import Chain
from lyapcheck.robots.trig import to_terms
from lyapcheck.search.branch_and_bound import certify
from lyapcheck.search.error_boxes import ErrorBoxes
from lyapcheck.search.link_bounds import bounds_along
from lyapcheck.search.schur import SchurProblem
from tests.statement_fuzz.generators import Made, generates
from tests.statement_fuzz.generators.controlled import FAMILIES, friction, gains
from tests.statement_fuzz.generators.robots import Ranges, powers, robot, size
from tests.statement_fuzz.oracle.arm import Rows
from tests.statement_fuzz.oracle.arms import least_eigenvalue, start
from tests.statement_fuzz.oracle.climb import climbed
from tests.statement_fuzz.proposed import ByLargerKv, ByLinks, ByMassAtCorners

F = Fraction
MAX_BOXES = 300
SHARES = (F(4), F(1), F(1, 4), F(1, 20))
HALVINGS = 4
FACTORS = (F(1001, 1000), F(101, 100), F(101, 100), F(21, 20), F(21, 20), F(6, 5), F(3, 2), F(4), F(100))
AXES = ((F(0), F(0), F(1)), (F(1), F(0), F(0)), (F(3, 5), F(0), F(4, 5)))
TURNS = (
    ((F(1), F(0), F(0)), (F(0), F(1), F(0)), (F(0), F(0), F(1))),
    ((F(1), F(0), F(0)), (F(0), F(0), F(-1)), (F(0), F(1), F(0))),
)
NEAR = (F(9, 10), F(99, 100), F(999, 1000), F(1), F(1001, 1000), F(101, 100), F(11, 10))
NO_PROOF = BoxTree(".")
Change = Callable[[Random, Decreasing], Decreasing]


def _stretched(values: tuple[Fraction, ...], by: Fraction) -> tuple[Fraction, ...]:
    return tuple(x * by for x in values)


def _wider(ranges: Ranges, by: Fraction) -> Ranges:
    return tuple((low / by, high * by) for low, high in ranges)


CHANGES: dict[str, Change] = {
    "as it is": lambda random, one: one,
    "a larger ε₀": lambda random, one: replace(one, eps0=one.eps0 * random.choice(FACTORS)),
    "a smaller ε₀": lambda random, one: replace(one, eps0=one.eps0 / random.choice(FACTORS)),
    "softer": lambda random, one: replace(one, kp=_stretched(one.kp, 1 / random.choice(FACTORS))),
    "less friction": lambda random, one: replace(
        one, viscous=tuple((low / random.choice(FACTORS), high) for low, high in one.viscous)
    ),
    "more friction": lambda random, one: replace(
        one, viscous=tuple((low, high * random.choice(FACTORS)) for low, high in one.viscous)
    ),
    "more damping": lambda random, one: replace(one, kv=_stretched(one.kv, random.choice(FACTORS))),
    "less damping": lambda random, one: replace(one, kv=_stretched(one.kv, 1 / random.choice(FACTORS))),
    "wider ranges": lambda random, one: replace(
        one, parameters=_wider(one.parameters, random.choice(FACTORS))
    ),
    "another function": lambda random, one: replace(
        one, **dict(zip(("family", "m"), random.choice(FAMILIES), strict=True))
    ),
}


def _changed(random: Random, one: Decreasing) -> tuple[Decreasing, str]:
    name = random.choice(list(CHANGES))
    return CHANGES[name](random, one), name


def _arm(random: Random) -> Rows:
    """M ≻ 0 of one joint, now and then of two."""
    return robot(random, 1 if random.random() < 0.9 else 2, True, plain=True).mass


def _ranged(random: Random, mass: Rows) -> tuple[Rows, Ranges]:
    """M times a parameter, which now and then is squared."""
    power = 2 if random.random() < 0.1 else 1
    low = F(random.choice((1, 2, 3)), 2)
    rows = tuple(tuple(tuple(((*p, power), c) for p, c in entry) for entry in row) for row in mass)
    return rows, ((low, low * random.choice((F(1), F(5, 4), F(2)))),)


def _about(random: Random, mass: Rows, parameters: Ranges) -> Decreasing:
    """Gains and friction of an arm, at an ε₀ of natural size."""
    n = len(mass)
    viscous, kp, kv = friction(random, n), gains(random, n), gains(random, n)
    heaviest = max(sum((size(entry, parameters) for entry in row), F(0)) for row in mass)
    eps0 = min(b for b, _ in viscous) / (heaviest + max(b for _, b in viscous) + max(kv))
    family, m = random.choice(FAMILIES)
    return Decreasing(mass, viscous, parameters, family, m, kp, kv, eps0, ())


def _highest(one: Decreasing, found: Callable[[Decreasing], Any]) -> tuple[Decreasing, Any]:
    """With a proof near the largest ε₀ at which there is one, if there is one."""
    high, best, proof = F(8) * one.eps0, one, None
    for share in SHARES:
        tried = replace(one, eps0=one.eps0 * share)
        proof = found(tried)
        if proof is not None:
            best = tried
            break
        high = tried.eps0
    for _ in range(HALVINGS if proof is not None else 0):
        tried = replace(one, eps0=(best.eps0 + high) / 2)
        higher = found(tried)
        if higher is None:
            high = tried.eps0
        else:
            best, proof = tried, higher
    return best, proof


def bent(random: Random, proof: Any) -> Any:
    """The proof, now and then with one of its numbers a little or far from what it was, or 0."""
    places = list(_numbers(proof))
    if not places or random.random() < 0.5:
        return proof
    place = random.choice(places)
    by = random.choice((*FACTORS, *(1 / x for x in FACTORS), F(0), F(-1)))
    return _with_number(proof, place, by)


def _numbers(value: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Where in a proof there are fractions."""
    if isinstance(value, Fraction):
        yield path
    elif is_dataclass(value):
        for field in fields(value):
            yield from _numbers(getattr(value, field.name), (*path, field.name))
    elif isinstance(value, tuple):
        for k, part in enumerate(value):
            yield from _numbers(part, (*path, k))


def _with_number(value: Any, path: tuple[Any, ...], by: Fraction) -> Any:
    """The value with the number at a place times a factor."""
    if not path:
        return value * by
    head, *rest = path
    if isinstance(value, tuple):
        return (*value[:head], _with_number(value[head], tuple(rest), by), *value[head + 1 :])
    return replace(value, **{head: _with_number(getattr(value, head), tuple(rest), by)})


def _tree(loop: ClosedLoop) -> BoxTree | None:
    outcome = certify(SchurProblem(loop), MAX_BOXES) if loop.admissible else None
    return BoxTree(outcome.tree) if outcome is not None and outcome.proved else None


def _boxes(one: Decreasing) -> BoxTree | None:
    return _tree(one.closed_loop)


@generates("ByMassAtCorners", 0.005)
def by_mass_at_corners(random: Random) -> Made:
    """M ≻ low·I over a range, by boxes at its ends."""
    mass, parameters = _ranged(random, robot(random, 1, plain=True).mass)
    if random.random() < 0.5:
        low, high = parameters[0]
        parameters = ((low - random.choice((1, 2)), high),)
    shift = (powers(len(mass), 1), -F(random.choice((1, 1, 2)), random.choice((1, 4, 10))))
    rows = tuple(
        tuple((*entry, shift) if i == j and random.random() < 0.4 else entry for j, entry in enumerate(row))
        for i, row in enumerate(mass)
    )
    low = _least(rows, parameters) * random.choice(NEAR) if random.random() < 0.7 else F(0)
    count = 2 if random.random() < 0.9 else 1
    proof = MassAtCorners((Bisection(),) * (count if parameters[0][0] < parameters[0][1] else 1))
    return Made(ByMassAtCorners(MassAbove(rows, parameters, low), proof), "a range of M")


@generates("ByLargerKv", 0.03)
def by_larger_kv(random: Random) -> Made:
    """dV/dt < 0 by a proof for another K_v, of which no entry need be larger."""
    one = _about(random, _arm(random), ())
    one, rate = _highest(one, _boxes)
    of = PositiveAndDecreasing(Bisection(), rate or NO_PROOF)
    proof = LargerKv(one.kv, of)
    changed, what = _changed(random, one)
    if random.random() < 0.2:
        changed, what = replace(changed, kv=_stretched(changed.kv, F(-1))), "damping that drives"
    return Made(ByLargerKv(changed, bent(random, proof)), what)


def link(random: Random) -> RigidLink:
    def some() -> Fraction:
        return F(random.choice((-2, -1, 0, 0, 1, 3)), random.choice((2, 5, 10)))

    moments = [F(random.choice((1, 2, 5)), 20) for _ in range(3)]
    inertia = tuple(tuple(moments[i] if i == j else F(0) for j in range(3)) for i in range(3))
    place, com = ((some(), some(), some()) for _ in range(2))
    return RigidLink(
        random.choice(AXES), place, F(random.choice((1, 2, 3)), 2), com, inertia, random.choice(TURNS)
    )


def _mass_of(links: tuple[RigidLink, ...]) -> Rows:
    chain = Chain(links, (F(0), F(0), F(0)))
    return tuple(tuple(tuple(to_terms(entry)) for entry in row) for row in chain.polynomials.mass)


@generates("ByLinks", 0.005)
def by_links(random: Random) -> Made:
    """dV/dt < 0 of two links, the last of which may have a range of masses."""
    links = (link(random), link(random))
    loaded = (links[0], replace(links[1], mass=links[1].mass * random.choice((1, 2))))
    arms = (links,) if loaded == links else (links, loaded)
    light, heavy = _mass_of(links), _mass_of(loaded)
    mass, parameters = light, ()
    if len(arms) == 2:
        parameters = ((F(0), F(1)),)
        mass = tuple(
            tuple(
                (*(((*p, 0), c) for p, c in a), *(((*p, 1), -c) for p, c in a), *(((*p, 1), c) for p, c in b))
                for a, b in zip(*rows, strict=True)
            )
            for rows in zip(light, heavy, strict=True)
        )
    one = _about(random, mass, parameters)
    low = tuple(b for b, _ in one.viscous)
    bounds = bounds_along(tuple(Chain(arm, (F(0), F(0), F(1))) for arm in arms), low)

    def linked(tried: Decreasing) -> Any:
        loop = tried.closed_loop
        if bounds is None or not loop.admissible:
            return None
        covered = ErrorBoxes(loop, bounds).covered(MAX_BOXES)
        return replace(bounds, tree=covered.tree, scales=covered.scales) if covered.proved else None

    one, rate = _highest(replace(one, eps0=4 * one.eps0), linked)
    changed, what = _changed(random, one)
    positive = Links(links) if len(arms) == 1 else MassAtCorners(tuple(map(Links, arms)))
    proof = PositiveAndDecreasing(positive, rate or NO_PROOF)
    return Made(ByLinks(changed, bent(random, proof)), what)


def _least(mass: Rows, parameters: Ranges) -> Fraction:
    """The least eigenvalue of M that a search meets, from above."""
    best, _ = climbed(
        lambda z: -least_eigenvalue(mass, parameters, z), start(len(mass), len(parameters)), Random(0)
    )
    return F(-best).limit_denominator(10**6)
