"""Least values of c h² − f h − a U on [0, x], from below."""

from __future__ import annotations

from dataclasses import dataclass

from flint import arb

from lyapcheck.check.numbers.members import Member

DEPTH = 14
"""Halvings after which a piece is bounded as it is."""
TOLERANCE = 2.0**-11


@dataclass(frozen=True)
class Well:
    """g(x) = c h(x)² − f h(x) − a U(x) of one joint, for x ≥ 0.

    Args:
        member: h with h(x) ≥ 0 for x ≥ 0, so that U rises.
        square: c ≥ 0.
        linear: f ≥ 0.
        stored: a ≥ 0.
    """

    member: Member
    square: arb
    linear: arb
    stored: arb

    def at(self, x: float) -> arb:
        """The value at one point."""
        h = self.member.h(arb(x))
        return self.square * h * h - self.linear * h - self.stored * self.member.potential(arb(x))

    def least(self, end: float) -> arb:
        """A ball whose lower end is at most the least value on [0, end].

        Pieces on which g' has one sign have their least value at an end; the others are halved, until they
        cannot be below a value already met, or not by more than `TOLERANCE` of a U(end).
        """
        result = [arb(0), self.at(end)]
        best = result[1].upper().min(arb(0))
        enough = (self.stored * self.member.potential(arb(end))).upper() * TOLERANCE
        stack = [(0.0, end, 0)]
        while stack:
            low, high, depth = stack.pop()
            h, dh = self._ranges(low, high)
            sign = self._sign(h, dh)
            below = self._below(h, high)
            if sign:
                result.append(self.at(low if sign > 0 else high))
                best = best.min(result[-1].upper())
            elif depth == DEPTH or below >= best - enough:
                result.append(below)
            else:
                middle = 0.5 * (low + high)
                stack += [(low, middle, depth + 1), (middle, high, depth + 1)]
        return _lowest(result)

    def _ranges(self, low: float, high: float) -> tuple[arb, arb]:
        """h and h' over a piece."""
        piece = arb(low).union(arb(high))
        return self.member.h(piece), self.member.dh(piece)

    def _sign(self, h: arb, dh: arb) -> int:
        """1 where g' = h (2c h' − a) − f h' ≥ 0 on a piece, −1 where it is ≤ 0, 0 where neither is shown.

        h ≥ 0 on the piece, whatever its ball says, so that the sign of 2c h' − a is enough where f = 0.
        """
        bend = 2 * self.square * dh - self.stored
        slope = h * bend - self.linear * dh
        if slope >= 0 or (self.linear == 0 and bend >= 0):
            return 1
        return -1 if slope <= 0 or (bend <= 0 and (self.linear == 0 or dh >= 0)) else 0

    def _below(self, h: arb, high: float) -> arb:
        """A lower bound on a piece, from the ranges of its terms."""
        near, far = h.lower().max(arb(0)), h.upper()
        return (
            self.square * near * near - self.linear * far - self.stored * self.member.potential(arb(high))
        ).lower()


def _lowest(result: list[arb]) -> arb:
    """The lowest of the lower ends."""
    lowest = result[0].lower()
    for value in result:
        lowest = lowest.min(value.lower())
    return lowest
