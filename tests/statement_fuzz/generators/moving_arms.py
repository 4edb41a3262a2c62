"""Laws of M(q), C(q, w) and g(q): with Christoffel symbols, C printed right or wrong, and a potential."""

from __future__ import annotations

from fractions import Fraction
from functools import partial
from random import Random
from typing import Any

from tests.statement_fuzz.generators import FALSE, TRUE, Made, generates
from tests.statement_fuzz.generators.robots import (
    Robot,
    coefficient,
    harmonics,
    powers,
    ranges,
    robot,
    scaled,
)
from tests.statement_fuzz.oracle.arm import Terms, derivative
from tests.statement_fuzz.subject import (
    CoriolisAtRest,
    CoriolisTorque,
    GravityOfPotential,
    MassSymmetric,
    RateLessTwiceCoriolis,
    RateOfMass,
)

Printed = list[list[list[Terms]]]
"""For each entry of C what w1 … wn multiply, then what has no rate."""


@generates("MassSymmetric", 0.6)
def symmetric(random: Random) -> Made:
    """M = Mᵀ, written in other terms, or with one term more on one side."""
    arm = robot(random, n=2)
    other, truth = arm.mass[1][0], TRUE
    if random.random() < 0.5:
        other, truth = _changed(random, arm, other), FALSE
    mass = (arm.mass[0], (_rewritten(random, other, arm.n), arm.mass[1][1]))
    return Made(MassSymmetric(mass, arm.parameters), "symmetry", truth)


def _one(random: Random, arm: Robot) -> Terms:
    """One product of sines and cosines."""
    result: Terms = ()
    while not result:
        result = harmonics(random, arm.n, len(arm.parameters), 1)[:1]
    if any(low <= 0 <= high for low, high in arm.parameters):
        return ((powers(arm.n, len(arm.parameters), s1=1), result[0][1]),)
    return result


def _changed(random: Random, arm: Robot, terms: Terms) -> Terms:
    """One term more, which may be tiny."""
    return (*terms, *scaled(_one(random, arm), random.choice((Fraction(1), Fraction(1, 10**40)))))


def _rewritten(random: Random, terms: Terms, n: int) -> Terms:
    """The same function: a term times s² + c², or in two parts."""
    if not terms or random.random() < 0.4:
        return terms
    (exponents, c), *rest = terms
    if random.random() < 0.5:
        part = coefficient(random)
        return (*rest, (exponents, c - part), (exponents, part))
    k = random.randrange(n)
    squares = [tuple(p + 2 * (i == at) for i, p in enumerate(exponents)) for at in (k, n + k)]
    return (*rest, *((square, c) for square in squares))


def _christoffel(arm: Robot) -> Printed:
    """½ (∂M_ij/∂q_k + ∂M_ik/∂q_j − ∂M_jk/∂q_i), term after term."""
    n, half = range(arm.n), Fraction(1, 2)
    m = arm.mass

    def symbol(i: int, j: int, k: int) -> Terms:
        parts = ((m[i][j], k, half), (m[i][k], j, half), (m[j][k], i, -half))
        return tuple(term for entry, by, c in parts for term in scaled(derivative(entry, by, arm.n), c))

    return [[[*(symbol(i, j, k) for k in n), ()] for j in n] for i in n]


CHANGES = ("none", "none", "skew", "symmetric", "exchange", "constant", "moved to another joint")
"""What is done to C."""


def _printed(random: Random, arm: Robot) -> tuple[Any, str, set[str]]:
    """C as somebody prints it, what was done to it, and the kinds that this makes false."""
    c, n = _christoffel(arm), arm.n
    what = random.choice(CHANGES)
    i, j, k = (random.randrange(n) for _ in range(3))
    one = _one(random, arm)
    broken: set[str] = set()
    if what == "skew" and n == 2:
        c[0][1][k] += one
        c[1][0][k] += scaled(one, Fraction(-1))
        broken = {"CoriolisTorque"}
    elif what == "symmetric":
        c[i][j][k] += one
        broken = {"RateOfMass", "RateLessTwiceCoriolis", "CoriolisTorque"}
    elif what == "exchange" and n == 2:
        # C w stays as it is, C + Cᵀ does not where row i is that of j
        c[i][0][1] += one
        c[i][1][0] += scaled(one, Fraction(-1))
        broken = {"RateOfMass", "RateLessTwiceCoriolis"}
    elif what == "constant":
        c[i][j][n] = one
        broken = {"CoriolisAtRest", "CoriolisTorque", "RateOfMass", "RateLessTwiceCoriolis"}
    elif what.startswith("moved") and n == 2:
        c[i][j].insert(0, c[i][j].pop(1))
        return tuple(tuple(map(tuple, row)) for row in c), what, {"?"}
    else:
        what = "none"
    rows = [[[_rewritten(random, terms, n) for terms in entry] for entry in row] for row in c]
    return tuple(tuple(map(tuple, row)) for row in rows), what, broken


def _of_coriolis(random: Random, kind: Any) -> Made:
    arm = robot(random)
    name = kind.__name__
    if random.random() < 0.3:
        return Made(kind(arm.mass, arm.parameters, ()), "Christoffel symbols", TRUE)
    if random.random() < 0.15 and arm.n == 2 and name == "RateOfMass":
        other = (*arm.mass[1][0], (powers(2, len(arm.parameters), s2=1), coefficient(random)))
        mass = (arm.mass[0], (other, arm.mass[1][1]))
        return Made(kind(mass, arm.parameters, ()), "M, not symmetric", FALSE)
    printed, what, broken = _printed(random, arm)
    truth = None if "?" in broken else FALSE if name in broken else TRUE
    family = "C printed" if what == "none" else f"C printed, changed: {what}"
    return Made(kind(arm.mass, arm.parameters, printed), family, truth)


for _kind, _weight in (
    (CoriolisAtRest, 0.5),
    (RateOfMass, 0.6),
    (RateLessTwiceCoriolis, 0.6),
    (CoriolisTorque, 0.6),
):
    generates(_kind.__name__, _weight)(partial(_of_coriolis, kind=_kind))


@generates("GravityOfPotential", 0.6)
def potential(random: Random) -> Made:
    """g is the gradient of U, or with a term more, a sign turned or two joints exchanged."""
    n, parameters = random.choice((1, 2, 2)), ranges(random)
    count = len(parameters)
    energy = harmonics(random, n, count, 3)
    torques = [derivative(energy, k, n) for k in range(n)]
    truth: str | None = TRUE
    kind = random.random()
    if kind < 0.25:
        k = random.randrange(n)
        torques[k] = (*torques[k], (powers(n, count, s1=1, c1=random.randint(0, 2)), coefficient(random)))
        truth = FALSE
    elif kind < 0.4:
        torques, truth = [scaled(g, Fraction(-1)) for g in torques], None
    elif kind < 0.55:
        torques, truth = torques[::-1], TRUE if n == 1 else None
    torques = [_rewritten(random, g, n) for g in torques]
    return Made(GravityOfPotential(tuple(torques), energy, parameters), "gravity of a potential", truth)
