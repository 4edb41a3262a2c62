"""Small arms at random, definite or not: bounds near the extreme that is found."""

from dataclasses import dataclass
from fractions import Fraction
from functools import partial

from lyapcheck.check.kinds.coriolis import CoriolisBelow
from lyapcheck.check.kinds.gravity import GravityBelow
from lyapcheck.check.kinds.inertia import MassAbove, MassBelow
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
