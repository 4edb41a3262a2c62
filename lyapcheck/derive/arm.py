"""M, C and g of one arm as SymPy matrices, and V and dV/dt on it with nothing left but angles and rates."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import sympy as sp

from lyapcheck.derive.lyapunov import Derivation, column, entries, rates_of_functions
from lyapcheck.robots.plant import Plant


@dataclass(frozen=True, eq=False)
class WrittenArm:
    """An arm in the sines and cosines of its angles, its uncertain numbers by their names.

    Args:
        sines: letters for sin q_i; ``cosines`` for cos q_i.
        M: (n, n) kg·m².
        C: C(q, w) of the Christoffel symbols, (n, n), kg·m²/s.
        g: (n, 1) N·m.
    """

    n: int
    sines: Any
    cosines: Any
    M: Any
    C: Any
    g: Any

    def at_angles(self, matrix: Any) -> Any:
        """A matrix with the functions in place of their letters."""
        q = sp.symbols(f"q1:{self.n + 1}")
        names = {s: sp.sin(x) for s, x in zip(self.sines, q, strict=True)}
        names |= {c: sp.cos(x) for c, x in zip(self.cosines, q, strict=True)}
        rates = {sp.Symbol(f"w{i}"): sp.Symbol(f"w{i + 1}") for i in range(self.n)}
        return matrix.subs(rates, simultaneous=True).subs(names)

    def derivation(self) -> Derivation:
        """dV/dt on this arm: Ṁ is that of the entries, along q̇ = w, and not supposed to be C + Cᵀ."""
        x = entries(self.n, self.M, self.C)
        turning = {s: c * w for s, c, w in zip(self.sines, self.cosines, x.w, strict=True)}
        turning |= {c: -s * w for s, c, w in zip(self.sines, self.cosines, x.w, strict=True)}
        circles = tuple(s**2 + c**2 - 1 for s, c in zip(self.sines, self.cosines, strict=True))
        return Derivation(x, turning | rates_of_functions(x), circles)


def written_arm(model: Plant) -> WrittenArm:
    """The arm as polynomials.

    Raises:
        TooManyTerms: M(q) is too long to be written out.
    """
    n = model.n
    sines, cosines = column("sin_q", n), column("cos_q", n)
    numbers = {name: sp.Symbol(name) for name in model.parameters}
    at = model.dynamics.polynomials.at(list(sines), list(cosines), numbers, rational)
    M, C, g = (sp.Matrix(x) for x in (at.mass(), at.coriolis(list(column("w", n))), at.gravity()))
    return WrittenArm(n, sines, cosines, M, C, g)


def rational(value: Fraction) -> Any:
    """An exact number in SymPy."""
    return sp.Rational(value.numerator, value.denominator)
