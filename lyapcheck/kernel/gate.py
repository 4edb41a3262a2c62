"""The gate's verdict before Coq's kernel: ``GateAccepted`` in the words of ``formal/GateDefinitions.v``.

The statement is printed from the certificate's data; how it is to be proved is only a hint.
"""

from __future__ import annotations

from fractions import Fraction
from math import floor, isqrt

from flint import arb

from lyapcheck.check.kinds.gate_accepted import BrokenCondition, GateAccepted, GateParts, SaturatingState
from lyapcheck.check.kinds.inertia import HarmonicSizes
from lyapcheck.check.numbers.balls import to_arb
from lyapcheck.check.numbers.members import member
from lyapcheck.check.statement import Proof
from lyapcheck.kernel.spare import between, supremum
from lyapcheck.kernel.terms import NotPrinted, exact, exact_list, monomials, ranges_of, rational

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
        low = Fraction(floor(Fraction(*_below(member("hyperbolic", m).h(to_arb(x)))) * FINE - 1), FINE)
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


def _below(value: arb) -> tuple[int, int]:
    """A rational below a ball."""
    from lyapcheck.check.numbers.polynomials import Enclosure

    return Enclosure.from_arb(value).lower.as_integer_ratio()


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
