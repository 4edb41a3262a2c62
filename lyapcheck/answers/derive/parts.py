"""The formulas of a derivation under their headings."""

from __future__ import annotations

from typing import Any

import sympy as sp

from lyapcheck.answers.derive.formulas import Formula
from lyapcheck.check.numbers.constants import hyperbolic_constants
from lyapcheck.derive.arm import WrittenArm
from lyapcheck.derive.family import Member
from lyapcheck.derive.lyapunov import DEGREES, EPS0, matrices, terms_15, value_12, value_13
from lyapcheck.output.digits import correct_digits
from lyapcheck.robots import RobotModel

SHOWN = 10
Part = tuple[str, tuple[Formula, ...]]


def family(member: Member) -> Part:
    """U, h, h' and the polynomials of γ and ρ."""
    m = member.m
    known = hyperbolic_constants(m)
    gamma, rho = (f"{correct_digits(one, SHOWN)} (certified)" for one in (known.gamma, known.rho))
    rising = f"0 at the place of γ = {gamma}, u = sinh²x:"
    steepest = f"0 where h′ is least or largest, ρ = {rho}:"
    if m == 1:
        rising = f"No zero at u = sinh²x > 0: h rises to its limit γ = {gamma}."
        steepest = f"No zero at u > 0: h′ falls from h′(0) = ρ = {rho}."
    rows = (
        Formula("U", "All comes from the potential:", f"U_{m}(x)", f"U_{{{m}}}(x)", member.potential),
        Formula("6", "h = U′:", f"h_{m}(x)", f"h_{{{m}}}(x)", member.h),
        Formula("8", "Its derivative:", f"h_{m}′(x)", f"h_{{{m}}}'(x)", member.dh),
        Formula("gamma", rising, "g(u)", "g(u)", member.gamma_polynomial.as_expr()),
        Formula("rho", steepest, "p(u)", "p(u)", member.rho_polynomial.as_expr()),
    )
    return f"The family, m = {m}", rows


def value() -> Part:
    """V of (12) and (13)."""
    x = matrices()
    rows = (
        Formula("eps", "With r = ‖q̃‖ and", "ε", r"\epsilon", EPS0 * x.near),
        Formula("12", "As (12) prints it:", "V", "V", value_12(x)),
        Formula("13", "As (13) writes it:", "V", "V", value_13(x)),
    )
    return "The Lyapunov function, n joints", rows


def rate() -> Part:
    """The eleven terms of (15)."""
    said = {
        1: "dV/dt = t₁ + … + t₁₁ = −a₀ + a₁ε₀ + a₂ε₀²; −a₀ is the sum of",
        3: "a₁ε₀ is the sum of",
        9: "a₂ε₀² is the sum of",
    }
    terms = enumerate(terms_15(matrices()), start=1)
    rows = tuple(Formula(f"15.{k}", said.get(k, ""), f"t{_low(k)}", f"t_{{{k}}}", term) for k, term in terms)
    assert [DEGREES[k - 1] for k in said] == [0, 1, 2]
    return "dV/dt along (11), term by term of (15)", rows


def arm(model: RobotModel, written: WrittenArm) -> Part:
    """M, C and g of an arm, entry by entry; what is 0 is left out."""
    rows: list[Formula] = []
    for name, matrix, says in (
        ("M", written.M, "kg·m²; symmetric, other entries are 0:"),
        ("C", written.C, "C(q, w) of the Christoffel symbols, kg·m²/s; other entries are 0:"),
        ("g", written.g, "N·m; other entries are 0:"),
    ):
        places = [
            (i, j)
            for i in range(matrix.rows)
            for j in range(matrix.cols)
            if matrix[i, j] != 0 and not (name == "M" and j < i)
        ]
        for count, (i, j) in enumerate(places):
            place = (i + 1,) if matrix.cols == 1 else (i + 1, j + 1)
            low = "".join(map(str, place))
            head = f"{name}_{{{low}}}"
            entry: Any = sp.expand(written.at_angles(matrix)[i, j])
            rows.append(Formula(f"{name}{low}", "" if count else says, f"{name}{_low(*place)}", head, entry))
    return f"The arm {model.name}", tuple(rows)


def _low(*numbers: int) -> str:
    return "".join(str(k) for k in numbers).translate(str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉"))
