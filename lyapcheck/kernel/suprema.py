"""How Coq is to bound the suprema γ_m and ρ_m of h_m and its slope."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any

from lyapcheck.check.expressions.expression import CONSTANTS
from lyapcheck.check.numbers.members import member
from lyapcheck.check.statement import Statement
from lyapcheck.kernel.terms import NotPrinted, rational

AT = {
    "gamma": ("h_le_gamma", "gamma_le", "prove_h_at_most"),
    "rho": ("dh_le_rho", "rho_le", "prove_dh_at_most"),
}


def facts(statement: Statement) -> str:
    """Bounds of the suprema γ_m, ρ_m and L_m that occur."""
    result: set[tuple[str, int]] = set()
    _collect(statement, result)
    return "".join(supremum(name, m) for name, m in sorted(result))


def _collect(value: Any, result: set[tuple[str, int]]) -> None:
    if isinstance(value, tuple):
        if len(value) == 2 and value[0] in CONSTANTS and isinstance(value[1], int):
            result.add(value)
        for part in value:
            _collect(part, result)
    elif hasattr(value, "__dict__"):
        for part in vars(value).values():
            _collect(part, result)


def supremum(name: str, m: int) -> str:
    """That γ_m or ρ_m lies between two numbers of five digits."""
    if name not in AT:
        raise NotPrinted(f"the constant {name}_{m}")
    lower, upper, tactic = AT[name]
    low, high = between(name, m)
    at = f"({lower} {m} ltac:(lia) {rational(_attained(name, m))})"
    least = f"assert (low_{name}_{m} : {rational(low)} <= {name} {m}) by "
    most = f"assert (up_{name}_{m} : {name} {m} <= {rational(high)}) by (apply {upper}; {tactic}). "
    return f"{least}(eapply Rle_trans; [|exact {at}]; numbers). {most}"


def between(name: str, m: int) -> tuple[Fraction, Fraction]:
    """Numbers of five digits on both sides of γ_m or ρ_m, not so near that intervals cannot tell."""
    known, digits = member("hyperbolic", m), 10 ** (9 if m == 1 else 5)
    value = known.gamma if name == "gamma" else known.rho
    high = value if m == 1 else Fraction(math.ceil(value * digits + Fraction(1, 2)), digits)
    return Fraction(math.floor(value * digits - 1), digits), high


def _attained(name: str, m: int) -> Fraction:
    """About where γ_m or ρ_m is attained; only a hint."""

    def value(x: float) -> float:
        s, c = math.sinh(x), math.cosh(x)
        low = 1 + s ** (2 * m)
        if name == "gamma":
            return s ** (2 * m - 1) * c / low
        return abs((2 * m - 1) * s ** (2 * m - 2) + 2 * m * s ** (2 * m) - s ** (4 * m - 2)) / low**2

    grid = 1 << 11
    near = max(range(12 * grid), key=lambda k: value(k / grid)) * grid
    return Fraction(max(range(max(near - grid, 0), near + grid), key=lambda k: value(k / grid**2)), grid**2)
