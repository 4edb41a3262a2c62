"""P over boxes, in balls or, where those are too coarse, in spans."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import lru_cache, partial
from typing import Any, NamedTuple

from flint import arb, arb_mat

from lyapcheck.check.loop.arithmetic import BALLS, Arithmetic, Ring
from lyapcheck.check.loop.closed_loop import ClosedLoop
from lyapcheck.check.loop.field import Box, Field, Part, Side, ball, combined, cosines_and_sines
from lyapcheck.check.numbers.balls import to_arb
from lyapcheck.check.numbers.members import Member

Value = Any
"""A ball or a span, as the arithmetic has it; or intervals of many boxes at once."""
Rows = list[list[Value]]
Symbols = dict[tuple[int, int, int], Value]
_KEPT = 1 << 16


class Errors(NamedTuple):
    """What P needs of a box of errors alone: r², ε, ε/(4 k̃_i), Λh, Λh' and êᵀ/(1+r)."""

    r_squared: Value
    eps: Value
    weight: list[Value]
    h: list[Value]
    dh: list[Value]
    along: list[Value]


class Evaluator:
    """P over boxes; ranges of functions of one side, and of all errors, are kept, since boxes share them."""

    def __init__(self, loop: ClosedLoop, of: Arithmetic) -> None:
        self.loop = loop
        self.of = of
        self.zero = of.value(arb(0))
        self.eps0 = of.value(to_arb(loop.eps0))
        ranges = (*loop.parameters, *loop.friction)
        self.exact = [of.value(to_arb(low)) for low, _ in ranges]
        self.fixed = [None if low < high else of.value(to_arb(low)) for low, high in ranges]
        self.compliance = [of.value(1 / (4 * to_arb(k))) for k in loop.stiffness]
        self.coupling = [of.value(to_arb(scale)) for scale in loop.coupling]
        entries = [loop.mass[i][j] for i in range(loop.n) for j in range(i + 1)]
        self.field = Field([*entries, *loop.symbols.values()], loop.n, (), loop.angles)
        self.radius_squared = arb(loop.radius) ** 2
        self.h = lru_cache(maxsize=_KEPT)(lambda side: of.value(loop.member.h(ball(side))))
        self.dh = lru_cache(maxsize=_KEPT)(lambda side: of.value(loop.member.dh(ball(side))))
        self.square = lru_cache(maxsize=_KEPT)(square)
        self.errors = lru_cache(maxsize=_KEPT // 4)(self._errors)
        self.arms: dict[Box, tuple[Rows, Symbols]] = {}

    def proves(self, box: Box) -> bool:
        """Whether P ≻ 0 at every point of the box, or all of it lies beyond R."""
        first, last = len(self.loop.angles), len(self.loop.angles) + self.loop.n
        sides, errors = box[:first], box[first:last]
        if self.errors(errors).r_squared >= self.radius_squared:
            return True
        return self.of.positive_definite(self.schur(sides, errors, box[last:]))

    def schur(self, sides: Box, errors: Box, uncertain: Box) -> Rows:
        filled, known = self._filled(uncertain), self.errors(errors)
        B = filled[len(filled) - self.loop.n :]
        return form(*self._arm(sides, uncertain, filled), known, B, self.of)

    def _filled(self, uncertain: Box) -> list[Value]:
        """All parameters and then B: sides of the box where they are uncertain."""
        if not uncertain:
            return self.exact
        sides = iter(uncertain)
        return [self.of.value(ball(next(sides))) if value is None else value for value in self.fixed]

    def _errors(self, errors: Box) -> Errors:
        r_squared = sum((self.square(side) for side in errors), arb(0))
        shrink = self.of.value(inverse_one_plus_root(r_squared))
        eps = self.eps0 * shrink
        return Errors(
            r_squared,
            eps,
            [eps * c for c in self.compliance],
            self._coupled(self.h, errors),
            self._coupled(self.dh, errors),
            [self.of.value(unit) * shrink for unit in unit_vector(errors, self.square)],
        )

    def _coupled(self, form: Callable[[Side], Value], errors: Box) -> list[Value]:
        values = [form(side) for side in errors]
        return (
            [x * scale for x, scale in zip(values, self.coupling, strict=True)] if self.coupling else values
        )

    def _arm(self, sides: Box, uncertain: Box, filled: list[Value]) -> tuple[Rows, Symbols]:
        """M and the Christoffel symbols over a box of angles and parameters."""
        place = sides + uncertain
        known = self.arms.get(place)
        if known is None:
            if len(self.arms) > _KEPT // 4:
                self.arms.clear()
            known = self.arms[place] = self._new_arm(sides, filled[: len(self.loop.parameters)])
        return known

    def _new_arm(self, sides: Box, parameters: list[Value]) -> tuple[Rows, Symbols]:
        return self._entries(self.field.at(sides, parameters, self.of))

    def _entries(self, polynomials: list[Value]) -> tuple[Rows, Symbols]:
        """M and the symbols from all polynomials of the arm, in their order."""
        result, n = list(polynomials), self.loop.n
        below = {(i, j): result.pop(0) for i in range(n) for j in range(i + 1)}
        M = [[below[max(i, j), min(i, j)] for j in range(n)] for i in range(n)]
        return M, dict(zip(self.loop.symbols, result, strict=True))


def form(M: Rows, symbols: Symbols, errors: Errors, B: list[Value], of: Ring) -> Rows:
    """P, the entries on and below the diagonal, in any arithmetic."""
    joints, zero, half = range(len(B)), of.value(arb(0)), of.value(arb(1) / 2)
    eps, S = errors.eps, _coupling(M, symbols, errors, zero)
    X = [[eps * S[i][j] + B[i] if i == j else eps * S[i][j] for j in joints] for i in joints]

    def beside(i: int, j: int) -> Value:
        slow = sum((x[i] * x[j] * c for x, c in zip(X, errors.weight, strict=True)), zero)
        return eps * (S[i][j] + S[j][i]) * half - slow

    def diagonal(i: int) -> Value:
        return X[i][i] - sum((of.square(x[i]) * c for x, c in zip(X, errors.weight, strict=True)), zero)

    return [[*(beside(i, j) for j in range(i)), diagonal(i)] for i in joints]


def _coupling(M: Rows, symbols: Symbols, errors: Errors, zero: Value) -> Rows:
    """S = C(q,Λh) + (M Λh) êᵀ/(1+r) − M ΛH'."""
    joints, h, dh, along = range(len(M)), errors.h, errors.dh, errors.along
    mh = [sum((M[i][j] * h[j] for j in joints), zero) for i in joints]
    rows = [[mh[i] * along[j] - M[i][j] * dh[j] for j in joints] for i in joints]
    for (i, j, k), symbol in symbols.items():
        rows[i][j] = rows[i][j] + symbol * h[k]
        if k != j:
            rows[i][k] = rows[i][k] + symbol * h[j]
    return rows


def square(side: Side) -> arb:
    """x² over a side: never below 0."""
    low, high = arb(side[0]) ** 2, arb(side[1]) ** 2
    return arb(0).union(low).union(high) if side[0] < 0 < side[1] else low.union(high)


def inverse_one_plus_root(r_squared: arb) -> arb:
    """1/(1 + r), which falls with r."""
    low, high = r_squared.lower(), r_squared.upper()
    near = 1 + (low.sqrt() if low > 0 else arb(0))
    return (1 / near).union(1 / (1 + high.sqrt()))


def unit_vector(errors: Sequence[Side], square: Callable[[Side], arb]) -> list[arb]:
    """e/‖e‖, and all of [−1, 1] where the box touches the origin."""
    squares = [square(side) for side in errors]
    result = []
    for i, (low, high) in enumerate(errors):
        rest = sum((x for k, x in enumerate(squares) if k != i), arb(0))
        result.append((-_share(-low, rest)).union(_share(high, rest)))
    return result


def _share(x: float, rest: arb) -> arb:
    """An upper bound of x/√(x² + rest): for x ≥ 0 it falls with the rest, for x < 0 it grows with it."""
    if x == 0.0:
        return arb(0)
    side = rest.lower() if x > 0 else rest.upper()
    side = side if side > 0 else arb(0)
    return arb(x) / (arb(x) ** 2 + side).sqrt()


# --- P over a box by its value in the middle and its slopes: P(x) = P(c) + Σ_k S_k (x_k − c_k).
#
# Ranges of the entries of P forget how these move together: near a worst state, where the least eigenvalue is
# small and flat, that takes boxes as small as the eigenvalue. Slopes keep it. With T = L⁻¹ of P(c) ≈ L D Lᵀ
#
#     T P(x) Tᵀ = T P(c) Tᵀ + Σ_k T S_k Tᵀ (x_k − c_k)
#
# has the worst direction in one entry, and boxes may be as large as the root of the eigenvalue. It shows
# P ≻ 0 whatever T is: were T singular, T P Tᵀ would be so too.
#
# Slopes of a product: f(x) g(x) − f(c) g(c) = f(x) (g(x) − g(c)) + g(c) (f(x) − f(c)); those of a function
# are the range of its derivative, by the mean value theorem.


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
