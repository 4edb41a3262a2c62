"""Least values of c h² − f h − a U on [0, x], from below."""

from __future__ import annotations

from dataclasses import dataclass

from flint import arb

from lyapcheck.check.members import Member

DEPTH = 14
"""Halvings after which a piece is bounded as it is."""


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

        Pieces on which g' has one sign have their least value at an end; the others are halved, down to
        `DEPTH`, or until they cannot be below a value already met.
        """
        found = [arb(0), self.at(end)]
        best = found[1].upper().min(arb(0))
        stack = [(0.0, end, 0)]
        while stack:
            low, high, depth = stack.pop()
            piece = arb(low).union(arb(high))
            h = self.member.h(piece)
            slope = self.member.dh(piece) * (2 * self.square * h - self.linear) - self.stored * h
            below = self._below(h, high)
            if slope >= 0 or slope <= 0:
                found.append(self.at(low if slope >= 0 else high))
                best = best.min(found[-1].upper())
            elif depth == DEPTH:
                found.append(below)
            elif not below >= best:
                middle = 0.5 * (low + high)
                stack += [(low, middle, depth + 1), (middle, high, depth + 1)]
        return _lowest(found, best)

    def _below(self, h: arb, high: float) -> arb:
        """A lower bound on a piece, from the ranges of its terms."""
        near, far = h.lower().max(arb(0)), h.upper()
        return (
            self.square * near * near - self.linear * far - self.stored * self.member.potential(arb(high))
        ).lower()


def _lowest(found: list[arb], best: arb) -> arb:
    """The lowest of the lower ends; pieces that were left out have no value below ``best``."""
    lowest = best
    for value in found:
        lowest = lowest.min(value.lower())
    return lowest.lower()
