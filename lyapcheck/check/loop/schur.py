"""P over boxes, in balls or, where those are too coarse, in spans."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import Any, NamedTuple

from flint import arb

from lyapcheck.check.loop.arithmetic import Arithmetic, Ring
from lyapcheck.check.loop.boxes import Box, Side
from lyapcheck.check.loop.closed_loop import ClosedLoop
from lyapcheck.check.loop.field import Field, ball
from lyapcheck.check.numbers.balls import to_arb

Value = Any
"""A ball or a span, as the arithmetic has it."""
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
    """P over boxes; ranges of functions of one side, and of all errors, are kept, since boxes share them.

    Args:
        loop: what is to be shown.
        of: the arithmetic.
    """

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
        """P, the entries on and below the diagonal."""
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
        """Λh or Λh'."""
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
