"""An arm at the corners of the ranges of M's parameters, which speak for all that lies between.

At one state −dV/dt = ε hᵀK_p h + yᵀ(B + K_v D + ε S)w, and S is linear in M(q) and its rates. So where M is
affine in each parameter, dV/dt is so too, and nowhere above the largest of its values at the corners of their
ranges; likewise λmax of M and of what is linear in it.

References: ``reyes2019family`` (11), (15).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from lyapcheck.check.limits import MOST_CORNERS
from lyapcheck.check.loop.affine import at_corner, corners_of, is_affine
from lyapcheck.check.loop.closed_loop import ClosedLoop
from lyapcheck.check.loop.states import Arm
from lyapcheck.check.refusal import require
from lyapcheck.check.statement import Ends, Monomials

Mass = tuple[tuple[Monomials, ...], ...]


def masses_at_corners(mass: Mass, parameters: Sequence[Ends]) -> tuple[Mass, ...]:
    """M(q) with numbers for its parameters, one for each corner, in the order of ``corners_of``.

    Raises:
        Refused: M is not affine in each of them, or they have too many corners.
    """
    n = len(mass)
    require(is_affine(mass, n), "M(q)", "", "must be affine in each of its parameters")
    ranging = sum(low < high for low, high in parameters)
    require(2**ranging <= MOST_CORNERS, "corners", 2**ranging, f"must not exceed {MOST_CORNERS}")
    return tuple(
        tuple(tuple(at_corner(entry, 2 * n, corner) for entry in row) for row in mass)
        for corner in corners_of(parameters)
    )


def at_corners(loop: ClosedLoop) -> tuple[ClosedLoop, ...]:
    """The loop at each corner; by itself where it has no parameters.

    Raises:
        Refused: as `masses_at_corners`.
    """
    if not loop.parameters:
        return (loop,)
    masses = masses_at_corners(loop.arm.mass, loop.parameters)
    return tuple(replace(loop, arm=Arm(mass, loop.arm.viscous), parameters=()) for mass in masses)
