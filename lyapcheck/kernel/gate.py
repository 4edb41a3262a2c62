"""The gate's verdict, and (S) of a sampled loop, in the words of Coq's pages of definitions for them.

The statement is printed from the certificate's data; how it is to be proved is only a hint.
"""

from __future__ import annotations

import math
from fractions import Fraction
from math import floor, isqrt
from typing import Any

from lyapcheck.check.expressions.expression import CONSTANTS
from lyapcheck.check.kinds.gate_accepted import BrokenCondition, GateAccepted, GateParts, SaturatingState
from lyapcheck.check.kinds.inertia import HarmonicSizes
from lyapcheck.check.kinds.sampled import SampledStable, ShortPeriod
from lyapcheck.check.numbers.balls import to_arb
from lyapcheck.check.numbers.members import member
from lyapcheck.check.numbers.polynomials import Enclosure
from lyapcheck.check.statement import Proof, Statement
from lyapcheck.kernel.terms import (
    NotPrinted,
    exact,
    exact_list,
    monomials,
    ranges_of,
    rational,
)

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
    gated = _gated(statement)
    if "10" in statement.conditions:
        raise NotPrinted("condition (10), which is about norms")
    asked = " ".join(str(name in statement.conditions).lower() for name in ASKED)
    return f"gate_accepts {gated} (Asked {asked})"


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
    if not isinstance(proof, GateParts) or not all(isinstance(own, HarmonicSizes) for own in proof.gravity):
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


def _m(statement: GateAccepted | SampledStable, most: float = math.inf) -> int:
    m = 1 if statement.family == "tanh" else statement.m
    if statement.family not in ("hyperbolic", "tanh") or m is None or m > most:
        raise NotPrinted(f"the function {statement.family}{f' with m = {m}' if m else ''}")
    return m


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


# --- ``SampledStable`` in the words of ``formal/SampledDefinitions.v``.


LARGEST_M = 12
"""``formal/Sharp.v`` has γ_m, ρ_m and L_m up to it."""


def sampled_proposition(statement: SampledStable) -> str:
    """Of any robot with the same friction, which says more where M is given.

    Raises:
        NotPrinted: there is no such theorem.
    """
    says = f"sampled_{statement.conclusion}"
    if statement.links:
        raise NotPrinted("the gravity of a chain of links")
    if statement.k_g:
        return f"of_bounds {_computed(statement)} {exact_list(statement.k_g)} {says}"
    pulled = f"{monomials(statement.potential)} {ranges_of(statement.parameters)}"
    return f"of_potential {_computed(statement)} {pulled} {says}"


def sampled_script(statement: SampledStable, proof: Proof) -> str:
    """The tactics: constants of the library, then booleans that Coq computes.

    Raises:
        NotPrinted: a bound of gravity is shown in another way than by the sizes of harmonics, or (S) holds
            with finer constants than those of the library alone.
    """
    if not isinstance(proof, ShortPeriod) or not all(isinstance(own, HarmonicSizes) for own in proof.gravity):
        raise NotPrinted("a bound of gravity by boxes or levers")
    if _is_near(statement, statement.k_g or proof.k_g):
        raise NotPrinted("a border nearer than ρ_m and L_m to four digits tell")
    m, by = _m(statement, LARGEST_M), "bounds" if statement.k_g else "potential"
    bounds = " ".join(f"Sharp.{name}_{m}_bound" for name in ("h", "dh", "secant"))
    return (
        f"match goal with |- of_{by} ?D {'_' if statement.k_g else '_ _'} _ => "
        f"apply (Period.{by}_{statement.conclusion} D _ _ _ "
        f"{exact_list(statement.k_g or proof.k_g)} ltac:(cbn; lia) {bounds}) end; "
        "vm_cast_no_check (eq_refl true)."
    )


def _is_near(statement: SampledStable, k_g: tuple[Fraction, ...]) -> bool:
    """Whether (S) fails with the constants of ``formal/Sharp.v``, which are rounded up to four digits."""
    known = member(statement.family, statement.m)
    secant, slope = (Fraction(math.ceil(x * DIGITS), DIGITS) - x for x in (known.L, known.rho))
    spread = sum(map(abs, statement.taps))
    late = (Fraction(1, 2) + statement.delay) * statement.period
    gains = zip(statement.kp, statement.kv, strict=True)
    more = [statement.stretch * (secant * v * spread + late * slope * p) for p, v in gains]
    rows = zip(statement.viscous_min, statement.needed(k_g), more, strict=True)
    return any(have <= want + rest for have, want, rest in rows)


def _computed(statement: SampledStable) -> str:
    numbers = (statement.kp, statement.kv, statement.viscous_min, statement.taps)
    return (
        f"(Computed {statement.n} {_m(statement, LARGEST_M)} {' '.join(map(exact_list, numbers))} "
        f"{statement.delay} {exact(statement.period)} {exact(statement.stretch)})"
    )
