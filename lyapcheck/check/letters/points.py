"""Random exact entries at one n that meet what a statement for every n supposes.

Statements that are proved in words are evaluated here once more, entry by entry, by arithmetic that shares
nothing with the words; and where a statement is false, such entries may show it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from math import isqrt
from random import Random

from flint import arb, ctx, fmpq_mat

from lyapcheck.check.expressions.expression import Tree, Unsupported, ball, variables
from lyapcheck.check.letters.entries import Entries, exact
from lyapcheck.check.numbers.enclosure import ball_of
from lyapcheck.check.numbers.polynomials import rational

Point = dict[str, Fraction]
BITS = 256
NEARLY = 1 - Fraction(1, 2**32)
"""What a number is lowered by beside its share, as the room that it has is rounded."""
MOST = 12
"""Entries are quotients of whole numbers up to this."""


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
        a = fmpq_mat([[_at(tree, point) for tree in row] for row in entries.matrix(("mat", matrix))])
        b = fmpq_mat([[exact(tree, point)] for tree in entries.vector(equals)])
        result = a.solve(b).entries()
        for (_, name), value in zip(entries.vector(("vec", vector)), result, strict=True):
            point = point | {name: Fraction(int(value.p), int(value.q))}
    return point


def _at(entry: Tree, point: Point) -> object:
    return rational(point[entry[1]])


def compared(left: Tree, right: Tree, point: Mapping[str, Fraction], certain: bool = False) -> int | None:
    """The sign of right − left at a point: exactly in ℚ, else by balls; ``None`` where these do not tell.

    Balls that agree to half of their bits count as equal, unless the answer has to be ``certain``.

    Raises:
        ZeroDivisionError: there is no value.
    """
    gap: Tree = ("add", right, ("neg", left))
    try:
        value = exact(gap, point)
        return int(value > 0) - int(value < 0)
    except Unsupported:
        pass
    with ctx.workprec(BITS):
        balls = {name: ball_of(value) for name, value in point.items()}
        result, size = ball(gap, balls), ball(("add", ("abs", left), ("abs", right)), balls)
        if result > 0 or result < 0:
            return 1 if result > 0 else -1
        if certain:
            return None
        small = abs(result) < (1 + size) * arb(2) ** (-BITS // 2)
        return 0 if small else None


@dataclass(frozen=True)
class Norms:
    """Products of norms and their bounds at one n, as :class:`BoundEveryN` states them.

    Args:
        entries: the letters entry by entry.
        norms: letters, and what the product of their norms is at most.
        least: numbers, and what they are at least.
    """

    entries: Entries
    norms: tuple[tuple[tuple[Tree, ...], Tree], ...]
    least: tuple[tuple[Tree, Tree], ...]

    def hold(self, point: Mapping[str, Fraction], certain: bool = False) -> bool:
        """Whether all bounds are met, as balls show; a full matrix is taken at its Frobenius norm."""
        with ctx.workprec(BITS):
            balls = {name: ball_of(value) for name, value in point.items()}
            for letters, size in self.norms:
                bound = ball(size, balls)
                if not (bound >= 0 and ball_of(self.squared(letters, point)) <= bound * bound):
                    return False
        for number, size in self.least:
            if compared(size, self.entries.number(number), point, certain) not in (0, 1):
                return False
        return True

    def terms(self) -> Iterator[Tree]:
        """All expressions in the bounds, entry by entry."""
        yield from (size for _, size in self.norms)
        for number, size in self.least:
            yield from (self.entries.number(number), size)

    def squared(self, letters: Iterable[Tree], point: Mapping[str, Fraction]) -> Fraction:
        """The square of a product of norms, from above."""
        product = Fraction(1)
        for letter in letters:
            product *= self._square(letter, point)
        return product

    def _square(self, letter: Tree, point: Mapping[str, Fraction]) -> Fraction:
        squares = [point[entry] ** 2 for entry in self.entries.names(letter)]
        return max(squares) if letter[0] == "diag" else sum(squares, Fraction(0))

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
                point = self._scaled(letters[0], share, point)
        return point

    def _scaled(self, letter: Tree, share: Fraction, point: Point) -> Point:
        return point | {entry: share * point[entry] for entry in dict.fromkeys(self.entries.names(letter))}

    def widened(self, names: set[str], point: Point) -> Point:
        """The point with the numbers ``names``, that only bounds speak of, put where the bounds hold.

        A number that bounds a norm is raised to it; one that a number is at least is lowered to that.
        """
        raised = {name for _, size in self.norms for name in variables(size)}
        for letters, size in self.norms:
            free = sorted(variables(size) & names)
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
            if upper is not None and rational(upper) > value:
                share = max(Fraction(int(value.p), int(value.q)), Fraction(0)) / upper * NEARLY
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
