"""Bounds of a motion, and of states of rest: the latter decided here, the former searched by ``bounds``."""

from __future__ import annotations

from fractions import Fraction

from lyapcheck.check.kinds.nearby import DecreasingNearby
from lyapcheck.check.kinds.phases import StaysWithin
from lyapcheck.check.kinds.resting import AtBounds, Resting, RestWitness
from lyapcheck.check.kinds.settling import Settling
from lyapcheck.check.kinds.stopping import ComesToRest, EnergyFalls
from lyapcheck.claims.registry import procedure
from lyapcheck.claims.search_result import SearchResult, broken, failing, shown, still_open
from lyapcheck.control.judgement import proves, refutes
from lyapcheck.search.inertia import mass_proof

METHOD = "states of rest"
BEYOND = Fraction(1, 10**6)
"""rad: how far beyond a bound a state against it is looked for."""


@procedure(Settling, StaysWithin)
def find_settling(statement: Settling | StaysWithin) -> SearchResult:
    """Always open: the levels of V are chosen together with the bounds."""
    advice = "lyapcheck bounds FILE --certificates DIR finds bounds with the levels of V that prove them"
    return still_open(f"times and errors are not searched for here; {advice}", "levels of V")


@procedure(DecreasingNearby)
def find_nearby(statement: DecreasingNearby) -> SearchResult:
    """Always open: ε₀ is searched together with its boxes."""
    advice = "lyapcheck epsilon FILE --max-speed --max-error --certificates DIR finds an ε₀ with its boxes"
    return still_open(f"ε₀ within limits is not searched for here; {advice}", "boxes of (q, e)")


@procedure(Resting, ComesToRest)
def find_resting(statement: Resting | ComesToRest) -> SearchResult:
    """By h at the bounds, else by a state of rest just beyond one of them."""
    proof = AtBounds() if isinstance(statement, Resting) else EnergyFalls(mass_proof(statement.mass))
    if proves(statement, proof):
        return shown(proof, METHOD)
    for joint, bound in enumerate(statement.errors):
        against = RestWitness(joint, (bound or Fraction(0)) + BEYOND)
        if bound is not None and refutes(statement, against):
            witness = failing({f"e{joint + 1}": against.error}, against.error, "<=", bound)
            return broken(against, f"{METHOD}: one beyond a bound", witness)
    return still_open("h at the bounds does not decide it; take larger bounds", METHOD)
