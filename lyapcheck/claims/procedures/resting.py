"""Where an arm may come to rest: decided by h at the bounds, or by a state of rest beyond one of them."""

from __future__ import annotations

from fractions import Fraction

from lyapcheck.check.kinds.resting import AtBounds, Resting, RestWitness
from lyapcheck.claims.search_result import SearchResult, broken, failing, procedure, shown, still_open
from lyapcheck.control.judgement import proves, refutes

METHOD = "states of rest"
BEYOND = Fraction(1, 10**6)
"""rad: how far beyond a bound a state against it is looked for."""


@procedure(Resting)
def find_resting(statement: Resting) -> SearchResult:
    """By h at the bounds, else by a state of rest just beyond one of them."""
    proof = AtBounds()
    if proves(statement, proof):
        return shown(proof, METHOD)
    for joint, bound in enumerate(statement.errors):
        against = RestWitness(joint, (bound or Fraction(0)) + BEYOND)
        if bound is not None and refutes(statement, against):
            witness = failing({f"e{joint + 1}": against.error}, against.error, "<=", bound)
            return broken(against, f"{METHOD}: one beyond a bound", witness)
    return still_open("h at the bounds does not decide it; take larger bounds", METHOD)
