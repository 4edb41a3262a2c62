"""The links of a chain in frames whose third axis is that of the joint, exactly."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from flint import fmpq

from lyapcheck.check.loop.chain import RigidLink
from lyapcheck.constants.storage.exact import Exact, cross, exact, unit, zeros
from lyapcheck.robots.dynamics import Chain


@dataclass(frozen=True, eq=False)
class Hinge:
    """One joint and the body that it moves, in the frame of the joint.

    Args:
        turn: from the frame of the joint before to that of this one at q = 0, 3 × 3.
        place: of the joint, in the frame of the one before, m, (3,).
        mass: kg.
        moment: mass times centre of mass, kg·m, (3,).
        inertia: about the joint, kg·m², 3 × 3.
    """

    turn: Exact
    place: Exact
    mass: fmpq
    moment: Exact
    inertia: Exact

    @property
    def carry(self) -> Exact:
        """From the twist (ω, v) of the link before to that of this one at q = 0: v is that of the joint."""
        moved = -self.turn @ cross(self.place)
        return np.block([[self.turn, zeros(3, 3)], [moved, self.turn]])

    @property
    def body(self) -> Exact:
        """The inertia G of the body: its kinetic energy is ½ VᵀGV for the twist V."""
        tilt = cross(self.moment)
        return np.block([[self.inertia, tilt], [-tilt, self.mass * unit(3)]])


def hinges(chain: Chain) -> tuple[list[Hinge], Exact]:
    """The hinges, base first, and the acceleration of free fall in the base frame, m/s²."""
    result, before = [], unit(3)
    for link in chain.links:
        own = _upright(link)
        result.append(_hinge(link, before, own))
        before = own
    return result, _column(chain.fall)


def _hinge(link: RigidLink, before: Exact, own: Exact) -> Hinge:
    """The link in new frames, given the rotations from the old ones to them."""
    com, mass = own @ _column(link.com), _column([link.mass])[0]
    tilt = cross(com)
    return Hinge(
        turn=own @ exact(link.turn).T @ before.T,
        place=before @ _column(link.origin),
        mass=mass,
        moment=mass * com,
        inertia=own @ exact(link.inertia) @ own.T - mass * (tilt @ tilt),
    )


def _upright(link: RigidLink) -> Exact:
    """A rational rotation that takes the axis to (0, 0, 1): half a turn about the line between them."""
    x, y, z = link.axis
    if z == -1:
        return exact([[1, 0, 0], [0, -1, 0], [0, 0, -1]])
    middle = _column([x, y, z + 1])
    return np.asarray(2 * np.outer(middle, middle) / (middle @ middle) - unit(3))


def _column(entries: Sequence[Fraction]) -> Exact:
    return np.asarray(exact([entries])[0])
