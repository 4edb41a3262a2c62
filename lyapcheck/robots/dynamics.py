"""M, C, g and the potential of an arm in any arithmetic, from polynomials or from links.

Up to three joints the polynomials are the shortest form. With more they grow tenfold a joint where axes are
skew, and a chain of links is evaluated along the links.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from fractions import Fraction
from functools import cached_property
from itertools import product
from typing import Any, Protocol, TypeVar

from flint import fmpq_mpoly

from lyapcheck.check.loop.chain import RigidLink
from lyapcheck.check.numbers.vectors import Algebra, Entry
from lyapcheck.errors import InputError, Problem
from lyapcheck.robots import trig
from lyapcheck.robots.chain import ChainInMotion

T = TypeVar("T")
Lift = Callable[[Fraction], T]
Tidy = Callable[[Any], Any] | None
Values = Mapping[str, Any]
Rows = list[list[Any]]

FEW_JOINTS = 3
"""Up to so many joints all angles are gone through: M(q) by its polynomials, bounds and proofs by boxes.

With more, what is known of the links takes their place.
"""
MOST_TERMS = 2_500
"""Terms of one polynomial beyond which M(q) is not written out; a Panda has 805, a skew chain 5ⁿ⁻¹."""


class TooManyTerms(InputError):
    """M(q) has more terms than are worth writing out."""


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
        slope = [[[trig.derivative(entry, k) for k in joints] for entry in row] for row in self.mass]
        return tuple(
            tuple(
                tuple((slope[i][j][k] + slope[i][k][j] - slope[j][k][i]) / 2 for k in joints) for j in joints
            )
            for i in joints
        )

    @cached_property
    def gravity(self) -> tuple[fmpq_mpoly, ...]:
        """g(q) = ∂potential/∂q, N·m."""
        return tuple(trig.derivative(self.potential, i) for i in range(self.n))

    @cached_property
    def mass_terms(self) -> dict[tuple[int, int], trig.Terms]:
        return {(i, j): trig.to_terms(self.mass[i][j]) for i in range(self.n) for j in range(i, self.n)}

    @cached_property
    def symbol_terms(self) -> dict[tuple[int, int, int], trig.Terms]:
        places = product(range(self.n), repeat=3)
        return {(i, j, k): trig.to_terms(c) for i, j, k in places if (c := self.christoffel[i][j][k]) != 0}

    @cached_property
    def gravity_terms(self) -> list[trig.Terms]:
        return [trig.to_terms(entry) for entry in self.gravity]

    def at(
        self, sin: Sequence[T], cos: Sequence[T], values: Values, lift: Lift[T], tidy: Tidy = None
    ) -> ArmAtAngles:
        return _Evaluated(self, [*sin, *cos, *(values[name] for name in self.names)], lift)

    def fixed(self, values: Mapping[str, Fraction]) -> Polynomials:
        ring = trig.trig_ring(self.n)
        mass = tuple(tuple(trig.substitute(entry, values, ring) for entry in row) for row in self.mass)
        return Polynomials(mass, trig.substitute(self.potential, values, ring))

    def __getstate__(self) -> dict[str, Any]:
        """Plain terms: polynomials of python-flint cannot be pickled."""
        rows = [[trig.to_terms(entry) for entry in row] for row in self.mass]
        return {"mass": rows, "potential": trig.to_terms(self.potential), "names": self.names}

    def __setstate__(self, state: dict[str, Any]) -> None:
        ring = trig.trig_ring(len(state["mass"]), state["names"])
        mass = tuple(tuple(trig.from_terms(ring, terms) for terms in row) for row in state["mass"])
        potential = trig.from_terms(ring, state["potential"])
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
        return [[trig.total(terms.get((i, j), []), self._lift) for j in joints] for i in joints]

    def gravity(self) -> list[Any]:
        return self._values(self._of.gravity_terms)

    def potential(self) -> Any:
        return trig.evaluate(self._of.potential, self._point, self._lift)

    def _values(self, polys: Iterable[trig.Terms]) -> list[Any]:
        return trig.evaluate_all(list(polys), self._point, self._lift)


@dataclass(frozen=True)
class ParameterShare:
    """A number of a link that is ``factor`` times a parameter."""

    name: str
    factor: Fraction = Fraction(1)


@dataclass(frozen=True, eq=False)
class Chain(Dynamics):
    """A serial chain of links.

    Args:
        links: base first; a number is exact, or a ``ParameterShare`` of a parameter.
        fall: acceleration of free fall in the base frame, (3,), m/s²; likewise.
        names: of the parameters.
    """

    links: tuple[RigidLink, ...]
    fall: tuple[Any, ...]
    names: tuple[str, ...] = ()

    @property
    def n(self) -> int:  # type: ignore[override]
        return len(self.links)

    @cached_property
    def polynomials(self) -> Polynomials:
        """The recursion in polynomials, each brought to normal form as it comes."""
        ring = trig.trig_ring(self.n, self.names)

        def tidy(poly: fmpq_mpoly) -> fmpq_mpoly:
            if len(poly) > MOST_TERMS:
                rule = f"has more than {MOST_TERMS} terms for these {self.n} links, too many to write out"
                repair = "give an arm of fewer joints, or with axes along or across each other"
                repair += "; in a URDF file write a right angle as 1.57079632679"
                raise TooManyTerms(Problem("arm", None, "M(q)", "", rule, repair))
            return trig.normal_form(poly)

        gens, n = ring.gens(), self.n
        of = Algebra(lambda x: trig.constant(ring, x), tidy)
        values = dict(zip(self.names, gens[2 * n :], strict=True))
        posture = self._posture(gens[:n], gens[n : 2 * n], values, of)
        mass = tuple(tuple(map(trig.normal_form, row)) for row in posture.mass())
        return Polynomials(mass, trig.normal_form(posture.potential()), self.names)

    def at(
        self, sin: Sequence[T], cos: Sequence[T], values: Values, lift: Lift[T], tidy: Tidy = None
    ) -> ArmAtAngles:
        """The polynomials of few joints, else the chain."""
        if self.n <= FEW_JOINTS:
            return self.polynomials.at(sin, cos, values, lift)
        return self._posture(sin, cos, values, Algebra(lift, tidy))

    def fixed(self, values: Mapping[str, Fraction]) -> Chain:
        return Chain(*self._with(values, Algebra(Fraction)))

    def _posture(self, sin: Sequence[Any], cos: Sequence[Any], values: Values, of: Algebra) -> ChainInMotion:
        return ChainInMotion(*self._with(values, of), sin, cos, of)

    def _with(self, values: Values, of: Algebra) -> tuple[tuple[RigidLink, ...], tuple[Entry, ...]]:
        if not self.names:
            return self.links, self.fall
        parts = [
            {part.name: _filled(getattr(link, part.name), values, of) for part in fields(link)}
            for link in self.links
        ]
        links = tuple(replace(link, **part) for link, part in zip(self.links, parts, strict=True))
        return links, _filled(self.fall, values, of)


def _filled(part: Any, values: Values, of: Algebra) -> Any:
    """A number, vector or matrix with the values of the parameters in it."""
    if isinstance(part, tuple):
        return tuple(_filled(x, values, of) for x in part)
    return of.times(part.factor, values[part.name]) if isinstance(part, ParameterShare) else part
