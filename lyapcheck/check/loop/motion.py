"""zᵀC(q, x)x of a chain of links at one posture, as a sum along the chain.

For rates z and x of the joints let Z and V be the twists of a link, and A its acceleration for q̇ = x and
q̈ = 0. In the frame of joint k, e the unit twist about its axis,

    Z' = Z + e z_k,   A' = A + (V × e) x_k,   V' = V + e x_k,   zᵀC(q, x)x = Σ_k Z'ᵀ(G A' + V' ×* G V').

References: recursive Newton–Euler algorithm, ``featherstone2008rigid`` chapter 5.
"""

from __future__ import annotations

from collections.abc import Sequence

from lyapcheck.check.loop.storage import TWIST, Hinge
from lyapcheck.check.numbers.vectors import ZERO, Algebra, Entry, Vector


def coriolis_power(
    of: Algebra, hinges: Sequence[Hinge], sines: Vector, cosines: Vector, z: Vector, x: Vector
) -> Entry:
    """zᵀC(q, x)x at one posture."""
    Z: Vector = [ZERO] * TWIST
    A, V, total = Z, Z, of.value(ZERO)
    for hinge, sine, cosine, rate, speed in zip(hinges, sines, cosines, z, x, strict=True):
        Z, A, V = (_turned(of, sine, cosine, of.apply(hinge.carry, part)) for part in (Z, A, V))
        bend = (V[1], of.minus(ZERO, V[0]), ZERO, V[4], of.minus(ZERO, V[3]), ZERO)
        A = of.add(A, of.scaled(speed, bend))
        Z, V = _about_axis(of, Z, rate), _about_axis(of, V, speed)
        total = total + _power(of, hinge, Z, A, V)
    return total


def _turned(of: Algebra, sine: Entry, cosine: Entry, twist: Vector) -> list[Entry]:
    """From the frame of a joint at q = 0 to that at another angle."""
    result = list(twist)
    for k in (0, 3):
        result[k] = of.dot((cosine, sine), twist[k : k + 2])
        result[k + 1] = of.minus(of.times(cosine, twist[k + 1]), of.times(sine, twist[k]))
    return result


def _about_axis(of: Algebra, twist: Vector, rate: Entry) -> list[Entry]:
    return [*twist[:2], of.plus(twist[2], rate), *twist[3:]]


def _power(of: Algebra, hinge: Hinge, Z: Vector, A: Vector, V: Vector) -> Entry:
    """Zᵀ(G A + V ×* G V)."""
    momentum = of.apply(hinge.body, V)
    torque = of.add(of.cross(V[:3], momentum[:3]), of.cross(V[3:], momentum[3:]))
    force = of.add(of.apply(hinge.body, A), [*torque, *of.cross(V[:3], momentum[3:])])
    return of.value(of.dot(Z, force))
