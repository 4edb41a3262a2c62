"""The robot model: exact inertia matrix and potential, and everything that follows from them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from fractions import Fraction
from functools import cached_property
from itertools import product
from typing import Any, TypeVar

from flint import fmpq_mpoly, fmpq_mpoly_ctx

from lyapcheck.errors import argument_error
from lyapcheck.robots import trig
from lyapcheck.robots.chain import Chain
from lyapcheck.robots.chain_bounds import ChainBounds
from lyapcheck.robots.number import Number
from lyapcheck.robots.printed_torques import PrintedTorques

T = TypeVar("T")
Lift = Callable[[Fraction], T]


@dataclass(frozen=True, eq=False)
class RobotModel:
    """An arm with n revolute joints: M(q)q̈ + C(q,q̇)q̇ + g(q) + Bq̇ = τ with exact coefficients.

    C_ij = Σ_k christoffel[i][j][k] q̇_k with the Christoffel symbols of M, and g = ∂potential/∂q, so that
    Ṁ = C + Cᵀ holds as an identity of polynomials.

    Args:
        name: short name (``"buap3"``).
        title: one line for reports.
        joints: names of the joints, base first.
        ring: generators s1…sn, c1…cn and one for each entry of ``parameters``.
        mass: M(q), rows of polynomials in normal form, kg·m².
        potential: potential energy, J.
        viscous: diagonal of B, N·m·s/rad.
        coulomb: Coulomb friction torques, N·m; ``None`` where nothing is known.
        torque_limit: largest torque of each motor, N·m; ``None`` where nothing is known.
        encoder: counts per turn; ``None`` where nothing is known.
        gravity_bound: k_gi where the source prints them, N·m.
        numbers: every number of the arm with its provenance.
        parameters: the numbers with a range that enter M or the potential, in generator order.
        remarks: what is taken for granted beyond assumed numbers, in sentences.
        printed: C and g as the source prints them, where it does; nothing is derived from them.
        chain: the links where they are known and exact.
        chain_bounds: for a chain of exact links what masses and distances say for all angles.

    Soundness: M is that of the physical arm only as far as ``numbers`` are; ``assumptions`` lists those
    that no source prints.

    References: (1) and properties 2.1–2.8 of reyes2019family.
    """

    name: str
    title: str
    joints: tuple[str, ...]
    ring: fmpq_mpoly_ctx
    mass: tuple[tuple[fmpq_mpoly, ...], ...]
    potential: fmpq_mpoly
    viscous: tuple[Number, ...]
    coulomb: tuple[Number | None, ...]
    torque_limit: tuple[Number | None, ...]
    encoder: tuple[int | None, ...]
    gravity_bound: tuple[Number | None, ...]
    numbers: dict[str, Number]
    parameters: dict[str, Number] = field(default_factory=dict)
    remarks: tuple[str, ...] = ()
    printed: PrintedTorques | None = None
    chain: Chain | None = None
    chain_bounds: ChainBounds | None = None

    @property
    def n(self) -> int:
        """Number of joints."""
        return len(self.joints)

    @cached_property
    def assumptions(self) -> tuple[str, ...]:
        """What is taken for granted about this arm, one sentence each."""
        assumed = [number.sentence(name) for name, number in self.numbers.items() if number.assumed]
        return (*self.remarks, *assumed)

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

    def point(
        self, sin: Sequence[T], cos: Sequence[T], lift: Lift[T], parameters: Mapping[str, T] | None = None
    ) -> list[T]:
        """The values of all generators: sines, cosines, and parameters (nominal where not given)."""
        given = parameters or {}
        chosen = [given.get(name, lift(number.value)) for name, number in self.parameters.items()]
        return [*sin, *cos, *chosen]

    def mass_at(
        self, sin: Sequence[T], cos: Sequence[T], lift: Lift[T], parameters: Mapping[str, T] | None = None
    ) -> list[list[T]]:
        """M(q), kg·m², in any arithmetic: sin and cos are (n,), lift turns a Fraction into a T."""
        values = self.point(sin, cos, lift, parameters)
        places = [(i, j) for i in range(self.n) for j in range(i, self.n)]
        upper = trig.evaluate_all([self.mass[i][j] for i, j in places], values, lift)
        known = dict(zip(places, upper, strict=True))
        return [[known[min(i, j), max(i, j)] for j in range(self.n)] for i in range(self.n)]

    def coriolis_at(
        self,
        sin: Sequence[T],
        cos: Sequence[T],
        x: Sequence[T],
        lift: Lift[T],
        parameters: Mapping[str, T] | None = None,
    ) -> list[list[T]]:
        """C(q, x) of the Christoffel symbols, kg·m²/s, in any arithmetic; x is (n,), rad/s."""
        symbols = [
            (i, j, k) for i, j, k in product(range(self.n), repeat=3) if self.christoffel[i][j][k] != 0
        ]
        values = self.point(sin, cos, lift, parameters)
        rates = trig.evaluate_all([self.christoffel[i][j][k] for i, j, k in symbols], values, lift)
        terms: dict[tuple[int, int], list[T]] = {}
        for (i, j, k), rate in zip(symbols, rates, strict=True):
            moving: Any = rate
            terms.setdefault((i, j), []).append(moving * x[k])
        return [[trig.total(terms.get((i, j), []), lift) for j in range(self.n)] for i in range(self.n)]

    def gravity_at(
        self, sin: Sequence[T], cos: Sequence[T], lift: Lift[T], parameters: Mapping[str, T] | None = None
    ) -> list[T]:
        """g(q), N·m, in any arithmetic."""
        return trig.evaluate_all(self.gravity, self.point(sin, cos, lift, parameters), lift)

    def potential_at(
        self, sin: Sequence[T], cos: Sequence[T], lift: Lift[T], parameters: Mapping[str, T] | None = None
    ) -> T:
        """The potential energy, J, in any arithmetic."""
        return trig.evaluate(self.potential, self.point(sin, cos, lift, parameters), lift)

    def __getstate__(self) -> dict[str, Any]:
        """The fields with polynomials as plain terms: polynomials of python-flint cannot be pickled."""
        state = {entry.name: getattr(self, entry.name) for entry in fields(self)}
        state["ring"] = tuple(self.parameters)
        state["mass"] = [[trig.to_terms(poly) for poly in row] for row in self.mass]
        state["potential"] = trig.to_terms(self.potential)
        return state

    def __setstate__(self, state: dict[str, Any]) -> None:
        ring = trig.trig_ring(len(state["joints"]), state["ring"])
        mass = tuple(tuple(trig.from_terms(ring, terms) for terms in row) for row in state["mass"])
        potential = trig.from_terms(ring, state["potential"])
        self.__dict__.update(state | {"ring": ring, "mass": mass, "potential": potential})

    def fixed(self, **parameters: Fraction | int) -> RobotModel:
        """The same arm with every uncertain parameter of M and the potential at one exact value.

        Args:
            parameters: values by name; a parameter that is not named keeps its nominal value.

        Raises:
            InputError: a name that is not a parameter of this arm.
        """
        for name in parameters:
            if name not in self.parameters:
                known = ", ".join(self.parameters) or "none"
                raise argument_error(
                    "parameter", name, f"{self.name} has no such parameter", f"use one of: {known}"
                )
        if not self.parameters:
            return self
        values = {
            name: Fraction(parameters.get(name, number.value)) for name, number in self.parameters.items()
        }
        ring = trig.trig_ring(self.n)
        mass = tuple(tuple(trig.substitute(entry, values, ring) for entry in row) for row in self.mass)
        potential = trig.substitute(self.potential, values, ring)
        return replace(self, ring=ring, mass=mass, potential=potential, parameters={})
