"""How small and how large M(q) and C(q, ·) of an arm are, over all angles and parameters.

References: ``reyes2019family``, Properties 2.1, 2.2 and 2.6.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from functools import cached_property, lru_cache
from itertools import accumulate, count, takewhile

from flint import arb

from lyapcheck.check.loop.field import MOST_BOXES, Arithmetic, Field, Value, size_of, value_at
from lyapcheck.check.numbers.balls import to_arb
from lyapcheck.check.numbers.harmonics import Uncertain, by_parameters, christoffel
from lyapcheck.check.statement import Ends, Mass


class Inertia:
    """M(q) of n joints, for all parameters in their ranges."""

    def __init__(self, mass: Mass, parameters: Sequence[Ends]) -> None:
        self.n, self.parameters = len(mass), tuple(parameters)
        self.mass: list[list[Uncertain]] = [[by_parameters(entry, self.n) for entry in row] for row in mass]

    @property
    def symmetric(self) -> bool:
        """Whether M = Mᵀ for all angles and parameters."""
        return all(self.mass[i][j] == self.mass[j][i] for i in range(self.n) for j in range(i))

    @cached_property
    def symbols(self) -> dict[tuple[int, int, int], Uncertain]:
        """The Christoffel symbols c_ijk = c_ikj with k ≤ j that do not vanish."""
        return christoffel(self.mass)

    def above(self, low: Sequence[Fraction], most: int = MOST_BOXES) -> bool:
        """Whether M(q) − diag(low) is positive definite throughout, by boxes cut until they show it."""
        less = [-x for x in low]
        return self._lower_half().throughout(lambda m, of: exceeds(rows_of(m), less, of), most)

    def below(self, high: Fraction, most: int = MOST_BOXES) -> bool:
        """Whether high·I − M(q) and high·I + M(q) are positive definite throughout: then ‖M(q)‖ < high."""
        more = [high] * self.n
        return self._lower_half().throughout(
            lambda m, of: all(exceeds(rows_of(signed), more, of) for signed in (m, _negative(m, of))), most
        )

    def coriolis_below(self, high: Fraction, most: int = MOST_BOXES) -> bool:
        """Whether ‖C(q, x)y‖ < high ‖x‖ ‖y‖ throughout, by boxes.

        Soundness: with S_i = (c_ijk)_jk the entries of C(q, x)y are xᵀS_i y, so that its square is at most
            yᵀ(Σ S_i²)y for ‖x‖ = 1, and at most λmax((tr S_i S_l)_il), the square of the norm of the map
            from matrices x yᵀ; on each box one of the two is shown to be below high².
        """
        places = list(self.symbols)
        field = Field([self.symbols[place] for place in places], self.n, self.parameters)

        def shows(values: list[Value], of: Arithmetic) -> bool:
            c = dict(zip(places, values, strict=True))
            return any(exceeds(rows, [high * high] * self.n, of) for rows in self._unfolded(c, of))

        return field.throughout(shows, most)

    def times(self, q: Sequence[Fraction], parameters: Sequence[Fraction], x: Sequence[arb]) -> list[arb]:
        rows = self.at(q, parameters)
        return [sum((a * b for a, b in zip(row, x, strict=True)), arb(0)) for row in rows]

    def at(self, q: Sequence[Fraction], parameters: Sequence[Fraction]) -> list[list[arb]]:
        return [[value_at(entry, q, parameters) for entry in row] for row in self.mass]

    def coriolis(
        self, q: Sequence[Fraction], parameters: Sequence[Fraction], x: Sequence[arb], y: Sequence[arb]
    ) -> list[arb]:
        """C(q, x)y in balls, (Σ_jk c_ijk x_k y_j)_i."""
        result = [arb(0)] * self.n
        for (i, j, k), symbol in self.symbols.items():
            value = value_at(symbol, q, parameters)
            result[i] += value * (x[k] * y[j] if j == k else x[k] * y[j] + x[j] * y[k])
        return result

    @cached_property
    def largest_row(self) -> Fraction:
        """A bound of ‖M(q)‖: the largest sum of a row of sizes of entries."""
        return max(sum((size_of(x, self.parameters) for x in row), Fraction(0)) for row in self.mass)

    @cached_property
    def squares_of_symbols(self) -> Fraction:
        """A bound of Σ c_ijk², which ‖C(q, x)y‖² ≤ Σ c_ijk² ‖x‖²‖y‖² asks for, by Cauchy–Schwarz twice."""
        sizes = ((j == k, size_of(c, self.parameters)) for (_, j, k), c in self.symbols.items())
        return sum(((1 if same else 2) * size**2 for same, size in sizes), Fraction(0))

    def _lower_half(self) -> Field:
        entries = [self.mass[i][j] for i in range(self.n) for j in range(i + 1)]
        return Field(entries, self.n, self.parameters)

    def _unfolded(self, c: dict[tuple[int, int, int], Value], of: Arithmetic) -> list[list[list[Value]]]:
        """−Σ_i S_i² and −(tr S_i S_l)_il, the entries on and below the diagonal."""
        n, zero = range(self.n), of.value(arb(0))
        full = [[[c.get((i, max(j, k), min(j, k)), zero) for k in n] for j in n] for i in n]
        stacked = [[x for s in full for x in s[j]] for j in n]
        flat = [[x for row in s for x in row] for s in full]
        return [
            [_negative([_product(rows[j], rows[k], j == k, of) for k in range(j + 1)], of) for j in n]
            for rows in (stacked, flat)
        ]


@lru_cache(maxsize=4)
def inertia_of(mass: Mass, parameters: tuple[Ends, ...]) -> Inertia:
    """M(q) of a statement; several ask for the same, and its harmonics can take seconds."""
    return Inertia(mass, parameters)


def _negative(values: Sequence[Value], of: Arithmetic) -> list[Value]:
    return [of.value(arb(0)) - value for value in values]


def _product(x: list[Value], y: list[Value], same: bool, of: Arithmetic) -> Value:
    """x·y, and x·x never below 0."""
    zero = of.value(arb(0))
    if same:
        return sum((of.square(a) for a in x), zero)
    return sum((a * b for a, b in zip(x, y, strict=True)), zero)


def rows_of(entries: Sequence[Value]) -> list[list[Value]]:
    """The entries on and below the diagonal of a matrix, row by row."""
    starts = takewhile(lambda start: start < len(entries), accumulate(count()))
    return [list(entries[start : start + 1 + k]) for k, start in enumerate(starts)]


def exceeds(rows: list[list[Value]], shift: Sequence[Fraction], of: Arithmetic) -> bool:
    """Whether A + diag(shift) is positive definite, A by its entries on and below the diagonal."""
    for row, x in zip(rows, shift, strict=True):
        row[-1] = row[-1] + of.value(to_arb(x))
    return of.positive_definite(rows)
