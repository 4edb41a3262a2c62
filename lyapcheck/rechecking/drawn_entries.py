"""Random exact entries at one n that meet what a statement for every n supposes.

Statements that words prove are evaluated here once more, entry by entry, by arithmetic that shares nothing
with the words: before a proof is handed over, and whenever one is rechecked. A doubt refuses a proof, and
accepts none. Where a statement is false, such entries may show it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from itertools import islice
from math import isqrt
from random import Random

from flint import arb, ctx, fmpq_mat

from lyapcheck.check import verify
from lyapcheck.check.expressions.expression import Tree, Unsupported, ball, variables
from lyapcheck.check.kinds import bound_every_n, every_n
from lyapcheck.check.kinds.bound_every_n import BoundEveryN
from lyapcheck.check.kinds.every_n import EveryN
from lyapcheck.check.letters import letters as letters_of
from lyapcheck.check.letters.entries import BITS, Entries, exact
from lyapcheck.check.letters.entries import compared as exactly_compared
from lyapcheck.check.numbers.polynomials import ball_of, fraction, rational
from lyapcheck.check.refusal import require

Point = dict[str, Fraction]
NEARLY = 1 - Fraction(1, 2**32)
"""What a number is lowered by beside its share, as the room that it has is rounded."""
MOST = 12
"""Entries are quotients of whole numbers up to this."""
SIZES = (1, 2, 3)
TRIES = 12
"""How often entries are drawn for each n: some make a matrix singular."""
TRIES_WITHIN, ENOUGH = 400, 4
"""How often they are drawn where norms are bounded, and how many that meet the bounds are enough."""


def drawn(names: Iterable[str], positive: Iterable[str], random: Random) -> Point:
    """A number for each name, never 0; about half of the letters are given positive entries alone."""
    above, point = frozenset(positive), {}
    upright: dict[str, bool] = {}
    for name in sorted(names):
        letter = name.split("[")[0]
        if letter not in upright:
            upright[letter] = letter in above or random.random() < 1 / 2
        value = Fraction(random.randint(1, MOST), random.randint(1, MOST))
        point[name] = value if upright[letter] or random.random() < 1 / 2 else -value
    return point


def solved(entries: Entries, given: Iterable[tuple[str, str, Tree]], point: Point) -> Point:
    """The point with x, for each A x = b that is given, put at A⁻¹ b.

    Raises:
        ZeroDivisionError: some A is singular there.
        Unsupported: b leaves the rational numbers.
    """
    for matrix, vector, equals in given:
        rows = entries.matrix(("mat", matrix))
        a = fmpq_mat([[rational(point[name]) for _, name in row] for row in rows])
        b = fmpq_mat([[exact(tree, point)] for tree in entries.vector(equals)])
        result = a.solve(b).entries()
        for (_, name), value in zip(entries.vector(("vec", vector)), result, strict=True):
            point = point | {name: fraction(value)}
    return point


def compared(left: Tree, right: Tree, point: Mapping[str, Fraction]) -> int | None:
    """The sign of right − left at a point as the checker sees it; 0 for balls that agree to half their bits.

    Raises:
        ZeroDivisionError: there is no value.
    """
    sign = exactly_compared(left, right, point)
    if sign is not None:
        return sign
    with ctx.workprec(BITS):
        balls = {name: ball_of(value) for name, value in point.items()}
        gap = ball(("add", right, ("neg", left)), balls)
        size = ball(("add", ("abs", left), ("abs", right)), balls)
        return 0 if abs(gap) < (1 + size) * arb(2) ** (-BITS // 2) else None


class DrawnBounds:
    """The bounds of a statement at one n, and points put where they are met."""

    def __init__(self, statement: BoundEveryN, n: int) -> None:
        self.entries = Entries(n, statement.symmetric, dict(statement.rates))
        self.norms, self.least = statement.norms, statement.least
        self.pairs = list(bound_every_n.bounds_at(statement, n))

    def hold(self, point: Mapping[str, Fraction]) -> bool:
        """Whether all bounds are met, or nearly."""
        return all(compared(*pair, point) in (0, 1) for pair in self.pairs)

    def squared(self, letters: Iterable[Tree], point: Mapping[str, Fraction]) -> Fraction:
        """The square of a product of norms, from above."""
        result = Fraction(1)
        for letter in letters:
            squares = [point[entry] ** 2 for entry in self.entries.names(letter)]
            result *= max(squares) if letter[0] == "diag" else sum(squares, Fraction(0))
        return result

    def upright(self, point: Point) -> Point:
        """The point with matrices in lower bounds, as diag(k) in xᵀdiag(k)x >= …, made positive definite."""
        for letter in {letter for number, _ in self.least for letter in _matrices(number)}:
            entries = {entry: abs(point[entry]) for entry in self.entries.names(letter)}
            if letter[0] == "mat":
                whole = sum(entries.values(), Fraction(0))
                rows = self.entries.matrix(letter)
                entries = {rows[i][i][1]: whole for i in self.entries.joints}
            point = point | entries
        return point

    def shrunk(self, point: Point) -> Point:
        """The point with letters made smaller until bounds by plain numbers hold."""
        for letters, size in self.norms:
            upper = _value(size, {})
            square = self.squared(letters, point)
            if upper is not None and square > upper * upper:
                share = upper / _root_above(square)
                names = dict.fromkeys(self.entries.names(letters[0]))
                point = point | {entry: share * point[entry] for entry in names}
        return point

    def widened(self, names: set[str], point: Point) -> Point:
        """The point with the numbers ``names``, that only bounds speak of, put where the bounds hold.

        A number that bounds a norm is raised to it; one that a number is at least is lowered to that.
        """
        raised = {name for _, size in self.norms for name in variables(size)}
        alone = {size[1] for _, size in self.least if size[0] == "var"} & names
        for number, size in self.least:
            if size[0] == "var" and size[1] in alone:
                value = exact(self.entries.number(number), point)
                least = max(fraction(value), Fraction(0)) * NEARLY
                point = point | {size[1]: min(point[size[1]], least)}
        for letters, size in self.norms:
            free = sorted(variables(size) & names - alone) or sorted(variables(size) & names)
            if not free:
                continue
            square, upper = self.squared(letters, point), _value(size, point)
            if upper is not None and square > upper * upper:
                rest = upper / point[free[-1]]
                point = point | {free[-1]: _root_above(square) / rest if rest else point[free[-1]]}
        for number, size in self.least:
            free = sorted((variables(size) & names) - raised)
            if not free:
                continue
            upper, value = _value(size, point), exact(self.entries.number(number), point)
            if upper and rational(upper) > value:
                share = max(fraction(value), Fraction(0)) / upper * NEARLY
                point = point | {free[-1]: share * point[free[-1]]}
        return point


def _matrices(tree: Tree) -> set[Tree]:
    """The matrices of an expression."""
    if tree[0] in ("diag", "mat"):
        return {tree}
    return set().union(*(_matrices(part) for part in tree[1:] if isinstance(part, tuple)))


def _value(size: Tree, point: Mapping[str, Fraction]) -> Fraction | None:
    """A rational not above a size; ``None`` where it depends on more than the point."""
    names = variables(size)
    if not names <= point.keys():
        return None
    with ctx.workprec(BITS):
        value = ball(size, {name: ball_of(point[name]) for name in names})
        if not value.is_finite():
            return None
        low = value.lower().max(arb(0))
        scale = 1 << 64
        return Fraction(int((low * scale).floor().unique_fmpz() or 0), scale)


def _root_above(square: Fraction) -> Fraction:
    """A short rational not below a square root."""
    scale = 1 << 64
    return Fraction(isqrt(square.numerator * scale * scale // square.denominator) + 1, scale)


def signs_at_entries(statement: EveryN) -> Iterator[int | None]:
    """The sign of right − left at random exact entries for some n; ``None`` where none were found."""
    random = Random(repr(statement))
    for n in SIZES:
        (left, right), equations = every_n.at_size(statement, n)
        names = every_n.names_at((left, right), equations)
        for _ in range(TRIES):
            try:
                point = solved_at(statement, n, drawn(names, statement.positive, random))
                given = all(compared(*pair, point) == 0 for pair in equations)
                sign = compared(left, right, point) if given else None
            except (ZeroDivisionError, Unsupported):
                continue
            if sign is not None:
                yield sign
                break
        else:
            yield None


def solved_at(statement: EveryN, n: int, point: Point) -> Point:
    """The point with the vectors that are given by a matrix put where that is met."""
    entries = Entries(n, statement.symmetric, dict(statement.rates))
    return solved(entries, ((one.matrix, one.vector, one.equals) for one in statement.given), point)


def drawn_entries(
    statement: BoundEveryN, tries: int, sizes: Sequence[int] = SIZES
) -> Iterator[tuple[int, Point, int]]:
    """n, random exact entries that meet all bounds, and there the sign of right − left."""
    random, numbers = Random(repr(statement)), statement.numbers
    written = {name for kind, name in letters_of(statement.left) if kind == "var"}
    only_bounds = numbers - written
    at = {}
    for n in sizes:
        bounds, (sides, equations) = DrawnBounds(statement, n), bound_every_n.at_size(statement, n)
        names = bound_every_n.names_at(statement, n, [sides, *equations, *bounds.pairs])
        at[n] = sides, equations, bounds, names
    for _ in range(tries):
        for n, (sides, equations, bounds, names) in at.items():
            try:
                point = bounds.shrunk(bounds.upright(drawn(names, numbers, random)))
                point = bounds.widened(only_bounds, solved_at(statement.identity, n, point))
                given = all(compared(*pair, point) == 0 for pair in equations)
                sign = compared(*sides, point) if given and bounds.hold(point) else None
            except (ZeroDivisionError, Unsupported):
                continue
            if sign is not None:
                yield n, point, sign


def doubt_identity(statement: EveryN) -> None:
    """Refuse an identity where entries make its sides differ, or where none are found that it speaks of."""
    for sign in signs_at_entries(statement):
        require(sign is not None, "entries", "", "at which both sides can be compared were not found")
        require(sign == 0, "entries", "", "make sides differ whose words are equal: the words are at fault")


def doubt_bound(statement: BoundEveryN) -> None:
    """Refuse a bound that entries exceed, or whose suppositions none are found to meet."""
    signs = [sign for _, _, sign in islice(drawn_entries(statement, TRIES_WITHIN), ENOUGH)]
    require(len(signs) > 0, "entries", "", "that meet the bounds of the norms were not found")
    require(
        -1 not in signs, "entries", "", "exceed the bound, though its words do not: the words are at fault"
    )


def install() -> None:
    """Have what the checker proves doubted, in this process."""
    verify.DOUBTS.update({EveryN: doubt_identity, BoundEveryN: doubt_bound})
