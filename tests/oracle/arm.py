"""One arm in numbers: M(q), its derivatives and its Coriolis matrix, with sines and cosines of any sort.

An entry of M is a list of terms (exponents, coefficient); the exponents are of sin q1 …, cos q1 … and the
parameters. The same formulas take doubles in arrays, exact points of the circle, and many digits.
"""

from fractions import Fraction
from itertools import product

from mpmath import mpf

DIGITS = 60
CERTAIN = mpf(10) ** -40
"""Relative size of what 60 digits tell apart without doubt."""


class Place:
    """Sines and cosines of n angles and the parameters; ``number`` takes fractions to their arithmetic."""

    def __init__(self, sines, cosines, parameters, number):
        self.n, self.number = len(sines), number
        self.generators = [*sines, *cosines, *parameters]

    def value(self, terms):
        """The sum of the terms."""
        total = self.number(Fraction(0))
        for powers, coefficient in terms:
            part = self.number(coefficient)
            for generator, power in zip(self.generators, powers, strict=True):
                if power:
                    part = part * generator**power
            total = total + part
        return total

    def matrix(self, rows):
        """The values of all entries."""
        return [[self.value(entry) for entry in row] for row in rows]

    def slopes(self, rows):
        """The derivatives by each angle."""
        return [[[self.value(derivative(e, k, self.n)) for e in row] for row in rows] for k in range(self.n)]

    def symbols(self, rows):
        """The Christoffel symbols c_ijk = ½ (∂M_ij/∂q_k + ∂M_ik/∂q_j − ∂M_jk/∂q_i)."""
        d, joints = self.slopes(rows), range(self.n)
        half = self.number(Fraction(1, 2))
        return [
            [[half * (d[k][i][j] + d[j][i][k] - d[i][j][k]) for k in joints] for j in joints] for i in joints
        ]


def derivative(terms, k, n):
    """∂/∂q_k of a sum of terms: (sᵃcᵇ)' = a sᵃ⁻¹cᵇ⁺¹ − b sᵃ⁺¹cᵇ⁻¹."""
    result = []
    for powers, coefficient in terms:
        for index, other, sign in ((k, n + k, 1), (n + k, k, -1)):
            if powers[index]:
                moved = list(powers)
                moved[index] -= 1
                moved[other] += 1
                result.append((tuple(moved), coefficient * sign * powers[index]))
    return tuple(result)


def turned(symbols, x, y):
    """C(q, x)y = (Σ_jk c_ijk x_k y_j)_i."""
    joints = range(len(x))
    return [sum(symbols[i][j][k] * x[k] * y[j] for j, k in product(joints, joints)) for i in joints]


def times(rows, x):
    """A matrix times a vector."""
    return [sum(a * b for a, b in zip(row, x, strict=True)) for row in rows]


def dot(x, y):
    """xᵀy."""
    return sum(a * b for a, b in zip(x, y, strict=True))


def solved(rows, right):
    """The x with Ax = right, A positive definite, by elimination without exchanges."""
    n, a = len(rows), [[*row, b] for row, b in zip(rows, right, strict=True)]
    for k, i in product(range(n), range(n)):
        if i > k:
            factor = a[i][k] / a[k][k]
            a[i] = [x - factor * y for x, y in zip(a[i], a[k], strict=True)]
    x = [None] * n
    for k in reversed(range(n)):
        x[k] = (a[k][n] - sum(a[k][j] * x[j] for j in range(k + 1, n))) / a[k][k]
    return x


def many(x):
    """A fraction, or text of one, in as many digits as are in force."""
    value = Fraction(x)
    return mpf(value.numerator) / value.denominator


def on_circle(tangents, parameters):
    """One place exactly: the tangents of half the angles, ``None`` for half a turn."""
    sines = [Fraction(0) if t is None else 2 * t / (1 + t * t) for t in tangents]
    cosines = [Fraction(-1) if t is None else (1 - t * t) / (1 + t * t) for t in tangents]
    return Place(sines, cosines, parameters, Fraction)


def some_places(n, ranges, random, count):
    """Exact places at random, with exact parameters."""
    for _ in range(count):
        tangents = [Fraction(random.randint(-9, 9), random.randint(1, 7)) for _ in range(n)]
        yield on_circle(
            tangents, [low + (high - low) * Fraction(random.randint(0, 4), 4) for low, high in ranges]
        )


def quarter_turns(n, ranges):
    """Exact places: all angles multiples of a right angle, all parameters at their ends."""
    right = (Fraction(0), Fraction(1), Fraction(-1), None)
    for tangents in product(right, repeat=n):
        for ends in product(*(sorted(set(pair)) for pair in ranges)):
            yield on_circle(tangents, ends)


def within(statement, point, n, letters):
    """Angles, parameters and vectors of a witness, if they are all there and within their ranges."""
    ranges = getattr(statement, "parameters", ())
    parts = [_read(point, "q", n), _read(point, "p", len(ranges)), *(_read(point, one, n) for one in letters)]
    if any(part is None for part in parts):
        return None
    return parts if all(a <= p <= b for p, (a, b) in zip(parts[1], ranges, strict=True)) else None


def _read(point, letter, n):
    names = [f"{letter}{k + 1}" for k in range(n)]
    return [Fraction(point[name]) for name in names] if all(name in point for name in names) else None
