"""Gains on a computer: by (S), by an unstable goal, or from starts at rest by an energy that falls, (P)."""

from __future__ import annotations

from fractions import Fraction

from lyapcheck.check.kinds.resting import AtBounds, Resting, RestWitness
from lyapcheck.check.kinds.sampled import GOAL, SampledStable
from lyapcheck.check.kinds.sampled_from_rest import SampledFromRest
from lyapcheck.claims.search_result import SearchResult, broken, failing, procedure, shown, still_open
from lyapcheck.control.judgement import proves, refutes
from lyapcheck.control.sampled import largest_period, sampled_proof
from lyapcheck.errors import installed
from lyapcheck.files.decimals import decimal_text, significant_down, significant_up

METHOD = "friction above the held torque, (S)"
DIGITS = 4


@procedure(SampledStable)
def find_sampled(statement: SampledStable) -> SearchResult:
    """By (S) or an unstable goal; else up to which period (S) holds, and with how much friction it would."""
    proof = sampled_proof(statement)
    reach = _milliseconds(largest_period(statement))
    if proves(statement, proof):
        return shown(proof, METHOD, largest_period=reach)
    if statement.conclusion == GOAL and not statement.k_g and installed("numpy") and installed("scipy"):
        from lyapcheck.search.sampled import refuted_at, witness_of

        against = refuted_at(statement, statement.period)
        if against is not None:
            return broken(against, "growing motion at one goal, (R)", witness_of(against))
    rows = zip(statement.viscous_min, statement.needed(statement.k_g or proof.k_g), strict=True)
    more = [
        f"b_{i} > {decimal_text(significant_up(want, DIGITS))}"
        for i, (have, want) in enumerate(rows, 1)
        if have <= want
    ]
    far = f"holds for T < {reach}" if reach else "holds for no T"
    return still_open(f"(S) {far}; {' and '.join(more)} N·m·s/rad would do", METHOD)


@procedure(SampledFromRest)
def find_from_rest(statement: SampledFromRest) -> SearchResult:
    """By an energy that falls on the set that the starts lie in."""
    method = "an energy that falls, (P)"
    from lyapcheck.search.sampled_energy import falling_energy

    proof = falling_energy(statement)
    if proof is not None:
        return shown(proof, method)
    return still_open(
        "no falling sampled energy is found; take a shorter period or starts nearer to the goal", method
    )


def _milliseconds(period: Fraction | None) -> str:
    """A period that (S) shows, in four digits; empty if there is none."""
    return "" if period is None else f"{decimal_text(significant_down(1000 * period, DIGITS))} ms"


# --- Where an arm may come to rest: decided by h at the bounds, or by a state of rest beyond one of them.

RESTING = "states of rest"
BEYOND = Fraction(1, 10**6)
"""rad: how far beyond a bound a state against it is looked for."""


@procedure(Resting)
def find_resting(statement: Resting) -> SearchResult:
    """By h at the bounds, else by a state of rest just beyond one of them."""
    proof = AtBounds()
    if proves(statement, proof):
        return shown(proof, RESTING)
    for joint, bound in enumerate(statement.errors):
        against = RestWitness(joint, (bound or Fraction(0)) + BEYOND)
        if bound is not None and refutes(statement, against):
            witness = failing({f"e{joint + 1}": against.error}, against.error, "<=", bound)
            return broken(against, f"{RESTING}: one beyond a bound", witness)
    return still_open("h at the bounds does not decide it; take larger bounds", RESTING)
