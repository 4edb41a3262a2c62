"""Bounds of C(q, x) of random chains, beside the largest value met; forms for them, and for others."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from random import Random

from lyapcheck.check.kinds.chain_coriolis import ChainCoriolisBelow, MotionForms
from lyapcheck.check.loop.chain import RigidLink
from lyapcheck.constants.storage.motion import coriolis_forms
from lyapcheck.robots.dynamics import Chain
from tests.statement_fuzz.generators import FALSE, Made, generates
from tests.statement_fuzz.generators.proposed import bent, link
from tests.statement_fuzz.oracle.chains import largest
from tests.statement_fuzz.proposed import ByMotion

F = Fraction
Links = tuple[RigidLink, ...]
BESIDE = (F(1, 2), F(9, 10), F(99, 100), F(999, 1000), F(1001, 1000), F(101, 100), F(11, 10), F(3, 2), F(4))
MARGIN = 1e-6
NO_FORMS = MotionForms(F(1), (), (), (), ())


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


@generates("ByMotion", 0.01)
def by_motion(random: Random) -> Made:
    """Forms for the bound that is stated, right or wrong, or the best ones, with the statement changed."""
    links = _links(random)
    chain = Chain(links, (F(0), F(0), F(0)))
    if random.random() < 0.5:
        high, truth = _beside(random, links)
        found = coriolis_forms(chain, MARGIN, lambda least: high)
        forms = bent(random, found or NO_FORMS)
        return Made(ByMotion(ChainCoriolisBelow(links, high), forms), "forms for this bound", truth)
    # as the proposer rounds its bound: not below what forms can show
    found = coriolis_forms(chain, MARGIN, lambda least: F(f"{float(least) * (1 + 1e-5):.6g}"))
    forms = found or NO_FORMS
    statement = ChainCoriolisBelow(links, forms.kappa)
    changed, what = _changed(random, statement)
    kept = replace(forms, kappa=random.choice((forms.kappa, changed.high)))
    return Made(ByMotion(changed, bent(random, kept)), what)


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
