"""Bounds of C(q, x) of random chains, beside the largest value met; proofs of them, and of others."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from random import Random

from lyapcheck.check.kinds.chain_coriolis import ChainCoriolisBelow, RateBounds
from lyapcheck.check.loop.chain import RigidLink
from lyapcheck.constants.storage.rates import rate_bounds
from tests.statement_fuzz.generators import FALSE, Made, generates
from tests.statement_fuzz.generators.proposed import bent, link
from tests.statement_fuzz.oracle.chains import largest
from tests.statement_fuzz.proposed import ByRates

F = Fraction
Links = tuple[RigidLink, ...]
BESIDE = (F(1, 2), F(9, 10), F(99, 100), F(999, 1000), F(1001, 1000), F(101, 100), F(11, 10), F(3, 2), F(4))
MARGIN = 1e-6
NO_BOUNDS = RateBounds((), (), ())


def _links(random: Random) -> Links:
    return tuple(link(random) for _ in range(random.choices((2, 3, 4), (6, 3, 1))[0]))


def _beside(random: Random, links: Links) -> tuple[Fraction, str | None]:
    """A bound near what is reached, and that it is false where it is less."""
    reached, by = largest(links, random)[0], random.choice(BESIDE)
    return F(f"{reached:.6g}") * by, FALSE if by < 1 and reached > MARGIN else None


@generates("ChainCoriolisBelow", 0.003)
def coriolis_below(random: Random) -> Made:
    """A bound a little or far above or below the largest value met."""
    links = _links(random)
    high, truth = _beside(random, links)
    return Made(ChainCoriolisBelow(links, high), "below what was met" if truth else "beside it", truth)


@generates("ByRates", 0.01)
def by_rates(random: Random) -> Made:
    """Rates of M for a bound that is right or wrong, or for the best one, with the statement changed."""
    links = _links(random)
    found = rate_bounds(links) or NO_BOUNDS
    if random.random() < 0.5:
        high, truth = _beside(random, links)
        return Made(ByRates(ChainCoriolisBelow(links, high), bent(random, found)), "for this bound", truth)
    changed, what = _changed(random, ChainCoriolisBelow(links, found.reached))
    return Made(ByRates(changed, bent(random, found)), what)


def _changed(random: Random, one: ChainCoriolisBelow) -> tuple[ChainCoriolisBelow, str]:
    what = random.choice(("as it is", "another bound", "another first body", "another body", "another joint"))
    k = random.randrange(1, len(one.links))
    old, new = one.links[k], link(random)
    if what == "another bound":
        return replace(one, high=one.high * random.choice(BESIDE)), what
    if what == "another first body":  # which turns about a fixed axis: C is the same
        first = replace(one.links[0], mass=new.mass, com=new.com, inertia=new.inertia)
        return replace(one, links=(first, *one.links[1:])), what
    if what == "another body":
        other = replace(old, mass=new.mass, com=new.com, inertia=new.inertia)
    elif what == "another joint":
        other = replace(old, axis=new.axis, origin=new.origin, turn=new.turn)
    else:
        return one, what
    return replace(one, links=(*one.links[:k], other, *one.links[k + 1 :])), what
