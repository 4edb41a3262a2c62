"""Gains as the simulation uses them: doubles, for angles in radians."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from lyapcheck.errors import argument_error
from lyapcheck.family import Family, named

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet


@dataclass(frozen=True)
class Gains:
    """One controller: τ = K_p h(e) − K_v h(w) + g(q) with e in rad, w in rad/s."""

    name: str
    family: Family
    kp: tuple[float, ...]
    """N·m (per rad where h is linear)."""
    kv: tuple[float, ...]
    written: tuple[tuple[float, ...], tuple[float, ...]]
    """(kp, kv) in the unit of the gain file."""


def gains_for(gain_set: GainSet, n: int) -> Gains:
    """The gains of a set on an arm of ``n`` joints; gains per degree are turned into gains per radian.

    Raises:
        InputError: the set has another number of joints.
    """
    if len(gain_set.kp) != n or len(gain_set.kv) != n:
        rule = f"has gains for {len(gain_set.kp)} joints, but the arm has {n}"
        raise argument_error("gains", gain_set.name, rule, "choose the arm the gains were made for")
    scale = math.degrees(1.0) if gain_set.angle_unit == "deg" else 1.0
    kp, kv = (tuple(map(float, diagonal)) for diagonal in (gain_set.kp, gain_set.kv))
    return Gains(
        name=gain_set.name,
        family=named(gain_set.family, gain_set.m),
        kp=tuple(k * scale for k in kp),
        kv=tuple(k * scale for k in kv),
        written=(kp, kv),
    )
