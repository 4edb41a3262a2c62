"""The links of a chain in frames whose third axis is that of the joint, as arrays of exact numbers."""

from __future__ import annotations

from dataclasses import dataclass

from flint import fmpq

from lyapcheck.check.loop import storage
from lyapcheck.check.numbers.polynomials import rational
from lyapcheck.constants.storage.exact import Exact, exact
from lyapcheck.robots.dynamics import Chain


@dataclass(frozen=True, eq=False)
class Hinge:
    """See `lyapcheck.check.loop.storage.Hinge`.

    Args:
        turn: 3 × 3.
        mass: kg.
        moment: kg·m, (3,).
        carry: 6 × 6.
        body: 6 × 6.
    """

    turn: Exact
    mass: fmpq
    moment: Exact
    carry: Exact
    body: Exact


def hinges(chain: Chain) -> tuple[list[Hinge], Exact]:
    """The hinges, base first, and the acceleration of free fall in the base frame, m/s²."""
    result = [
        Hinge(
            exact(hinge.turn),
            rational(hinge.mass),
            exact([hinge.moment])[0],
            exact(hinge.carry),
            exact(hinge.body),
        )
        for hinge in storage.hinges(chain.links)
    ]
    return result, exact([chain.fall])[0]
