"""Trigonometric polynomials: exact polynomials in s_i = sin q_i and c_i = cos q_i.

A ring holds the generators s1…sn, c1…cn and one generator for each uncertain parameter, in that order.
Two polynomials describe the same function of q exactly when their normal forms modulo s_i² + c_i² = 1
are the same polynomial.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from functools import lru_cache
from typing import Any, TypeVar

from flint import Ordering, fmpq, fmpq_mpoly, fmpq_mpoly_ctx

T = TypeVar("T")
Terms = list[tuple[tuple[int, ...], Fraction]]
"""Exponents of the generators and the coefficient of each monomial."""


def trig_ring(n: int, parameters: Sequence[str] = ()) -> fmpq_mpoly_ctx:
    """The ring of trigonometric polynomials of n joints and the named parameters."""
    sines = [f"s{i}" for i in range(1, n + 1)]
    cosines = [f"c{i}" for i in range(1, n + 1)]
    return fmpq_mpoly_ctx.get((*sines, *cosines, *parameters), Ordering.lex)


@lru_cache(maxsize=256)
def _joints(names: tuple[str, ...]) -> int:
    return sum(re.fullmatch(r"s\d+", name) is not None for name in names)


def joint_count(ring: fmpq_mpoly_ctx) -> int:
    """How many joints the ring has generators for."""
    return _joints(ring.names())


def constant(ring: fmpq_mpoly_ctx, value: Fraction | int) -> fmpq_mpoly:
    """The constant polynomial of an exact value."""
    exact = Fraction(value)
    return ring.constant(fmpq(exact.numerator, exact.denominator))


def fraction(coefficient: fmpq) -> Fraction:
    """A coefficient of a polynomial as a Fraction."""
    return Fraction(int(coefficient.p), int(coefficient.q))


def to_terms(poly: fmpq_mpoly) -> Terms:
    """The polynomial as plain data, in the order of its ring."""
    return [(tuple(int(power) for power in powers), fraction(value)) for powers, value in poly.terms()]


def from_terms(ring: fmpq_mpoly_ctx, terms: Sequence[tuple[tuple[int, ...], Fraction]]) -> fmpq_mpoly:
    """The polynomial with these terms; inverse of `to_terms`."""
    return ring.from_dict({powers: fmpq(value.numerator, value.denominator) for powers, value in terms})


def derivative(poly: fmpq_mpoly, i: int) -> fmpq_mpoly:
    """The derivative with respect to the joint angle q_i, i counted from 0, in normal form.

    d/dq = cos q · ∂/∂s − sin q · ∂/∂c.
    """
    ring = poly.context()
    n = joint_count(ring)
    sine, cosine = ring.gen(i), ring.gen(n + i)
    return normal_form(cosine * poly.derivative(i) - sine * poly.derivative(n + i))


def normal_form(poly: fmpq_mpoly) -> fmpq_mpoly:
    """The representative without any s_i² of the same function of q (s_i² becomes 1 − c_i²).

    Soundness: the relations s_i² + c_i² − 1 have coprime leading terms, so they are a Gröbner basis and
    the remainder does not depend on the order of the divisions.
    """
    ring = poly.context()
    n = joint_count(ring)
    degrees = poly.degrees()
    for i in range(n):
        if degrees[i] >= 2:
            _, poly = divmod(poly, ring.gen(i) ** 2 + ring.gen(n + i) ** 2 - 1)
    return poly


def evaluate(poly: fmpq_mpoly, values: Sequence[T], lift: Callable[[Fraction], T]) -> T:
    """The value of the polynomial in any arithmetic with ``+`` and ``*``.

    Args:
        poly: the polynomial.
        values: one value for each generator of its ring, in order.
        lift: turns an exact coefficient into a value of that arithmetic.

    Soundness: as good as the arithmetic: with containing ``+``, ``*`` and ``lift`` the result contains
    the value at every point of ``values``.
    """
    return evaluate_all([to_terms(poly)], values, lift)[0]


def evaluate_all(polys: Sequence[Terms], values: Sequence[T], lift: Callable[[Fraction], T]) -> list[T]:
    """The values of several polynomials of one ring, each monomial computed once; see `evaluate`."""
    known: dict[tuple[int, ...], T] = {}

    def term(powers: tuple[int, ...], coefficient: Fraction) -> T:
        if not any(powers):
            return lift(coefficient)
        value: Any = _monomial(powers, known, values)
        result: T = value if coefficient == 1 else lift(coefficient) * value
        return result

    return [total([term(*entry) for entry in poly], lift) for poly in polys]


def _monomial(powers: tuple[int, ...], known: dict[tuple[int, ...], T], values: Sequence[Any]) -> T:
    """The product of the generators, from that of the monomial with one generator fewer."""
    if powers not in known:
        last = max(i for i, power in enumerate(powers) if power)
        rest = (*powers[:last], powers[last] - 1, *powers[last + 1 :])
        value = values[last]
        known[powers] = _monomial(rest, known, values) * value if any(rest) else value
    return known[powers]


def total(terms: Sequence[T], lift: Callable[[Fraction], T]) -> T:
    """The sum of the terms, the lifted 0 when there are none."""
    if not terms:
        return lift(Fraction(0))
    result: Any = terms[0]
    for term in terms[1:]:
        result = result + term
    final: T = result
    return final


def substitute(poly: fmpq_mpoly, values: Mapping[str, Fraction], ring: fmpq_mpoly_ctx) -> fmpq_mpoly:
    """The polynomial with the named generators replaced by exact values, as an element of ``ring``."""
    exact = {name: fmpq(value.numerator, value.denominator) for name, value in values.items()}
    return poly.subs(exact).project_to_context(ring)
