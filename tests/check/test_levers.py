"""Bounds of gravity by masses and distances, on random chains, against an optimiser with code of its own."""

from dataclasses import replace
from fractions import Fraction as F
from itertools import chain as joined
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest

from lyapcheck.answers.gate.promises import shown_gravity
from lyapcheck.check.kinds.chain import ChainGravityBelow, OwnLevers
from lyapcheck.check.kinds.gravity import GravityBelow, Levers
from lyapcheck.check.loop.chain import RigidLink
from lyapcheck.control.limits import arm_limits
from lyapcheck.robots.dynamics import Chain, ParameterShare
from lyapcheck.robots.trig import to_terms
from tests.helpers.shares import one_in
from tests.helpers.stated import outcome
from tests.oracle.bounds import Bound

EXAMPLES = Path(__file__).parents[2] / "examples"
RANGE = (F(-1, 2), F(3, 2))
"""Of a mass at the last link; a bound of a polynomial need not ask whether one may be negative."""
NEAR = F(1, 10**6)


def turned(random):
    """A rotation with rational entries, of a quaternion with whole numbers."""
    a, b, c, d = (int(x) for x in random.integers(-3, 4, 4) + np.array([5, 0, 0, 0]))
    rows = (
        (a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (b * d + a * c)),
        (2 * (b * c + a * d), a * a - b * b + c * c - d * d, 2 * (c * d - a * b)),
        (2 * (b * d - a * c), 2 * (c * d + a * b), a * a - b * b - c * c + d * d),
    )
    return tuple(tuple(F(x, a * a + b * b + c * c + d * d) for x in row) for row in rows)


def vector(random):
    return tuple(F(int(x), 10) for x in random.integers(-9, 10, 3))


def drawn(seed):
    """Up to three links with axes anywhere, and free fall."""
    random = np.random.default_rng(seed)
    links = (
        RigidLink(turned(random)[0], vector(random), F(int(random.integers(0, 9)), 4), vector(random),
                  ((F(0),) * 3,) * 3, turned(random))
        for _ in range(1 + seed % 3)
    )  # fmt: skip
    return tuple(links), vector(random)


def choices(n):
    return joined.from_iterable(combinations(range(n), k) for k in range(n + 1))


@pytest.mark.parametrize("seed", one_in(4, range(12)))
def test_no_state_pulls_harder_and_what_one_reaches_is_no_bound(seed):
    links, fall = drawn(seed)
    n, i = len(links), seed // 3 % len(links)
    shares = (tuple(F(int(k == n - 1)) for k in range(n)),)
    last = replace(links[-1], mass=ParameterShare("load"))
    torque = Chain((*links[:-1], last), fall, ("load",)).polynomials.gravity[i]
    empty = (*links[:-1], replace(links[-1], mass=F(0)))
    polynomial = GravityBelow(n, (tuple(to_terms(torque)),), (RANGE,), F(0))
    exact = ChainGravityBelow(links, fall, (i + 1,), F(0))
    ways = [(Levers(empty, shares, fall, i, k), Levers(links, (), fall, i, k)) for k in choices(n)]
    loaded = [(ranged, ranged.bound([RANGE])) for ranged, _ in ways]
    alone = [(OwnLevers(one.along), one.bound(())) for _, one in ways]
    for statement, proofs in ((polynomial, loaded), (exact, alone)):
        seen = Bound(statement)
        reached = F(float(np.sqrt(max(seen.excess(seen.hunt(seed)), 0.0))))
        for proof, bound in proofs:
            assert outcome(replace(statement, high=bound), proof) == "proved"
            assert reached <= bound * (1 + NEAR) + NEAR
            smaller = replace(statement, high=reached * (1 - NEAR))
            assert reached < NEAR or outcome(smaller, proof) != "proved"


@pytest.mark.parametrize("name", one_in(4, ["xarm6", "panda", "iiwa14", "px100", "px150", "ur5"]))
def test_each_arm_that_comes_along_has_its_bounds_shown(name):
    limits = arm_limits(str(EXAMPLES / f"{name}.toml"))
    shown = shown_gravity(limits.model, limits.gravity)
    assert shown.shown == "proved"
    assert [part.high for _, part in shown.statement.parts[1:]] == list(limits.gravity)
