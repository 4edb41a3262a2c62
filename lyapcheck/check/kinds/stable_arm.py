"""Stability of one arm under given gains: an argument for all of them, at numbers that bound this one.

Only constants in the conditions of the argument need numbers; of the others it is enough that they exist, as
they do where M ≻ 0: entries are polynomials in sines and cosines, and angles lie on a torus.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from itertools import product
from operator import mul

from lyapcheck.check.expressions.expression import Tree, substitute, variables
from lyapcheck.check.expressions.text import diagonal_text, number_text
from lyapcheck.check.kinds.constant import Constant
from lyapcheck.check.kinds.coriolis import CoriolisBelow
from lyapcheck.check.kinds.gravity import GravityBelow
from lyapcheck.check.kinds.inertia import (
    MassAbove,
    MassBelow,
    mass_text,
    potential_text,
    require_mass,
    require_polynomials,
)
from lyapcheck.check.kinds.stability import ByObligations, Stable
from lyapcheck.check.refusal import require
from lyapcheck.check.replay import require_distinct
from lyapcheck.check.statement import Mass, Monomials, Relation, Statement, Total
from lyapcheck.check.systems.argument import Argument
from lyapcheck.check.systems.facts import constants_of
from lyapcheck.check.systems.obligations import obligations
from lyapcheck.check.verify import Accepted, all_proved, rule

Numbers = tuple[Fraction, ...]


@dataclass(frozen=True)
class Arm:
    """M(q), kg·m², the diagonal of B, N·m·s/rad, and the energy of gravity, J, in sines and cosines of q."""

    mass: Mass
    viscous: Numbers
    potential: Monomials


@dataclass(frozen=True)
class StableArm(Total):
    """The origin of a system is stable for this arm and these gains.

    ``numbers`` are those of constants in the conditions of the argument.
    """

    argument: Argument
    arm: Arm
    gains: tuple[tuple[str, Numbers], ...]
    numbers: tuple[tuple[str, Fraction], ...]

    def require_well_formed(self) -> None:
        """Refuse other sizes, gains and numbers than those of the system."""
        self.argument.require_well_formed()
        system, arm = self.argument.system, self.arm
        n = len(arm.mass)
        require(not (system.regressors or system.sizes), "sizes", "", "are of no arm alone")
        require_mass(arm.mass, ())
        require_polynomials([arm.potential], n, ())
        names = [name for name, _ in self.gains]
        require(names == list(system.gains), "gains", ", ".join(names), "must be those of the system")
        rows = {"B": arm.viscous} | dict(self.gains)
        for name, values in rows.items():
            least = name == "B" and system.friction != "positive"
            fits = len(values) == n and all(value > 0 or (least and value == 0) for value in values)
            require(fits, name, diagonal_text(values), f"must be {n} numbers, positive where they have to be")
        require(system.friction != "none" or not any(arm.viscous), "B", "", "is none in this system")
        require_distinct("numbers", [name for name, _ in self.numbers])
        wanted = set().union(*(variables(one.gap) for one in self.argument.where))
        given = {name for name, _ in self.numbers}
        require(given == wanted, "numbers", ", ".join(sorted(given)), "must be those of the conditions")
        ranges = constants_of(system)  # the argument says nothing of numbers outside, as of K_min = 0
        for name, value in self.numbers:
            low, strict = ranges[name].low, ranges[name].strict
            inside = low is not None and (value > low or (value == low and not strict))
            fits = inside and self._bounds(name, value, rows)
            require(fits, name, number_text(value), "is no such bound")

    def _bounds(self, name: str, value: Fraction, rows: dict[str, Numbers]) -> bool:
        """Whether a number is a bound of what is given; those of M, C and g are obligations."""
        stem, _, end = name.partition("_")
        if stem in rows and end:
            values = rows[stem]
            squares = sum((x * x for x in values), Fraction(0))
            fits = {"min": value <= min(values), "max": value >= max(values)}
            return fits.get(end, value * value >= squares)
        count = len(self.arm.mass)
        for f in self.argument.system.functions:
            if stem == f.name and f.member is not None:
                gamma, most = f.member.gamma or Fraction(0), max(rows[f.gain]) if f.gain else 1
                secant = f.member.secant * most
                gap = secant - value  # share >= L√nγ/(L + √nγ), or L
                return {
                    "reach": f.bounded and value**2 >= count * gamma**2,
                    "slope": value >= f.member.rho * most,
                    "secant": value >= secant,
                    "sector": value * secant <= 1,
                    "share": gap <= 0 or (f.bounded and count * (gamma * gap) ** 2 <= (value * secant) ** 2),
                    "kg": f.member.steep is not None,
                    "load": f.member.steep is not None,
                }[end]
        for one in self.argument.system.increases:
            [f] = [f for f in self.argument.system.functions if f.name == one.function]
            if stem == one.name and f.member is not None:
                gamma, slope = f.member.gamma or Fraction(0), f.member.rho * max(rows[one.gain])
                return {
                    "reach": f.bounded and value**2 >= 4 * count * gamma**2,
                    "secant": value >= slope,
                    "sector": value * slope <= 1,
                }[end]
        known = {"mu", "beta", "R", "eps0", "kc", "kg", "km", "kc2", "vd", "ad"}
        return name in {*known, *self.argument.system.constants}

    @property
    def theorems(self) -> tuple[tuple[str, str], ...]:
        return Stable(self.argument).theorems

    @property
    def granted(self) -> tuple[str, ...]:
        """What the argument takes for granted, and that the data are those of the robot."""
        own = "M(q), B and the energy of gravity are those of the robot; its C is by Christoffel symbols"
        return (own, *Stable(self.argument).granted)

    def text(self) -> str:
        """For which arm and gains; then the theorem."""
        energy = potential_text(self.arm.potential, len(self.arm.mass), 0, "energy of gravity", "U_g")
        gains = ", ".join(f"{name} = {diagonal_text(values)}" for name, values in self.gains)
        numbers = ", ".join(f"{name} = {number_text(value)}" for name, value in self.numbers)
        return (
            f"{Stable(self.argument).conclusion} with {gains}{f' and {numbers}' if numbers else ''} "
            f"on the arm with {mass_text(self.arm.mass, ())}, B = {diagonal_text(self.arm.viscous)}, "
            f"{energy}: "
            f"{Stable(self.argument).text()}"
        )

    def obligations(self) -> Iterator[tuple[str, Statement]]:
        """Those of the argument, then that this arm has its constants and they meet its conditions."""
        yield from obligations(self.argument)
        mass, numbers = self.arm.mass, dict(self.numbers)
        yield "M", MassAbove(mass, (), numbers.get("mu", Fraction(0)))
        if "beta" in numbers:
            yield "beta", MassBelow(mass, (), numbers["beta"])
        if "kc" in numbers:
            yield "kc", CoriolisBelow(mass, (), numbers["kc"])
        if "kg" in numbers:
            yield "kg", GravityBelow(len(mass), hessian(self.arm.potential, len(mass)), (), numbers["kg"])
        for name, found in (("km", slopes_of_mass), ("kc2", slopes_of_symbols)):
            if name in numbers:
                yield name, GravityBelow(len(mass), found(mass), (), numbers[name])
        yield from self._compared()
        by: dict[str, Tree] = {name: ("num", str(value)) for name, value in numbers.items()}
        for k, one in enumerate(self.argument.where, 1):
            here = Relation(substitute(one.left, by), one.operator, substitute(one.right, by))
            yield f"condition {k}", Constant(here)

    def _compared(self) -> Iterator[tuple[str, Statement]]:
        """That gravity is as small beside functions as numbers say: f(a_i x) >= min(steep a_i x, low)."""
        numbers, gains, n = dict(self.numbers), dict(self.gains), len(self.arm.mass)
        torque = tuple(slope(self.arm.potential, i, n) for i in range(n))
        for f in self.argument.system.functions:
            if f.member is None or f.member.steep is None:
                continue
            steep = [f.member.steep * a for a in (gains[f.gain] if f.gain else (1,) * n)]
            for end, level in (("kg", (Fraction(1),) * n), ("load", gains.get(f.level, ()))):
                name = f"{f.name}_{end}"
                if name not in numbers:
                    continue
                least = numbers[name] * min(map(mul, level, steep))
                yield f"{name}, slopes", GravityBelow(n, hessian(self.arm.potential, n), (), least)
                highs = [numbers[name] * one * f.member.low / 2 for one in level]
                if end == "kg":
                    yield f"{name}, size", GravityBelow(n, torque, (), highs[0])
                else:
                    for i, high in enumerate(highs):
                        yield f"{name}, joint {i + 1}", GravityBelow(n, torque[i : i + 1], (), high)


def hessian(energy: Monomials, n: int) -> tuple[Monomials, ...]:
    """∂g/∂q row by row, g the gradient of the energy; its norm is at most the root of the sum of squares."""
    return tuple(slope(slope(energy, i, n), j, n) for i in range(n) for j in range(n))


def slopes_of_mass(mass: Mass) -> tuple[Monomials, ...]:
    """All ∂M_ij/∂q_k; ‖M(q) − M(p)‖ is at most the root of the sum of their squares, times ‖q − p‖."""
    n = len(mass)
    return tuple(slope(entry, k, n) for row in mass for entry in row for k in range(n))


def slopes_of_symbols(mass: Mass) -> tuple[Monomials, ...]:
    """All ∂c_ijk/∂q_l, C(q, x)_ij = Σ c_ijk x_k; likewise for ‖C(q, x) − C(p, x)‖, times ‖x‖ ‖q − p‖."""
    n, half = len(mass), Fraction(1, 2)

    def symbol(i: int, j: int, k: int) -> Monomials:
        turned = ((mass[i][j], k, half), (mass[i][k], j, half), (mass[j][k], i, -half))
        found: dict[tuple[int, ...], Fraction] = {}
        for entry, angle, share in turned:
            for powers, c in slope(entry, angle, n):
                found[powers] = found.get(powers, Fraction(0)) + share * c
        return tuple((powers, c) for powers, c in sorted(found.items()) if c)

    each = product(range(n), repeat=3)
    return tuple(slope(symbol(*of), at, n) for of in each for at in range(n))


def slope(polynomial: Monomials, i: int, n: int) -> Monomials:
    """∂/∂q_i: sᵃcᵇ becomes a sᵃ⁻¹cᵇ⁺¹ − b sᵃ⁺¹cᵇ⁻¹."""
    result: dict[tuple[int, ...], Fraction] = {}
    for powers, c in polynomial:
        for old, new, sign in ((i, n + i, 1), (n + i, i, -1)):
            if powers[old]:
                moved = list(powers)
                moved[old] -= 1
                moved[new] += 1
                key = tuple(moved)
                result[key] = result.get(key, Fraction(0)) + sign * powers[old] * c
    return tuple((powers, c) for powers, c in sorted(result.items()) if c)


@rule(StableArm, ByObligations)
def by_obligations(statement: StableArm, proof: ByObligations) -> Accepted:
    """Soundness: the argument holds for all arms with such constants, and this is one of them."""
    require(proof.met is None, "conditions", "", "are met by the numbers of the statement")
    return all_proved(statement.obligations(), proof.proofs, "proofs")
