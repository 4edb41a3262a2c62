"""P over boxes, in balls or, where those are too coarse, in spans; and over all leaves of a tree of boxes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextvars import ContextVar
from dataclasses import replace
from functools import lru_cache
from typing import Any, NamedTuple

from flint import arb

from lyapcheck.check.loop import ClosedLoop, certifies
from lyapcheck.check.loop.field import BALLS, SPANS, Arithmetic, Box, Field, Ring, Side, ball, halves, leaves
from lyapcheck.check.numbers.balls import precision, to_arb

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
        filled = self.exact  # all parameters and then B: sides of the box where they are uncertain
        if uncertain:
            own = iter(uncertain)
            filled = [self.of.value(ball(next(own))) if value is None else value for value in self.fixed]
        known = self.errors(errors)
        B = filled[len(filled) - self.loop.n :]
        return form(*self._arm(sides, uncertain, filled), known, B, self.of)

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
            values, n = self.field.at(sides, filled[: len(self.loop.parameters)], self.of), self.loop.n
            below = {(i, j): values.pop(0) for i in range(n) for j in range(i + 1)}
            M = [[below[max(i, j), min(i, j)] for j in range(n)] for i in range(n)]
            known = self.arms[place] = M, dict(zip(self.loop.symbols, values, strict=True))
        return known


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


# --- Walking a tree of boxes and showing P ≻ 0 on each leaf.


BITS = 64
BLOCK = 64
MORE_HALVINGS = 12
"""How much deeper than its tree a box may be cut: balls may be wider than the intervals of the search."""
WORTH_SHARING = 20_000
"""Characters of a tree from which a second process pays for its start."""
SHARE: ContextVar[Callable[..., bool]] = ContextVar(
    "share", default=lambda judge, *about: judge(*about, 0, 1)
)
"""Whether ``judge(*about, part, parts)`` holds for every part from 0 on; here there is one."""


def proves(loop: ClosedLoop, tree: str) -> bool:
    """Whether a tree of boxes proves dV/dt < 0 at every state but the origin.

    The tree is in preorder, a digit for the side of ``loop.start`` that is cut, a dot for a leaf; raises
    ``BrokenTree`` if it is none. ``False`` says nothing about the statement.

    Soundness: what lies outside the start is an image under a symmetry or has ‖e‖ ≥ R; the leaves cover it.
    """
    if len(tree) < WORTH_SHARING:
        return proves_part(loop, tree, 0, 1)
    return SHARE.get()(proves_part, replace(loop), tree)  # the copy leaves behind what the loop has computed


def proves_part(loop: ClosedLoop, tree: str, part: int, parts: int) -> bool:
    """The share of `proves` that falls to one of several processes: every leaf in turn, by its number.

    Soundness: the tree proves the statement if all its parts are ``True``.
    """
    if not loop.admissible:
        return False
    boxes = leaves(loop.start, tree)
    if certifies(loop.tail, loop.eps0):
        return all(True for _ in boxes)  # the tree is read to its end, though no box need be judged
    with precision(BITS):
        means = Evaluator(loop, BALLS), Evaluator(loop, SPANS)
        # blocks, not single leaves: neighbours share the ranges that the evaluator keeps
        mine = (box for k, box in enumerate(boxes) if k // BLOCK % parts == part)
        return all(_shown(means, box) for box in mine)


def _shown(means: Sequence[Evaluator], box: Box) -> bool:
    """Whether P ≻ 0 is shown on a box, by one of the means, cut further where that is needed.

    The side that is cut is the widest beside what it was at the start. Spans, the last means, cost
    several times what balls do: halves are tried without them first.
    """
    start = means[0].loop.start
    stack = [(box, 0)]
    while stack:
        part, depth = stack.pop()
        if any(one.proves(part) for one in (means if depth else means[:-1])):
            continue
        if depth == MORE_HALVINGS:
            return False
        sides = range(len(part))
        side = max(sides, key=lambda i: (part[i][1] - part[i][0]) / (start[i][1] - start[i][0]))
        stack += [(half, depth + 1) for half in halves(part, side)]
    return True
