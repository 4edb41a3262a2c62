"""P over a box by its value in the middle and its slopes: P(x) = P(c) + Σ_k S_k (x_k − c_k).

Ranges of the entries of P forget how these move together: near a worst state, where the least eigenvalue is
small and flat, that takes boxes as small as the eigenvalue. Slopes keep it. With T = L⁻¹ of P(c) ≈ L D Lᵀ

    T P(x) Tᵀ = T P(c) Tᵀ + Σ_k T S_k Tᵀ (x_k − c_k)

has the worst direction in one entry, and boxes may be as large as the root of the eigenvalue. It shows P ≻ 0
whatever T is: were T singular, T P Tᵀ would be so too.

Slopes of a product: f(x) g(x) − f(c) g(c) = f(x) (g(x) − g(c)) + g(c) (f(x) − f(c)); those of a function are
the range of its derivative, by the mean value theorem.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache, partial
from typing import Any

from flint import arb, arb_mat

from lyapcheck.check.loop.arithmetic import BALLS, Arithmetic
from lyapcheck.check.loop.boxes import Box, Side
from lyapcheck.check.loop.closed_loop import ClosedLoop
from lyapcheck.check.loop.field import Part, ball, combined, cosines_and_sines
from lyapcheck.check.loop.schur import (
    Errors,
    Evaluator,
    Rows,
    Symbols,
    inverse_one_plus_root,
    unit_vector,
)
from lyapcheck.check.numbers.members import Member

Value = Any
"""Balls, or intervals of many boxes at once."""
Affine = tuple[Value, Value]
"""A middle and slopes."""


class Centred:
    """A function of the sides of a box: its value in the middle, its range, and its slopes, one a side."""

    __slots__ = ("hull", "middle", "slopes")

    def __init__(self, middle: Value, hull: Value, slopes: Value) -> None:
        self.middle, self.hull, self.slopes = middle, hull, slopes

    def __add__(self, other: Centred) -> Centred:
        return Centred(self.middle + other.middle, self.hull + other.hull, self.slopes + other.slopes)

    def __sub__(self, other: Centred) -> Centred:
        return Centred(self.middle - other.middle, self.hull - other.hull, self.slopes - other.slopes)

    def __mul__(self, other: Centred) -> Centred:
        return Centred(
            self.middle * other.middle,
            self.hull * other.hull,
            other.slopes * self.hull + self.slopes * other.middle,
        )


def triangle(middle: Sequence[Sequence[Any]]) -> list[list[Any]]:
    """L⁻¹ of L D Lᵀ, for the entries on and below the diagonal in doubles; without its ones and zeros."""
    rows = [list(row) for row in middle]
    inverse: list[list[Any]] = [[] for _ in middle]
    for k, row in enumerate(inverse):
        for i in range(k + 1, len(rows)):
            factor = rows[i][k] / rows[k][k]
            inverse[i] = [x - factor * y for x, y in zip([*inverse[i], 0.0], [*row, 1.0], strict=True)]
            for j in range(k + 1, i + 1):
                rows[i][j] = rows[i][j] - factor * rows[j][k]
    return inverse


def transformed(rows: Sequence[Sequence[Centred]], T: Sequence[Sequence[Value]]) -> list[list[Affine]]:
    """Middle and slopes of T P Tᵀ, from the entries of P on and below the diagonal and T as of `triangle`."""
    joints = range(len(rows))
    full = [[rows[max(i, j)][min(i, j)] for j in joints] for i in joints]
    pairs = [[(entry.middle, entry.slopes) for entry in row] for row in full]
    half = [[_with(T[i], pairs[j]) for j in joints] for i in joints]
    return [[_with(T[j], half[i]) for j in range(i + 1)] for i in joints]


def _with(weights: Sequence[Value], terms: Sequence[Affine]) -> Affine:
    """Σ weights·terms, and one times the term after those."""
    middle, slopes = terms[len(weights)]
    for weight, (x, s) in zip(weights, terms, strict=False):
        middle, slopes = middle + x * weight, slopes + s * weight
    return middle, slopes


class CentredEvaluator(Evaluator):
    """P in this form; it has none at e = 0, where ê has no value."""

    def __init__(self, loop: ClosedLoop) -> None:
        self.still = arb_mat(1, len(loop.start))
        super().__init__(loop, Arithmetic(self._constant, self._square, BALLS.meet, BALLS.positive))
        self.of_error = lru_cache(maxsize=1 << 14)(partial(of_error, loop.member))

    def proves(self, box: Box) -> bool:
        """Whether P ≻ 0 at every point of the box, by T P Tᵀ; ``False`` for one that touches e = 0."""
        first, last = len(self.loop.angles), len(self.loop.angles) + self.loop.n
        if self.loop.member.d2h is None or all(low <= 0 <= high for low, high in box[first:last]):
            return False
        rows = self.schur(box[:first], box[first:last], box[last:])
        try:
            T = triangle([[float(entry.middle.mid()) for entry in row] for row in rows])
        except ZeroDivisionError:
            return False
        offsets = arb_mat([[ball(side) - _middle(side)] for side in box])
        exact = [[arb(x) for x in row] for row in T]
        moved = [[x + (s * offsets)[0, 0] for x, s in row] for row in transformed(rows, exact)]
        return BALLS.positive_definite(moved)

    def _constant(self, value: arb) -> Centred:
        return Centred(value, value, self.still)

    def _square(self, x: Centred) -> Centred:
        return Centred(x.middle**2, BALLS.square(x.hull), x.slopes * (x.hull + x.middle))

    def _placed(self, middle: arb, hull: arb, slopes: Sequence[tuple[int, arb]]) -> Centred:
        row = arb_mat(self.still)
        for side, slope in slopes:
            row[0, side] = slope
        return Centred(middle, hull, row)

    def _filled(self, uncertain: Box) -> list[Centred]:
        sides = enumerate(uncertain, start=len(self.loop.start) - len(uncertain))
        free = (self._placed(_middle(side), ball(side), [(place, arb(1))]) for place, side in sides)
        return [next(free) if value is None else value for value in self.fixed]

    def _errors(self, errors: Box) -> Errors:
        first, r_squared = len(self.loop.angles), sum(map(self.square, errors), arb(0))
        known = [self.of_error(side) for side in errors]
        scales = self.coupling or [self.of.value(arb(1))] * self.loop.n
        h, dh = (
            [self._placed(x, y, [(first + j, s)]) * scales[j] for j, (x, y, s) in enumerate(part)]
            for part in zip(*known, strict=True)
        )
        shrink, along = self._shrink(errors, r_squared)
        eps = self.eps0 * shrink
        return Errors(r_squared, eps, [eps * c for c in self.compliance], h, dh, along)

    def _shrink(self, errors: Box, r_squared: arb) -> tuple[Centred, list[Centred]]:
        """1/(1 + r) and êᵀ/(1 + r), for r > 0."""
        middle = [_middle(side) for side in errors]
        at = sum((x * x for x in middle), arb(0)).sqrt()
        first, joints = len(self.loop.angles), range(self.loop.n)
        unit, near = unit_vector(errors, self.square), inverse_one_plus_root(r_squared)
        r = r_squared.lower().sqrt().union(r_squared.upper().sqrt())
        shrink = self._placed(1 / (1 + at), near, [(first + k, -unit[k] * near**2) for k in joints])
        turns = [[(first + k, (int(j == k) - unit[j] * unit[k]) / r) for k in joints] for j in joints]
        return shrink, [self._placed(middle[j] / at, unit[j], turns[j]) * shrink for j in joints]

    def _new_arm(self, sides: Box, parameters: list[Centred]) -> tuple[Rows, Symbols]:
        q, middle = [arb(0)] * self.loop.n, [arb(0)] * self.loop.n
        for joint, side in zip(self.loop.angles, sides, strict=True):
            q[joint], middle[joint] = ball(side), _middle(side)
        wide, centre = (cosines_and_sines(self.field.used, x, BALLS) for x in (q, middle))
        offset = [a - b for a, b in zip(q, middle, strict=True)]

        def part(terms: Part) -> Centred:
            slopes = [(self.loop.angles.index(i), combined(s, wide, BALLS)) for i, s in terms.slopes]
            hull = terms.over(wide, centre, offset, BALLS)
            return self._placed(combined(terms.terms, centre, BALLS), hull, slopes)

        return self._entries([entry.put_together(part, parameters, self.of) for entry in self.field.entries])


def of_error(member: Member, side: Side) -> tuple[tuple[arb, arb, arb], tuple[arb, arb, arb]]:
    """h and h' of one error: in the middle of the side, over it, and their slopes.

    Where h' is convex or concave (h'(x) − h'(c))/(x − c) is monotone, hence between its values at the ends.

    Raises:
        ValueError: h'' is not known.
    """
    if member.d2h is None:
        raise ValueError("the checker does not know h''")
    x, low, c, high = ball(side), arb(side[0]), _middle(side), arb(side[1])
    middle, dh = member.dh(c), member.dh(x)
    if low < c < high and not any(x.overlaps(place) or x.overlaps(-place) for place in member.bends()):
        below, above = (member.dh(low) - middle) / (low - c), (member.dh(high) - middle) / (high - c)
        bend = below.union(above)
    else:
        bend = member.d2h(x)
    return (member.h(c), member.h(x), dh), (middle, dh, bend)


def _middle(side: Side) -> arb:
    return arb(0.5 * (side[0] + side[1]))
