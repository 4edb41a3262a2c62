"""P over boxes in balls."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import lru_cache
from itertools import chain

from flint import arb

from lyapcheck.check.balls import to_arb
from lyapcheck.check.matrices import balls_positive_definite
from lyapcheck.check.stability.boxes import Box, Side
from lyapcheck.check.stability.closure import Closure
from lyapcheck.check.stability.waves import Polynomial, waves

Rows = list[list[arb]]
Symbols = dict[tuple[int, int, int], arb]
_KEPT = 1 << 16


class Evaluator:
    """P over boxes in balls; ranges of functions of one side are kept, since boxes share sides."""

    def __init__(self, closure: Closure) -> None:
        self.closure = closure
        self.eps0 = to_arb(closure.eps0)
        self.fixed = [
            None if low < high else to_arb(low) for low, high in (*closure.parameters, *closure.friction)
        ]
        self.exact = [to_arb(low) for low, _ in (*closure.parameters, *closure.friction)]
        self.compliance = [1 / (4 * to_arb(k)) for k in closure.stiffness]
        self.mass = [[Polynomial(entry) for entry in row] for row in closure.mass]
        self.symbols = {place: Polynomial(terms) for place, terms in closure.symbols.items()}
        self.radius = closure.radius
        used = {k for f in (*chain(*self.mass), *self.symbols.values()) for k in f.used}
        self.used = sorted(used)
        self.h = lru_cache(maxsize=_KEPT)(lambda side: closure.member.h(ball(side)))
        self.dh = lru_cache(maxsize=_KEPT)(lambda side: closure.member.dh(ball(side)))
        self.square = lru_cache(maxsize=_KEPT)(_square)
        self.arms: dict[Box, tuple[Rows, Symbols]] = {}

    def proves(self, box: Box) -> bool:
        """Whether P ≻ 0 at every point of the box, or all of it lies beyond R."""
        first, last = len(self.closure.angles), len(self.closure.angles) + self.closure.n
        sides, errors = box[:first], box[first:last]
        r_squared = sum((self.square(side) for side in errors), arb(0))
        if r_squared >= arb(self.radius) ** 2:
            return True
        return balls_positive_definite(self.schur(sides, errors, box[last:], r_squared))

    def schur(self, sides: Box, errors: Box, uncertain: Box, r_squared: arb) -> Rows:
        """P, the entries on and below the diagonal."""
        n, filled = self.closure.n, self._filled(uncertain)
        B = filled[len(filled) - n :]
        shrink = _inverse_one_plus_root(r_squared)
        eps = self.eps0 * shrink
        S = self._coupling(self._arm(sides, uncertain, filled), errors, shrink)
        X = [[eps * S[i][j] + B[i] if i == j else eps * S[i][j] for j in range(n)] for i in range(n)]
        weight = [eps * c for c in self.compliance]
        rows = []
        for i in range(n):
            row = [
                eps * (S[i][j] + S[j][i]) / 2 - sum((X[k][i] * X[k][j] * weight[k] for k in range(n)), arb(0))
                for j in range(i)
            ]
            slow = sum((_square_of(X[k][i]) * weight[k] for k in range(n)), arb(0))
            rows.append([*row, X[i][i] - slow])
        return rows

    def _filled(self, uncertain: Box) -> list[arb]:
        """All parameters and then B: sides of the box where they are uncertain."""
        if not uncertain:
            return self.exact
        sides = iter(uncertain)
        return [ball(next(sides)) if value is None else value for value in self.fixed]

    def _coupling(self, arm: tuple[Rows, Symbols], errors: Box, shrink: arb) -> Rows:
        """S = C(q,h) + (M h) êᵀ/(1+r) − M H'."""
        n = self.closure.n
        M, symbols = arm
        h, dh = [self.h(side) for side in errors], [self.dh(side) for side in errors]
        pushed = [sum((M[i][j] * h[j] for j in range(n)), arb(0)) for i in range(n)]
        pull = [unit * shrink for unit in _unit_vector(errors, self.square)]
        rows = [[pushed[i] * pull[j] - M[i][j] * dh[j] for j in range(n)] for i in range(n)]
        for (i, j, k), symbol in symbols.items():
            rows[i][j] += symbol * h[k]
            if k != j:
                rows[i][k] += symbol * h[j]
        return rows

    def _arm(self, sides: Box, uncertain: Box, filled: list[arb]) -> tuple[Rows, Symbols]:
        """M and the Christoffel symbols over a box of angles and parameters."""
        place = sides + uncertain
        known = self.arms.get(place)
        if known is None:
            if len(self.arms) > _KEPT // 4:
                self.arms.clear()
            known = self.arms[place] = self._new_arm(sides, filled[: len(self.closure.parameters)])
        return known

    def _new_arm(self, sides: Box, parameters: list[arb]) -> tuple[Rows, Symbols]:
        n = self.closure.n
        q, middle = [arb(0)] * n, [arb(0)] * n
        for joint, side in zip(self.closure.angles, sides, strict=True):
            q[joint], middle[joint] = ball(side), arb(0.5 * (side[0] + side[1]))
        offset = [a - b for a, b in zip(q, middle, strict=True)]
        over = waves(self.used, q), waves(self.used, middle), offset, parameters
        M = [[f.over(*over) for f in row] for row in self.mass]
        return M, {place: f.over(*over) for place, f in self.symbols.items()}


def ball(side: Side) -> arb:
    """The ball between two doubles, which it contains."""
    return arb(side[0]).union(arb(side[1]))


def _square(side: Side) -> arb:
    """x² over a side: never below 0."""
    low, high = arb(side[0]) ** 2, arb(side[1]) ** 2
    return arb(0).union(low).union(high) if side[0] < 0 < side[1] else low.union(high)


def _square_of(x: arb) -> arb:
    """The square of a ball, which a product with itself would make too wide."""
    low, high = x.lower(), x.upper()
    if low <= 0 <= high:
        return arb(0).union(low * low).union(high * high)
    return (low * low).union(high * high)


def _inverse_one_plus_root(r_squared: arb) -> arb:
    """1/(1 + r), which falls with r."""
    low, high = r_squared.lower(), r_squared.upper()
    near = 1 + (low.sqrt() if low > 0 else arb(0))
    return (1 / near).union(1 / (1 + high.sqrt()))


def _unit_vector(errors: Sequence[Side], square: Callable[[Side], arb]) -> list[arb]:
    """e/‖e‖, and all of [−1, 1] where the box touches the origin."""
    squares = [square(side) for side in errors]
    found = []
    for i, (low, high) in enumerate(errors):
        rest = sum((x for k, x in enumerate(squares) if k != i), arb(0))
        found.append((-_share(-low, rest)).union(_share(high, rest)))
    return found


def _share(x: float, rest: arb) -> arb:
    """An upper bound of x/√(x² + rest): for x ≥ 0 it falls with the rest, for x < 0 it grows with it."""
    if x == 0.0:
        return arb(0)
    side = rest.lower() if x > 0 else rest.upper()
    side = side if side > 0 else arb(0)
    return arb(x) / (arb(x) ** 2 + side).sqrt()
