"""How large C(q, x)x of a chain is: d'Alembert's principle in the base frame, at the worst state met.

With a_k and p_k the axis and place of joint k, c_i the centre of mass of body i: J_ik = a_k × (c_i − p_k).
The chain rule gives ȧ_k, ṗ_k and c̈_i for q̇ = x and q̈ = 0, and these the torque of each body about each axis.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from random import Random
from typing import Any

import numpy as np

from tests.statement_fuzz.oracle import kinds
from tests.statement_fuzz.oracle.climb import climbed
from tests.statement_fuzz.oracle.region import Objection

SURE = 1e-9
"""Relative; what is nearer is not judged."""


def torques(links: Sequence[Any], q: Any, x: Any) -> Any:
    """C(q, x)x for columns of angles and rates, (n, count), kg·m²/s²."""
    frame, place = np.broadcast_to(np.eye(3), (q.shape[1], 3, 3)), np.zeros((q.shape[1], 3))
    axes, places, turning, moving = [], [], [], []
    spin, result = np.zeros_like(place), np.zeros_like(q)
    for i, link in enumerate(links):
        rates = x[:i, :, None]
        axis, origin, com, inertia, turn = (
            np.array(getattr(link, name), float) for name in ("axis", "origin", "com", "inertia", "turn")
        )
        place = place + frame @ origin
        frame = frame @ turn @ _about(axis, q[i])
        a = frame @ axis
        moving.append(
            _sum(np.cross(b, place - p) * rate for b, p, rate in zip(axes, places, rates, strict=True))
        )
        turning.append(np.cross(spin, a))
        axes.append(a)
        places.append(place)
        rates = x[: i + 1, :, None]
        spin = spin + a * rates[i]
        centre = place + frame @ com
        columns = [np.cross(b, centre - p) for b, p in zip(axes, places, strict=True)]
        speed = _sum(column * rate for column, rate in zip(columns, rates, strict=True))
        pull = sum(
            (np.cross(da, centre - p) + np.cross(b, speed - dp)) * rate
            for b, p, da, dp, rate in zip(axes, places, turning, moving, rates, strict=True)
        )
        gain = _sum(da * rate for da, rate in zip(turning, rates, strict=True))
        tensor = frame @ inertia @ frame.transpose(0, 2, 1)
        moment = _apply(tensor, gain) + np.cross(spin, _apply(tensor, spin))
        for k, (b, column) in enumerate(zip(axes, columns, strict=True)):
            result[k] += (float(link.mass) * column * pull + b * moment).sum(axis=1)
    return result


def _sum(vectors: Any) -> Any:
    return sum(vectors, np.zeros(3))


def _apply(tensor: Any, vector: Any) -> Any:
    return (tensor @ vector[..., None])[..., 0]


def _about(axis: Any, angle: Any) -> Any:
    """Rotations about a unit vector, by Rodrigues' formula."""
    cross = np.cross(np.eye(3), axis)  # v ↦ axis × v
    angle = angle[:, None, None]
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def ratio(links: Sequence[Any], z: Any) -> Any:
    """‖C(q, x)x‖ / ‖x‖² of columns (q, x)."""
    q, x = z[: len(links)], z[len(links) :]
    return np.linalg.norm(torques(links, q, x), axis=0) / (x * x).sum(axis=0)


def largest(links: Sequence[Any], random: Random) -> tuple[float, Any]:
    """The largest of these that a search meets, and where."""
    n = len(links)

    def start(generator: Any, count: int) -> Any:
        angles = generator.uniform(-np.pi, np.pi, (n, count))
        return np.concatenate([angles, generator.standard_normal((n, count))])

    return climbed(lambda z: ratio(links, z), start, random)


def _least(links: Sequence[Any]) -> float:
    """What is lost in rounding, of the size of the bodies."""
    reach = sum(float(sum(abs(x) for x in (*link.origin, *link.com))) for link in links)
    inertia = sum(float(sum(abs(x) for row in link.inertia for x in row)) for link in links)
    return SURE * (sum(float(link.mass) for link in links) * reach**2 + inertia)


@kinds.objections_to("ChainCoriolisBelow")
def coriolis_below(statement: Any, random: Random) -> Objection | None:
    """A state at which ‖C(q, x)x‖ is larger."""
    reached, at = largest(statement.links, random)
    if reached <= float(statement.high) * (1 + SURE) + _least(statement.links):
        return None
    return Objection("false", f"(q, x) = {at.tolist()}, where ‖C(q, x)x‖ = {reached} ‖x‖²")


@kinds.judges("ChainCoriolisBelow")
def is_larger(statement: Any, witness: Mapping[str, Any]) -> bool | None:
    """Whether ‖C(q, x)x‖ is larger at a point."""
    n, point = len(statement.links), witness.get("point", {})
    names = [f"{letter}{k + 1}" for letter in "qx" for k in range(n)]
    if not set(names) <= set(point):
        return False
    z = np.array([[float(Fraction(point[name]))] for name in names])
    if not z[n:].any():
        return False
    reached, high = float(ratio(statement.links, z)[0]), float(statement.high)
    near = SURE * high + _least(statement.links)
    return None if abs(reached - high) <= near else reached > high
