"""What links say of polynomials: whether they make a given M(q) or g_i(q), and how large a g_i is at most."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from fractions import Fraction
from functools import lru_cache
from typing import Any

from flint import Ordering, fmpq, fmpq_mpoly, fmpq_mpoly_ctx

from lyapcheck.check.loop.chain import Posture, RigidLink
from lyapcheck.check.numbers.polynomials import rational, root_above
from lyapcheck.check.numbers.vectors import ZERO, Algebra
from lyapcheck.check.statement import Monomials

Reduce = Callable[[fmpq_mpoly], fmpq_mpoly]


def makes(links: Sequence[RigidLink], mass: Sequence[Sequence[Monomials]]) -> bool:
    """Whether these are real links whose M(q) has these entries, polynomials in sin q_1 …, cos q_1 … cos q_n.

    Soundness: both sides are reduced by s² = 1 − c², after which equal functions are equal polynomials.
    """
    if len(links) != len(mass) or not all(link.fits for link in links):
        return False
    n, (ring, reduced) = len(links), _ring(len(links))
    rows = _posture(links, ring, reduced).mass()
    return all(
        reduced(ring.from_dict(_terms(mass[i][j])) - rows[i][j]) == 0 for i in range(n) for j in range(n)
    )


def pulls(links: tuple[RigidLink, ...], fall: tuple[Fraction, ...], i: int, torque: Monomials) -> bool:
    """Whether this is g_i(q) for all q, i counted from 0; as polynomials, like `makes`."""
    ring, reduced, torques = _torques(links, fall)
    return bool(reduced(ring.from_dict(_terms(torque)) - torques[i]) == 0)


@lru_cache(maxsize=64)
def _torques(
    links: tuple[RigidLink, ...], fall: tuple[Fraction, ...]
) -> tuple[fmpq_mpoly_ctx, Reduce, list[fmpq_mpoly]]:
    ring, reduced = _ring(len(links))
    return ring, reduced, _posture(links, ring, reduced).torques(fall)


def lever_bound(
    links: Sequence[RigidLink],
    fall: Sequence[Fraction],
    i: int,
    along: Collection[int],
    root: Callable[[Any], Any] = root_above,
) -> Fraction:
    """A bound of |g_i(q)| for all q, i counted from 0, of links with unit axes and rotations.

    Soundness: g_i = (a_i × fall)·v_i in the frame of joint i, where v_k = c_k + R_{k+1} v_{k+1} with constant
        c_k, so |v_k| ≤ Σ |c|. R_k turns about a_k: what c_k has along it can be counted at the link before
        instead (k in ``along``), and at joint i itself exerts no torque.
    """
    of = Algebra(Fraction)
    total, mass, carried = ZERO, ZERO, [ZERO] * 3
    for k in range(len(links) - 1, i - 1, -1):
        link = links[k]
        moment = of.add(of.scaled(link.mass, link.com), carried)
        mass, carried = mass + link.mass, [ZERO] * 3
        if k == i or k in along:
            carried = of.apply(link.turn, of.scaled(of.dot(link.axis, moment), link.axis))
            moment = of.cross(link.axis, moment)  # as long as what is left
        carried = of.add(carried, of.scaled(mass, link.origin))
        total += root(of.dot(moment, moment))
    return Fraction(total * root(of.dot(fall, fall)))


def _ring(n: int) -> tuple[fmpq_mpoly_ctx, Reduce]:
    """Polynomials in the sines and then the cosines, and their normal form without squares of sines."""
    ring = fmpq_mpoly_ctx.get([f"{letter}{i}" for letter in "sc" for i in range(n)], Ordering.lex)
    gens = ring.gens()

    def reduced(polynomial: fmpq_mpoly) -> fmpq_mpoly:
        degrees = polynomial.degrees()
        for i in range(n):
            if degrees[i] >= 2:
                _, polynomial = divmod(polynomial, gens[i] ** 2 + gens[n + i] ** 2 - 1)
        return polynomial

    return ring, reduced


def _posture(links: Sequence[RigidLink], ring: fmpq_mpoly_ctx, reduced: Reduce) -> Posture:
    n, gens = len(links), ring.gens()
    return Posture(links, gens[:n], gens[n:], Algebra(lambda x: ring.constant(rational(x)), reduced))


def _terms(entry: Monomials) -> dict[tuple[int, ...], fmpq]:
    result: dict[tuple[int, ...], fmpq] = {}
    for powers, c in entry:
        result[powers] = result.get(powers, fmpq(0)) + rational(c)
    return result
