"""V, dV/dt and the motion at a state of (11), in any arithmetic: arrays, graphs, or a loop being written.

What they are made of besides the arm and the family comes from `lyapcheck.derive`.

References: (6), (11), (12), (15) of ``reyes2019family``.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Any

import sympy as sp
from sympy.printing.str import StrPrinter

from lyapcheck.derive import (
    DEGREES,
    NEAR,
    Letters,
    column,
    entries,
    force,
    symmetric,
    terms_15,
    value_13,
)
from lyapcheck.family.base import Arithmetic
from lyapcheck.robots.plant import RobotModel
from lyapcheck.robots.trig import ArmAtAngles

Vector = Sequence[Any]
Named = Callable[[Vector], list[Any]]
FormsAt = Callable[[Any], Any]


@dataclass(frozen=True, eq=False)
class AtState:
    """One state, or columns of them, with its controller.

    Args:
        model: the arm.
        of: the arithmetic.
        forms: h, h' and U at a value of it.
        q: n angles, rad.
        e: q_d − q, rad.
        w: q̇, rad/s; q̇ − q̇_d where the goal moves.
        kp: diagonal of K_p, N·m.
        kv: diagonal of K_v, N·m.
        viscous: diagonal of B, N·m·s/rad.
        uncertain: parameters of the arm by name; nominal where missing.
        speed: q̇_d of a goal that moves, and then (21) is the loop.
        acceleration_d: q̈_d, likewise.
    """

    model: RobotModel
    of: Arithmetic
    forms: FormsAt
    q: Vector
    e: Vector
    w: Vector
    kp: Vector
    kv: Vector
    viscous: Vector
    uncertain: Mapping[str, Any] | None = None
    speed: Vector = ()
    acceleration_d: Vector = ()

    def value(self, eps0: Any) -> Any:
        """V of (12), J."""
        U = {"U": [x.potential for x in self.at_e], "w": self.w, "kp": self.kp}
        return self._of("value", U | {"M": self.mass, "h": self.h}, epsilon_0=eps0)[0]

    def coefficients(self) -> list[Any]:
        """a₀, a₁, a₂ of dV/dt = −a₀ + a₁ ε₀ + a₂ ε₀², W."""
        gains = {"kp": self.kp, "kv": self.kv, "b": self.viscous, "g": self.hw, "w": self.w}
        return self._of("rate", self._terms | gains)

    def rate(self, eps0: Any) -> Any:
        """dV/dt along (11), W."""
        a0, a1, a2 = self.coefficients()
        return (a1 + a2 * eps0) * eps0 - a0

    def rate_of_moving_goal(self, eps0: Any) -> Any:
        """−ε (w − εh)ᵀ C(q, q̇_d) h, which a goal that moves adds to dV/dt along (11), W.

        C(q, q̇) = C(q, w) + C(q, q̇_d), and the terms of (15) have the former.
        """
        eps, turned = eps0 * self.near, self._times(self.arm.coriolis(self.speed), self.h)
        rows = zip(self.w, self.h, turned, strict=True)
        return -eps * total((w - eps * h) * x for w, h, x in rows)

    def fast(self, scales: Vector | None = None) -> list[list[Any]]:
        """F, (n, n), with a₁ = wᵀ F w + …: what decides for fast states; not symmetric.

        It is linear in h and h' together; with ``scales`` these are Λh and Λh', Λ their diagonal.
        """
        known, n = self._terms, self.model.n
        if scales is not None:
            h, d = ([k * x for k, x in zip(scales, known[name], strict=True)] for name in "hd")
            known = known | {"h": h, "d": d, "G": self.arm.coriolis(h)}
        entries = self._of("fast", known)
        return [entries[i * n : (i + 1) * n] for i in range(n)]

    def slope(self) -> list[Any]:
        """∂a₂/∂w, n."""
        return self._of("slope", self._terms)

    def acceleration(self) -> list[Any]:
        """ẇ = M⁻¹ (K_p h − K_v h(w) − B w − C(q, q̇) w), rad/s²."""
        gains = {"kp": self.kp, "kv": self.kv, "b": self.viscous, "h": self.h, "g": self.hw, "w": self.w}
        names = self.of.names
        C = [names(row) for row in self.arm.coriolis(self.velocity)]
        return solve_definite(self.mass, names(self._of("force", gains | {"C": C})), names)

    def damping(self) -> Any:
        """wᵀBw + wᵀK_v h(w), what the energy loses, W."""
        rows = zip(self.viscous, self.kv, self.w, self.hw, strict=True)
        return total(b * w * w + k * w * f for b, k, w, f in rows)

    def torque(self) -> list[Any]:
        """τ = K_p h − K_v h(w) + g of (6), with M q̈_d + C(q, q̇) q̇_d + B q̇_d of (21), N·m."""
        rows = zip(self.kp, self.h, self.kv, self.hw, self.arm.gravity(), strict=True)
        still = [kp * f - kv * v + g for kp, f, kv, v, g in rows]
        if not self.speed:
            return still
        pushed = self._times(self.mass, self.acceleration_d)
        turned = self._times(self.arm.coriolis(self.velocity), self.speed)
        slowed = [b * x for b, x in zip(self.viscous, self.speed, strict=True)]
        return [total(parts) for parts in zip(still, pushed, turned, slowed, strict=True)]

    @property
    def velocity(self) -> list[Any]:
        """q̇, rad/s."""
        return [w + x for w, x in zip(self.w, self.speed, strict=True)] if self.speed else list(self.w)

    @staticmethod
    def _times(matrix: Any, vector: Vector) -> list[Any]:
        return [total(a * x for a, x in zip(row, vector, strict=True)) for row in matrix]

    def _of(self, name: str, letters: Mapping[str, Any], **numbers: Any) -> list[Any]:
        values = {"s": self.near} | numbers
        for letter, known in letters.items():
            values |= values_of(letter, known)
        return function(self.model.n, name)(self.of.names, **values)

    @cached_property
    def _terms(self) -> dict[str, Any]:
        G = [self.of.names(row) for row in self.arm.coriolis(self.h)]
        return {"M": self.mass, "G": G, "h": self.h, "d": [x.dh for x in self.at_e], "n": self.unit}

    @cached_property
    def arm(self) -> ArmAtAngles:
        """The arm at these angles."""
        of = self.of
        turns = [of.sin(x) for x in self.q], [of.cos(x) for x in self.q]
        return self.model.at(*turns, of.lift, self.uncertain, of.name)

    @cached_property
    def mass(self) -> list[list[Any]]:
        """M(q), kg·m²."""
        rows, n = self.arm.mass(), self.model.n
        upper = [(i, j) for i in range(n) for j in range(i, n)]
        named = dict(zip(upper, self.of.names([rows[i][j] for i, j in upper]), strict=True))
        return [[named[min(i, j), max(i, j)] for j in range(n)] for i in range(n)]

    @cached_property
    def at_e(self) -> list[Any]:
        """The family at e."""
        return [self.forms(x) for x in self.e]

    @cached_property
    def h(self) -> list[Any]:
        """h(e)."""
        return [x.h for x in self.at_e]

    @cached_property
    def hw(self) -> list[Any]:
        """h(w)."""
        return [self.forms(x).h for x in self.w]

    @cached_property
    def r(self) -> Any:
        """‖e‖."""
        return self.of.sqrt(total(x * x for x in self.e))

    @cached_property
    def near(self) -> Any:
        """1/(1 + ‖e‖)."""
        return self.of.name(1.0 / (1.0 + self.r))

    @cached_property
    def unit(self) -> list[Any]:
        """e/‖e‖, and 0 at e = 0."""
        inverse = self.of.name(1.0 / self.of.where(self.r > 0.0, self.r, 1.0))
        return self.of.names([x * inverse for x in self.e])


def solve_definite(matrix: Sequence[Vector], right: Vector, names: Named = list) -> list[Any]:
    """x with matrix · x = right, symmetric and positive definite, by LDLᵀ, in any arithmetic.

    Args:
        matrix: (n, n).
        right: (n,).
        names: of values that are used more than once.

    Soundness: with M not definite the pivots vanish or change sign; property 2.1 is decided elsewhere.
    """
    x, lower, pivots = list(right), list[list[Any]](), list[Any]()
    for i, row in enumerate(matrix):
        scaled: list[Any] = []  # L_ik d_k
        for k in range(i):
            scaled += names([_less(row[k], scaled, lower[k])])
        lower.append([names([a / d])[0] for a, d in zip(scaled, pivots, strict=True)])
        pivots += names([_less(row[i], scaled, lower[i])])
        (x[i],) = names([_less(x[i], lower[i], x)])
    x = [a / d for a, d in zip(x, pivots, strict=True)]
    for i in reversed(range(len(x))):
        (x[i],) = names([_less(x[i], [row[i] for row in lower[i + 1 :]], x[i + 1 :])])
    return x


def _less(value: Any, left: Vector, right: Vector) -> Any:
    """The value without the products of as many pairs as there are."""
    for a, b in zip(left, right, strict=False):
        value = value - a * b
    return value


def total(terms: Any) -> Any:
    """The sum of one term or more."""
    first, *rest = terms
    for term in rest:
        first = first + term
    return first


# --- V and dV/dt as functions of their letters in any arithmetic.
#
# dV/dt = −a₀ + a₁ ε₀ + a₂ ε₀²
#
# With C(q, w) h = C(q, h) w, which holds for Christoffel symbols, a₁ is wᵀ F w and parts without M and C, and
# a₂ is linear in w. F and the gradient of a₂ are the same terms with the unit matrix in place of w.


QUADRATIC = slice(2, 5)
"""Terms 3 to 5: all of a₁ that M and C enter."""


@lru_cache(maxsize=32)
def function(n: int, name: str) -> Callable[..., list[Any]]:
    """A function of values for the letters, as keywords: vectors and matrices under the names of `values_of`.

    Args:
        n: joints.
        name: ``value``: V; ``rate``: a₀, a₁, a₂; ``fast``: F by rows; ``slope``: ∂a₂/∂w;
            ``force``: Mẇ.
    """
    outputs = OUTPUTS[name](letters(n))
    known = sorted(set().union(*(one.free_symbols for one in outputs)), key=str)
    parts, results = sp.cse(outputs, symbols=sp.numbered_symbols("t"))
    write = _Products().doprint
    lines = [f"{part} = names([{write(value)}])[0]" for part, value in parts]
    lines += [f"return [{', '.join(map(write, results))}]"]
    body = "\n    ".join(lines)
    text = f"def formula(names, {', '.join(map(str, known))}, **_):\n    {body}\n"
    made: dict[str, Any] = {}
    exec(text, made)  # of formulas that are derived here # nosec B102
    result: Callable[..., list[Any]] = made["formula"]
    return result


def letters(n: int, w: Any = None) -> Letters:
    """Entries in which C h is C(q, h) w, with letters for e/r and for C(q, h)."""
    x = entries(n, symmetric("M", n))
    Gw = sp.Matrix(n, n, _names("G")) * (x.w if w is None else w)
    return replace(x, w=x.w if w is None else w, Ch=Gw, hCh=2 * x.h.T * Gw, unit=column("n", n))


def _names(letter: str) -> Callable[[int, int], Any]:
    return lambda i, j: sp.Symbol(f"{letter}{i}_{j}")


def coefficients(x: Letters) -> list[Any]:
    """a₀, a₁, a₂."""
    terms = [term[0] for term in terms_15(replace(x, eps=NEAR))]
    sums = [sum(t for t, degree in zip(terms, DEGREES, strict=True) if degree == k) for k in range(3)]
    return [-sums[0], *sums[1:]]


def _fast(x: Letters) -> list[Any]:
    return list(sum(_per_rate(x)[QUADRATIC], sp.zeros(x.n, x.n)))


def _slope(x: Letters) -> list[Any]:
    parts = [list(term) for term, degree in zip(_per_rate(x), DEGREES, strict=True) if degree == 2]
    return [sum(each) for each in zip(*parts, strict=True)]


def _per_rate(x: Letters) -> list[Any]:
    """The terms without ε₀ and with the unit matrix in place of w."""
    return terms_15(replace(letters(x.n, sp.eye(x.n)), eps=NEAR))


OUTPUTS: dict[str, Callable[[Letters], list[Any]]] = {
    "value": lambda x: [value_13(x)[0]],
    "rate": coefficients,
    "force": lambda x: list(force(replace(x, C=sp.Matrix(x.n, x.n, _names("C"))))),
    "fast": _fast,
    "slope": _slope,
}


class _Products(StrPrinter):  # type: ignore[misc]
    """Small powers as products: a power takes longer than a product, and no other arithmetic need have it."""

    def _print_Pow(self, expr: Any, rational: bool = False) -> str:
        base = self.parenthesize(expr.base, 100)
        return "*".join([base] * int(expr.exp))

    def _print_Rational(self, expr: Any) -> str:
        return repr(float(expr))


def values_of(name: str, values: Sequence[Any]) -> dict[str, Any]:
    """The entries of a vector or, row by row, of a matrix under their letters."""
    if values and isinstance(values[0], (list, tuple)):
        return {f"{name}{i}_{j}": v for i, row in enumerate(values) for j, v in enumerate(row)}
    return {f"{name}{i}": v for i, v in enumerate(values)}
