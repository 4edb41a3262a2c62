"""Trigonometric polynomials, exact in s_i = sin q_i and c_i = cos q_i, and an arm that they make.

A ring holds the generators s1…sn, c1…cn and one generator for each uncertain parameter, in that order.
Two polynomials describe the same function of q exactly when their normal forms modulo s_i² + c_i² = 1
are the same polynomial.
"""

from __future__ import annotations

import re
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, lru_cache, reduce
from itertools import product
from operator import add
from typing import Any, Protocol, TypeVar

from flint import Ordering, fmpq_mpoly, fmpq_mpoly_ctx

from lyapcheck.check.numbers.polynomials import fraction, rational

T = TypeVar("T")
Lift = Callable[[Fraction], T]
Tidy = Callable[[Any], Any] | None
Values = Mapping[str, Any]
Rows = list[list[Any]]
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
    return ring.constant(rational(value))


def to_terms(poly: fmpq_mpoly) -> Terms:
    """The polynomial as plain data, in the order of its ring."""
    return [(tuple(int(power) for power in powers), fraction(value)) for powers, value in poly.terms()]


def from_terms(ring: fmpq_mpoly_ctx, terms: Sequence[tuple[tuple[int, ...], Fraction]]) -> fmpq_mpoly:
    """The polynomial with these terms; inverse of `to_terms`."""
    return ring.from_dict({powers: rational(value) for powers, value in terms})


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


def substitute(poly: fmpq_mpoly, values: Mapping[str, Fraction], ring: fmpq_mpoly_ctx) -> fmpq_mpoly:
    """The polynomial with the named generators replaced by exact values, as an element of ``ring``."""
    return poly.subs({name: rational(value) for name, value in values.items()}).project_to_context(ring)


# --- M, C, g and the potential of an arm, at some angles and as polynomials.


class ArmAtAngles(Protocol):
    """An arm at some angles, in the arithmetic of their sines and cosines.

    Soundness: with containing ``+``, ``-``, ``*`` and numbers the results contain the exact ones.
    """

    def mass(self) -> Rows:
        """M(q), (n, n), kg·m²."""

    def coriolis(self, x: Sequence[Any]) -> Rows:
        """C(q, x) of the Christoffel symbols of M, (n, n), kg·m²/s, for rates x (n,), rad/s."""

    def gravity(self) -> list[Any]:
        """g(q) = ∂U/∂q, (n,), N·m."""

    def potential(self) -> Any:
        """U(q), J."""


class Dynamics(ABC):
    """M(q), C(q, x), g(q) and the potential energy of n revolute joints, with exact numbers and parameters.

    Args:
        n: number of joints.
        names: of the parameters.
    """

    n: int
    names: tuple[str, ...]

    @abstractmethod
    def at(
        self, sin: Sequence[T], cos: Sequence[T], values: Values, lift: Lift[T], tidy: Tidy = None
    ) -> ArmAtAngles:
        """The arm at some angles.

        Args:
            sin: sines of the angles, (n,), in any arithmetic.
            cos: (n,).
            values: of the parameters by name.
            lift: turns an exact number into a value of that arithmetic.
            tidy: brings values on the way into a form that stays short.
        """

    @property
    @abstractmethod
    def polynomials(self) -> Polynomials:
        """The same as polynomials; raises `TooManyTerms` where those are not worth writing out."""

    @abstractmethod
    def fixed(self, values: Mapping[str, Fraction]) -> Dynamics:
        """The same with exact numbers for all parameters."""


@dataclass(frozen=True, eq=False)
class Polynomials(Dynamics):
    """M and the potential as polynomials in s1 … sn, c1 … cn and the parameters, in normal form.

    Args:
        mass: M(q), rows of polynomials, kg·m².
        potential: J.
        names: of the parameters, in the order of their generators.
    """

    mass: tuple[tuple[fmpq_mpoly, ...], ...]
    potential: fmpq_mpoly
    names: tuple[str, ...] = ()

    @property
    def n(self) -> int:  # type: ignore[override]
        return len(self.mass)

    @property
    def polynomials(self) -> Polynomials:
        return self

    @cached_property
    def christoffel(self) -> tuple[tuple[tuple[fmpq_mpoly, ...], ...], ...]:
        """c_ijk = ½(∂M_ij/∂q_k + ∂M_ik/∂q_j − ∂M_jk/∂q_i), so that C(q,x)_ij = Σ_k c_ijk x_k."""
        joints = range(self.n)
        slope = [[[derivative(entry, k) for k in joints] for entry in row] for row in self.mass]
        return tuple(
            tuple(
                tuple((slope[i][j][k] + slope[i][k][j] - slope[j][k][i]) / 2 for k in joints) for j in joints
            )
            for i in joints
        )

    @cached_property
    def gravity(self) -> tuple[fmpq_mpoly, ...]:
        """g(q) = ∂potential/∂q, N·m."""
        return tuple(derivative(self.potential, i) for i in range(self.n))

    @cached_property
    def mass_terms(self) -> dict[tuple[int, int], Terms]:
        """On and above the diagonal."""
        return {(i, j): to_terms(self.mass[i][j]) for i in range(self.n) for j in range(i, self.n)}

    @cached_property
    def symbol_terms(self) -> dict[tuple[int, int, int], Terms]:
        """The symbols that are not 0."""
        places = product(range(self.n), repeat=3)
        return {(i, j, k): to_terms(c) for i, j, k in places if (c := self.christoffel[i][j][k]) != 0}

    @cached_property
    def gravity_terms(self) -> list[Terms]:
        return [to_terms(entry) for entry in self.gravity]

    def at(
        self, sin: Sequence[T], cos: Sequence[T], values: Values, lift: Lift[T], tidy: Tidy = None
    ) -> ArmAtAngles:
        return _Evaluated(self, [*sin, *cos, *(values[name] for name in self.names)], lift)

    def fixed(self, values: Mapping[str, Fraction]) -> Polynomials:
        ring = trig_ring(self.n)
        mass = tuple(tuple(substitute(entry, values, ring) for entry in row) for row in self.mass)
        return Polynomials(mass, substitute(self.potential, values, ring))

    def __getstate__(self) -> dict[str, Any]:
        """Plain terms: polynomials of python-flint cannot be pickled."""
        rows = [[to_terms(entry) for entry in row] for row in self.mass]
        return {"mass": rows, "potential": to_terms(self.potential), "names": self.names}

    def __setstate__(self, state: dict[str, Any]) -> None:
        ring = trig_ring(len(state["mass"]), state["names"])
        mass = tuple(tuple(from_terms(ring, terms) for terms in row) for row in state["mass"])
        potential = from_terms(ring, state["potential"])
        self.__dict__.update(mass=mass, potential=potential, names=state["names"])


class _Evaluated(ArmAtAngles):
    """The values of polynomials; each monomial is computed once for each question."""

    def __init__(self, of: Polynomials, point: Sequence[Any], lift: Lift[Any]) -> None:
        self._of, self._point, self._lift = of, point, lift

    def mass(self) -> Rows:
        known = dict(zip(self._of.mass_terms, self._values(self._of.mass_terms.values()), strict=True))
        joints = range(self._of.n)
        return [[known[min(i, j), max(i, j)] for j in joints] for i in joints]

    def coriolis(self, x: Sequence[Any]) -> Rows:
        terms: dict[tuple[int, int], list[Any]] = {}
        symbols = self._of.symbol_terms
        for (i, j, k), symbol in zip(symbols, self._values(symbols.values()), strict=True):
            terms.setdefault((i, j), []).append(symbol * x[k])
        joints = range(self._of.n)
        return [[self._total(terms.get((i, j), [])) for j in joints] for i in joints]

    def gravity(self) -> list[Any]:
        return self._values(self._of.gravity_terms)

    def potential(self) -> Any:
        return self._values([to_terms(self._of.potential)])[0]

    def _values(self, polys: Iterable[Terms]) -> list[Any]:
        known: dict[tuple[int, ...], Any] = {}

        def monomial(powers: tuple[int, ...]) -> Any:
            """The product of the generators, from that of the monomial with one generator fewer."""
            if powers not in known:
                last = max(i for i, power in enumerate(powers) if power)
                rest = (*powers[:last], powers[last] - 1, *powers[last + 1 :])
                known[powers] = monomial(rest) * self._point[last] if any(rest) else self._point[last]
            return known[powers]

        def term(powers: tuple[int, ...], coefficient: Fraction) -> Any:
            if not any(powers):
                return self._lift(coefficient)
            return monomial(powers) if coefficient == 1 else self._lift(coefficient) * monomial(powers)

        return [self._total([term(*entry) for entry in poly]) for poly in polys]

    def _total(self, terms: Sequence[Any]) -> Any:
        return reduce(add, terms) if terms else self._lift(Fraction(0))
