"""V and dV/dt of the closed loop for n joints, once: as matrices for the eye, as entries for all arithmetics.

    V = ½ (w − εh)ᵀ M (w − εh) + Σ k_pi U(e_i),   ε = ε₀/(1 + r),  r = ‖e‖
    ė = −w,  M ẇ = K_p h − K_v h(w) − B w − C w,  Ṁ = C + Cᵀ

The terms of (15) are written down here alone. That they add up to dV/dt is decided by the chain rule, in
polynomials over ℚ; what is printed, drawn as a graph, run by NumPy or compiled is made from them.

References: ``reyes2019family`` (11), (12), (13), (15).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import Any

import sympy as sp

from lyapcheck.robots.plant import RobotModel

EPS0, EPS, R, NEAR, INVERSE, SHARE = sp.symbols("epsilon_0 epsilon r s i c", positive=True)
"""ε₀, ε, ‖e‖, and letters for 1/(1 + r), 1/r and 1/(2m)."""


@dataclass(frozen=True, eq=False)
class Letters:
    """The letters of the loop: matrices without entries, or matrices of entries.

    Args:
        w: q̇; ``e`` is q_d − q.
        h: h(e), and ``hw`` is h(w).
        root: √ln(1 + sinh^(2m) e_i) elementwise, as (12) prints it.
        U: U(e_i), elementwise.
        slope: diag(h'(e_i)).
        Ch: C h, and ``hCh`` is hᵀ(C + Cᵀ)h.
        unit: e/r.
        near: 1/(1 + r).
        eps: ε = ε₀/(1 + r).
        share: 1/(2m).
    """

    n: Any
    w: Any
    e: Any
    h: Any
    hw: Any
    root: Any
    U: Any
    kp: Any
    slope: Any
    M: Any
    C: Any
    Kp: Any
    Kv: Any
    B: Any
    Ch: Any
    hCh: Any
    unit: Any
    near: Any
    eps: Any
    share: Any

    @property
    def y(self) -> Any:
        """w − εh."""
        return self.w - self.eps * self.h

    @property
    def along(self) -> Any:
        """êᵀw, (1, 1)."""
        return self.unit.T * self.w


def matrices() -> Letters:
    """Vectors of Rⁿ and n × n matrices by their names."""
    n = sp.Symbol("n", positive=True, integer=True)
    vectors = ("qdot", "qtilde", "h", "h_v", "u", "U", "kappa_p")
    w, e, h, hw, root, U, kp = (sp.MatrixSymbol(name, n, 1) for name in vectors)
    slope, M, C, Kp, Kv, B = (sp.MatrixSymbol(name, n, n) for name in ("H", "M", "C", "K_p", "K_v", "B"))
    ratios = e / R, 1 / (1 + R), EPS, 1 / (2 * sp.Symbol("m"))
    return Letters(n, w, e, h, hw, root, U, kp, slope, M, C, Kp, Kv, B, C * h, h.T * (C + C.T) * h, *ratios)


def entries(n: int, M: Any = None, C: Any = None) -> Letters:
    """The same with entries; ``near`` is a letter, and so are the parts of e/r times r.

    Args:
        n: joints.
        M: the inertia matrix; letters if missing.
        C: C(q, w); likewise.
    """
    names = ("w", "e", "h", "g", "u", "U", "kp", "d", "kv", "b")
    w, e, h, hw, root, U, kp, slope, kv, b = (column(name, n) for name in names)
    M = symmetric("M", n) if M is None else M
    C = sp.Matrix(n, n, lambda i, j: sp.Symbol(f"C{i}_{j}")) if C is None else C
    Kp, Kv, B = (sp.diag(*x) for x in (kp, kv, b))
    ratios = e * INVERSE, NEAR, EPS0 * NEAR, SHARE
    known = (n, w, e, h, hw, root, U, kp, sp.diag(*slope), M, C, Kp, Kv, B)
    return Letters(*known, C * h, form(h, C + C.T, h), *ratios)


def column(name: str, n: int) -> Any:
    """A vector of letters."""
    return sp.Matrix([sp.Symbol(f"{name}{i}") for i in range(n)])


def symmetric(name: str, n: int) -> Any:
    """A symmetric matrix of letters."""
    return sp.Matrix(n, n, lambda i, j: sp.Symbol(f"{name}{min(i, j)}_{max(i, j)}"))


def value_12(x: Letters) -> Any:
    """V as (12) prints it, (1, 1)."""
    energy = form(x.w, x.M, x.w) / 2 + x.share * form(x.root, x.Kp, x.root)
    return energy - x.eps * form(x.h, x.M, x.w) + x.eps**2 / 2 * form(x.h, x.M, x.h)


def value_13(x: Letters) -> Any:
    """V as (13) writes it, (1, 1)."""
    return form(x.y, x.M, x.y) / 2 + x.kp.T * x.U


def terms_15(x: Letters) -> list[Any]:
    """The eleven terms of (15), in printed order, (1, 1) each."""
    w, h, eps, dh = x.w, x.h, x.eps, x.slope * x.w
    turn = x.near * x.along.T
    return [
        -form(w, x.Kv, x.hw),
        -form(w, x.B, w),
        eps * form(dh, x.M, w),
        -eps * turn * form(h, x.M, w),
        -eps * x.Ch.T * w,
        -eps * form(h, x.Kp, h),
        eps * form(h, x.B, w),
        eps * form(h, x.Kv, x.hw),
        eps**2 / 2 * x.hCh,
        eps**2 * turn * form(h, x.M, h),
        -(eps**2) * form(dh, x.M, h),
    ]


DEGREES = (0, 0, 1, 1, 1, 1, 1, 1, 2, 2, 2)
"""The power of ε₀ in each term."""


def form(x: Any, A: Any, y: Any) -> Any:
    """xᵀ A y, with A y taken first."""
    return x.T * (A * y)


def force(x: Letters) -> Any:
    """M ẇ along (11)."""
    return x.Kp * x.h - x.Kv * x.hw - x.B * x.w - x.C * x.w


@dataclass(frozen=True, eq=False)
class Derivation:
    """Polynomials over ℚ in the letters, in which equalities are decided.

    Args:
        x: entries.
        rates: the derivative by time of each letter that moves, but for w.
        relations: polynomials that are 0, a Gröbner basis.
    """

    x: Letters
    rates: Mapping[Any, Any]
    relations: tuple[Any, ...] = ()

    def same(self, left: Any, right: Any) -> bool:
        """Whether both sides are the same polynomial in the letters, modulo the relations.

        Soundness: polynomials are equal where their normal forms are, and the relations hold.
        """
        # with the letter s for 1/(1 + r)
        difference = sp.sympify(left - right).subs(1 / (1 + R), NEAR)
        names = sorted(difference.free_symbols.union(*(one.free_symbols for one in self.relations)), key=str)
        if not names:
            return bool(difference == 0)
        ring = sp.ring(names, sp.QQ)[0]
        rest = ring.from_expr(difference)
        if self.relations:
            rest = rest.rem([ring.from_expr(one) for one in self.relations])
        return not rest

    def value_is_one(self) -> bool:
        """Whether (12) and (13) are the same function, U_i = u_i²/(2m)."""
        squares = {U: SHARE * u**2 for U, u in zip(self.x.U, self.x.root, strict=True)}
        return self.same(value_12(self.x)[0], value_13(self.x)[0].subs(squares))

    def rate(self) -> Any:
        """dV/dt of (13) by the chain rule along (11).

        ∂V/∂w is M y, and so ∂V/∂w ẇ is yᵀ (M ẇ), which (11) gives; `gradient_is_momentum` decides the former.
        """
        V = value_13(self.x)[0].subs(NEAR, 1 / (1 + R))
        along = sum(sp.diff(V, letter) * rate for letter, rate in self.rates.items())
        moving = sp.diff(V, R) * -(self.x.e.T * self.x.w)[0] * INVERSE
        return along + moving + (self.x.y.T * force(self.x))[0]

    def gradient_is_momentum(self) -> bool:
        """Whether ∂V/∂w_i = (M y)_i."""
        V, momentum = value_13(self.x)[0], self.x.M * self.x.y
        return all(self.same(sp.diff(V, w), p) for w, p in zip(self.x.w, momentum, strict=True))

    def sum_is_rate(self) -> bool:
        """Whether the terms of (15) add up to dV/dt."""
        return self.gradient_is_momentum() and self.same(sum(t[0] for t in terms_15(self.x)), self.rate())


@lru_cache(maxsize=16)
def derivation(n: int) -> Derivation:
    """For any arm of n joints: M and C are letters with Ṁ = C + Cᵀ."""
    x = entries(n)
    moving = {x.M[i, j]: x.C[i, j] + x.C[j, i] for i in range(n) for j in range(i, n)}
    return Derivation(x, moving | rates_of_functions(x))


def rates_of_functions(x: Letters) -> dict[Any, Any]:
    """Of h(e_i) and U(e_i): U' = h, and ė = −w."""
    slopes = (x.slope[i, i] for i in range(x.n))
    return {h: -d * w for h, d, w in zip(x.h, slopes, x.w, strict=True)} | {
        U: -h * w for U, h, w in zip(x.U, x.h, x.w, strict=True)
    }


# --- M, C and g of one arm as SymPy matrices, and V and dV/dt on it with nothing left but angles and rates.


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


def written_arm(model: RobotModel) -> WrittenArm:
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
