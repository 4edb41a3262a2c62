"""The gate's verdict before Coq's kernel: ``GateAccepted`` in the words of ``formal/GateDefinitions.v``.

The statement is printed from the certificate's data; how it is to be proved is only a hint.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterator
from fractions import Fraction
from math import floor, isqrt
from typing import Any

from lyapcheck.check.expressions.expression import CONSTANTS, Tree
from lyapcheck.check.kinds.bound_every_n import terms_of
from lyapcheck.check.kinds.gate_accepted import BrokenCondition, GateAccepted, GateParts, SaturatingState
from lyapcheck.check.kinds.inertia import HarmonicSizes
from lyapcheck.check.numbers.balls import to_arb
from lyapcheck.check.numbers.members import member
from lyapcheck.check.numbers.polynomials import Enclosure
from lyapcheck.check.statement import Proof, Statement
from lyapcheck.kernel.terms import (
    NotPrinted,
    exact,
    exact_list,
    expression,
    identifier,
    monomials,
    ranges_of,
    rational,
)

# --- How Coq is to see that one side exceeds another: no term of the difference is negative.


Monomial = tuple[tuple[str, int], ...]


def spare(upper: Tree, right: Tree) -> str:
    """That ``right`` exceeds ``upper``: they are equal, or no term of the difference is negative."""
    roots: set[str] = set()
    difference = terms_of(_plain(("add", right, ("neg", upper)), roots))
    groups: dict[Monomial, dict[Monomial, Fraction]] = {}
    for c, powers in difference:
        value = Fraction(int(c.p), int(c.q))
        constants: Counter[str] = Counter()
        monomial: Counter[str] = Counter()
        for name, k in powers.items():
            root = name.startswith("sqrt ")
            value *= Fraction(name.split()[1]) ** (k // 2) if root else 1
            (constants if " " in name else monomial)[name] += k % 2 if root else k
        place, fixed = (tuple(sorted((+some).items())) for some in (monomial, constants))
        groups.setdefault(place, {})
        groups[place][fixed] = groups[place].get(fixed, Fraction(0)) + value
    squares = "".join(
        f"assert (Q{k} : sqrt {a} * sqrt {a} = {a}) by (apply sqrt_sqrt; lra). "
        for k, a in enumerate(sorted(roots))
    )
    using = " ".join(f"Q{k}" for k, _ in enumerate(roots))
    known = f"field [{using}]" if using else "field"
    sums = []
    for place, constant in groups.items():
        parts = [" * ".join([rational(c), *_repeated(fixed, str)]) for fixed, c in constant.items() if c]
        if parts:
            sums.append(f"(({' + '.join(parts)}) * ({' * '.join(_repeated(place, identifier)) or '1'}))")
    if not sums:
        return f"{squares}right. {known}."
    steps = "".join(
        f"assert (0 <= {one}) by (apply Rmult_le_pos; [first [solve [nonneg] | lra | numbers]|nonneg]). "
        for one in sums
    )
    both = f"{expression(upper)} + ({' + '.join(sums)})"
    return f"{squares}{steps}apply Rle_trans with ({both}); [lra|right; {known}]."


def _repeated(powers: Monomial, printed: Callable[[str], str]) -> Iterator[str]:
    return (printed(name) for name, k in powers for _ in range(k))


def _plain(tree: Tree, roots: set[str]) -> Tree:
    """An expression with constants and roots as variables, whose names have a blank in them."""
    kind, *parts = tree
    if kind in CONSTANTS:
        return ("var", f"{kind} {parts[0]}")
    if kind == "sqrt" and parts[0][0] == "num":
        roots.add(str(parts[0][1]))
        return ("var", f"sqrt {parts[0][1]}")
    return (kind, *(_plain(part, roots) if isinstance(part, tuple) else part for part in parts))


# --- How Coq is to bound the suprema γ_m and ρ_m of h_m and its slope.


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


ASKED = ("10p", "10i", "19")
DIGITS = 10**4
FINE = 10**6


def gate_proposition(statement: GateAccepted) -> str:
    """``gate_accepts`` of the data; the parts about stability stand beside it.

    Raises:
        NotPrinted: there is no such theorem.
    """
    return f"gate_accepts {_gated(statement)} {_asked(statement)}"


def gate_refuted(statement: GateAccepted, proof: Proof) -> str:
    """That it is false; with a state that saturates a motor, also that there is one."""
    false = f"~ ({gate_proposition(statement)})"
    if isinstance(proof, SaturatingState):
        return f"saturates {_gated(statement)} {proof.joint} /\\ {false}"
    return false


def gate_script(statement: GateAccepted, proof: Proof) -> str:
    """The tactics for what is accepted.

    Raises:
        NotPrinted: a bound of gravity is shown in another way than by the sizes of harmonics.
    """
    sizes = isinstance(proof, GateParts) and all(isinstance(own, HarmonicSizes) for own in proof.gravity)
    if not sizes:
        raise NotPrinted("a bound of gravity by boxes or levers")
    m = _m(statement)
    _, most = between("gamma", m)
    root = Fraction(isqrt(statement.joints * DIGITS**2 - 1) + 1, DIGITS)
    bound = (
        "exact Gate.tanh_bound"
        if m == 1
        else "intros x; cbn [family]; open_rationals; revert x; prove_h_at_most"
    )
    return (
        f"apply (Gate.accepts _ {exact(most)} {exact(root)}); "
        f"[cbn; lia|{bound}|vm_cast_no_check (eq_refl true)..]."
    )


def gate_refutation_script(statement: GateAccepted, proof: Proof) -> str:
    """The tactics for what is rejected.

    Raises:
        NotPrinted: a posture of other angles than quarters of a turn, or another rule.
    """
    m = _m(statement)
    if isinstance(proof, SaturatingState):
        if any(turn.denominator != 1 for turn in proof.turns):
            raise NotPrinted("a posture of other angles than quarters of a turn")
        x = abs(proof.x)
        below = Enclosure.from_arb(member("hyperbolic", m).h(to_arb(x))).lower
        low = Fraction(floor(below * FINE - 1), FINE)
        turns = "; ".join(f"({turn.numerator})" for turn in proof.turns)
        up = "true" if proof.x > 0 else "false"
        numbers = f"{proof.joint} {rational(x)} {exact(low)} {exact_list(proof.parameters)} [{turns}]%Z {up}"
        way = "left" if "10p" in statement.conditions else "right"
        return (
            f"assert (S : saturates {_gated(statement)} {proof.joint}). "
            "{ match goal with |- saturates ?D _ => "
            f"apply (Gate.saturated D ltac:(cbn; lia) {numbers}) end; "
            "[cbn [family]; open_rationals; numbers|vm_cast_no_check (eq_refl true)]. } "
            f"split; [exact S|apply (Gate.saturated_rejects _ {proof.joint}); "
            f"[cbn; lia|{way}; reflexivity|exact S]]."
        )
    if not isinstance(proof, BrokenCondition):
        raise NotPrinted(f"a refutation by {proof.rule}")
    low, _ = between("gamma", m)
    root = exact(Fraction(isqrt(statement.joints * DIGITS**2), DIGITS))
    least = min(range(statement.joints), key=lambda j: statement.viscous[j])
    i, name = proof.joint, proof.condition
    known = {
        "10i": f"{i} {exact(low)}",
        "10p": f"{i} {exact(low)} {root}",
        "19": f"{i} {least} {exact(low)} {root}",
    }
    return (
        f"{supremum('gamma', m)}match goal with |- ~ gate_accepts ?D _ => "
        f"apply (Gate.broken_{name} D ltac:(cbn; lia) {known[name]}) end; "
        "[reflexivity|cbn [family]; open_rationals; lra|vm_cast_no_check (eq_refl true)]."
    )


def _m(statement: GateAccepted) -> int:
    if statement.family == "tanh":
        return 1
    if statement.family != "hyperbolic" or statement.m is None:
        raise NotPrinted(f"the function {statement.family}")
    return statement.m


def _asked(statement: GateAccepted) -> str:
    if "10" in statement.conditions:
        raise NotPrinted("condition (10), which is about norms")
    return f"(Asked {' '.join(str(name in statement.conditions).lower() for name in ASKED)})"


def _gated(statement: GateAccepted) -> str:
    """The data as a record.

    Raises:
        NotPrinted: no gravity is given, so that its bound is a premise.
    """
    if not statement.gravity:
        raise NotPrinted("a bound of gravity that is a premise")
    torques = "; ".join(map(monomials, statement.gravity))
    limits = exact_list(limit or Fraction(0) for limit in statement.limits)
    return (
        f"(Gated {statement.joints} [{torques}] {monomials(statement.potential)} "
        f"{ranges_of(statement.parameters)} {exact_list(statement.k_g)} {ranges_of(statement.viscous)} "
        f"{limits} {_m(statement)} "
        f"{exact_list(statement.kp)} {exact_list(statement.kv)})"
    )
