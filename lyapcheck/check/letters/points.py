"""Whether exact entries at one n meet what a statement for every n supposes, and break what it states."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction

from flint import ctx

from lyapcheck.check.expressions.expression import Tree, Unsupported, ball
from lyapcheck.check.letters.entries import Entries, exact
from lyapcheck.check.numbers.enclosure import ball_of

BITS = 256


def compared(left: Tree, right: Tree, point: Mapping[str, Fraction]) -> int | None:
    """The sign of right − left at a point: exactly in ℚ, else by balls; ``None`` where these do not tell.

    Raises:
        ZeroDivisionError: there is no value.
    """
    gap: Tree = ("add", right, ("neg", left))
    try:
        value = exact(gap, point)
    except Unsupported:
        with ctx.workprec(BITS):
            value = ball(gap, {name: ball_of(x) for name, x in point.items()})
            return 1 if value > 0 else -1 if value < 0 else None
    return int(value > 0) - int(value < 0)


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

    def hold(self, point: Mapping[str, Fraction]) -> bool:
        """Whether all bounds are met, as balls show; a full matrix is taken at its Frobenius norm."""
        with ctx.workprec(BITS):
            balls = {name: ball_of(value) for name, value in point.items()}
            for letters, size in self.norms:
                bound = ball(size, balls)
                if not (bound >= 0 and ball_of(self.squared(letters, point)) <= bound * bound):
                    return False
        return all(self.reaches(number, size, point) for number, size in self.least)

    def reaches(self, number: Tree, size: Tree, point: Mapping[str, Fraction]) -> bool:
        """Whether a number is at least what it is said to be."""
        return compared(size, self.entries.number(number), point) in (0, 1)

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
