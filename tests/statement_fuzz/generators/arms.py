"""Small arms at random, definite or not: bounds near the extreme that is found, laws of M, C and g."""

from dataclasses import dataclass
from fractions import Fraction
from functools import partial

from lyapcheck.check.kinds.coriolis import (
    CoriolisAtRest,
    CoriolisBelow,
    CoriolisTorque,
    MassSymmetric,
    RateLessTwiceCoriolis,
    RateOfMass,
)
from lyapcheck.check.kinds.gravity import GravityBelow, GravityOfPotential
from lyapcheck.check.kinds.inertia import MassAbove, MassBelow
from tests.oracle.arm import derivative
from tests.oracle.bounds import extreme
from tests.statement_fuzz.generators import FALSE, TRUE, Made, generates

SCALES = (*[Fraction(1)] * 12, Fraction(10**9), Fraction(1, 10**9), Fraction(10**30), Fraction(1, 10**30))


@dataclass(frozen=True)
class Robot:
    """M(q), the ranges of its parameters, and whether M ≻ 0 by construction (``None``: not known)."""

    mass: tuple
    parameters: tuple
    definite: bool | None

    @property
    def n(self):
        """How many joints."""
        return len(self.mass)


def coefficient(random):
    """A short number that is not 0."""
    return Fraction(random.choice((-3, -2, -1, 1, 1, 2, 3, 5)), random.choice((1, 1, 2, 4, 7, 10)))


def powers(n, parameters, **exponents):
    """Exponents by name: ``s1`` is sin q1, ``c2`` is cos q2, ``p1`` the first parameter."""
    names = [f"{letter}{k + 1}" for letter in "sc" for k in range(n)]
    return tuple(exponents.get(name, 0) for name in [*names, *(f"p{k + 1}" for k in range(parameters))])


def harmonics(random, n, parameters, most, first=1):
    """Some products of sines and cosines of the joints from ``first`` on, sometimes with a parameter."""
    result = []
    for _ in range(random.randint(0, most)):
        joint = random.randint(first, n)
        names = random.choice(
            (("s", "c")[random.randrange(2)], "c", "cc", "sc", "ss" if random.random() < 0.5 else "s")
        )
        exponents = {f"{letter}{joint}": names.count(letter) for letter in "sc"}
        if n > 1 and random.random() < 0.2:
            exponents[f"{random.choice('sc')}{random.randint(first, n)}"] = 1
        if parameters and random.random() < 0.4:
            exponents["p1"] = random.choice((1, 1, 2))
        result.append((powers(n, parameters, **exponents), coefficient(random)))
    return tuple(result)


def scaled(terms, factor):
    """Each coefficient times a factor."""
    return tuple((exponents, c * factor) for exponents, c in terms)


def size(terms, parameters):
    """A bound of the absolute value: the sum of the coefficients, with parameters at their largest."""
    total = Fraction(0)
    for exponents, c in terms:
        part = abs(c)
        for (low, high), power in zip(parameters, exponents[len(exponents) - len(parameters) :], strict=True):
            part *= max(abs(low), abs(high)) ** power
        total += part
    return total


def number(n, parameters, value):
    """A constant as a polynomial."""
    return ((powers(n, parameters), value),)


def ranges(random):
    """Mostly no parameter, else one."""
    if random.random() < 0.85:
        return ()
    low = Fraction(random.randint(-2, 4), 4)
    return ((low, low + random.choice((Fraction(0), Fraction(1, 4), Fraction(1)))),)


def robot(random, n=None, definite=None, plain=False):
    """An arm; ``definite`` asks for M ≻ 0 or not by construction, ``plain`` for nothing extreme.

    M ≻ 0 where each diagonal entry has a constant above all that could be against it; M is not definite
    where one is negative at every posture.
    """
    n = n or random.choice((1, 1, 2))
    parameters = () if plain else ranges(random)
    count = len(parameters)
    if n == 2 and random.random() < 0.3 and definite is not False:
        return _planar(random, plain)
    first = 2 if n == 2 and (plain or random.random() < 0.7) else 1
    most = 1 if plain else 2
    entries = {(i, j): harmonics(random, n, count, most, first) for i in range(n) for j in range(i + 1)}
    if n == 2 and random.random() < 0.5:
        entries[1, 0] += number(n, count, coefficient(random))
    against = [
        sum((size(entries[max(i, j), min(i, j)], parameters) for j in range(n)), Fraction(0))
        for i in range(n)
    ]
    what = definite if definite is not None else random.choice((True, True, True, False, None))
    extra = [random.choice((Fraction(1, 100), Fraction(1, 4), Fraction(2))) for _ in range(n)]
    constants = [a + b for a, b in zip(against, extra, strict=True)]
    if what is False:
        k = random.randrange(n)
        constants[k] = -constants[k]
    elif what is None:
        constants = [c * random.choice((Fraction(1), Fraction(3, 4), Fraction(1, 2))) for c in constants]
    for i, c in enumerate(constants):
        entries[i, i] += number(n, count, c)
    factor = Fraction(1) if plain else random.choice(SCALES)
    rows = tuple(tuple(scaled(entries[max(i, j), min(i, j)], factor) for j in range(n)) for i in range(n))
    return Robot(rows, parameters, what)


def _planar(random, plain):
    """Two links in a plane: M ≻ 0, as it is the sum of the energies of two bodies."""
    m1, m2, l1, r1, r2, i1, i2 = (abs(coefficient(random)) for _ in range(7))
    a, b, c = i1 + m1 * r1**2 + m2 * l1**2, m2 * l1 * r2, i2 + m2 * r2**2
    factor = Fraction(1) if plain else random.choice(SCALES)
    one, turn = powers(2, 0), powers(2, 0, c2=1)
    rows = ((((one, a + c), (turn, 2 * b)), ((one, c), (turn, b))), (((one, c), (turn, b)), ((one, c),)))
    return Robot(tuple(tuple(scaled(e, factor) for e in row) for row in rows), (), True)


def gravity(random, n, parameters):
    """A torque for each joint, sometimes none at all; now and then of one joint alone."""
    if random.random() < 0.1:
        return ((),) * n
    return tuple(harmonics(random, n, parameters, 2) for _ in range(random.choice((1, n))))


FAR = (Fraction(1, 100), Fraction(1, 20), Fraction(1, 5), Fraction(1, 2))
NEAR = (Fraction(1, 1000), Fraction(1, 10**6))


def planted(random, extreme, easy):
    """A bound beyond the largest value that was found, or one that this value breaks.

    Close bounds cost a whole budget of boxes: there are few of them where postures are met only roughly.
    """
    kind = random.random()
    share = random.choice(NEAR) if kind < (0.2 if easy else 0.01) else random.choice(FAR[0 if easy else 2 :])
    if random.random() < 0.5:
        return Fraction(extreme) + share * abs(Fraction(extreme)), None
    return Fraction(extreme) - share * abs(Fraction(extreme)), FALSE


def _sizes(arm):
    return max(sum((size(entry, arm.parameters) for entry in row), Fraction(0)) for row in arm.mass)


@generates("MassAbove", 1.2)
def above(random):
    """M ≻ low·I, mostly with low near the least eigenvalue."""
    arm = robot(random)
    kind, data = random.random(), (arm.mass, arm.parameters)
    if kind < 0.35:
        truth = {True: TRUE, False: FALSE, None: None}[arm.definite]
        return Made(MassAbove(*data, Fraction(0)), "M above 0", truth)
    if kind < 0.42 and arm.n == 2:
        mass = (arm.mass[0], (scaled(arm.mass[1][0], Fraction(3, 2)), arm.mass[1][1]))
        return Made(MassAbove(mass, arm.parameters, Fraction(0)), "M, not symmetric perhaps")
    bound, truth = planted(random, -extreme(MassAbove, *data), arm.n == 1 and not arm.parameters)
    return Made(MassAbove(*data, max(-bound, Fraction(0))), "M above a bound", truth)


def _below(random, kind, data, total, easy):
    """A bound that is the sum of all coefficients, near the largest value, or not above 0."""
    name, how = kind.__name__, random.random()
    if how < 0.2 and kind is not CoriolisBelow:
        return Made(kind(*data, total), f"{name}, the sum of the terms", TRUE)
    largest = extreme(kind, *data)
    if how < 0.35:
        high = Fraction(0) if kind is GravityBelow else random.choice((Fraction(0), Fraction(-1), -total))
        return Made(kind(*data, high), f"{name} nothing", FALSE if largest > 0 or high < 0 else None)
    bound, truth = planted(random, largest, easy)
    return Made(kind(*data, max(bound, Fraction(0))), f"{name} a bound", truth if largest > 0 else None)


def _of_mass(random, kind):
    arm = robot(random)
    return _below(random, kind, (arm.mass, arm.parameters), _sizes(arm), arm.n == 1 and not arm.parameters)


@generates("GravityBelow", 1)
def weight(random):
    """√Σ g_i² ≤ high near the largest value; no gravity at all; a bound of 0."""
    n, parameters = random.choice((1, 1, 2)), ranges(random)
    factor = random.choice((*[Fraction(1)] * 8, Fraction(10**9), Fraction(1, 10**30)))
    torques = tuple(scaled(g, factor) for g in gravity(random, n, len(parameters)))
    total = sum((size(g, parameters) for g in torques), Fraction(0))
    return _below(random, GravityBelow, (n, torques, parameters), total, n == 1 and not parameters)


for _kind in (MassBelow, CoriolisBelow):
    generates(_kind.__name__, 1)(partial(_of_mass, kind=_kind))


@generates("MassSymmetric", 0.6)
def symmetric(random):
    """M = Mᵀ, written in other terms, or with one term more on one side."""
    arm = robot(random, n=2)
    other, truth = arm.mass[1][0], TRUE
    if random.random() < 0.5:
        other, truth = _changed(random, arm, other), FALSE
    mass = (arm.mass[0], (_rewritten(random, other, arm.n), arm.mass[1][1]))
    return Made(MassSymmetric(mass, arm.parameters), "symmetry", truth)


def _one(random, arm):
    """One product of sines and cosines."""
    result = ()
    while not result:
        result = harmonics(random, arm.n, len(arm.parameters), 1)[:1]
    if any(low <= 0 <= high for low, high in arm.parameters):
        return ((powers(arm.n, len(arm.parameters), s1=1), result[0][1]),)
    return result


def _changed(random, arm, terms):
    """One term more, which may be tiny."""
    return (*terms, *scaled(_one(random, arm), random.choice((Fraction(1), Fraction(1, 10**40)))))


def _rewritten(random, terms, n):
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


def _christoffel(arm):
    """½ (∂M_ij/∂q_k + ∂M_ik/∂q_j − ∂M_jk/∂q_i), term after term."""
    n, half = range(arm.n), Fraction(1, 2)
    m = arm.mass

    def symbol(i, j, k):
        parts = ((m[i][j], k, half), (m[i][k], j, half), (m[j][k], i, -half))
        return tuple(term for entry, by, c in parts for term in scaled(derivative(entry, by, arm.n), c))

    return [[[*(symbol(i, j, k) for k in n), ()] for j in n] for i in n]


CHANGES = ("none", "none", "skew", "symmetric", "exchange", "constant", "moved to another joint")
"""What is done to C."""


def _printed(random, arm):
    """C as somebody prints it, what was done to it, and the kinds that this makes false."""
    c, n = _christoffel(arm), arm.n
    what = random.choice(CHANGES)
    i, j, k = (random.randrange(n) for _ in range(3))
    one = _one(random, arm)
    broken = set()
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


def _of_coriolis(random, kind):
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
def potential(random):
    """g is the gradient of U, or with a term more, a sign turned or two joints exchanged."""
    n, parameters = random.choice((1, 2, 2)), ranges(random)
    count = len(parameters)
    energy = harmonics(random, n, count, 3)
    torques = [derivative(energy, k, n) for k in range(n)]
    truth = TRUE
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
