"""Theorems that the checker knows, and the hypotheses each of them must be given.

What a theorem says is taken from the literature; that the named claims are its hypotheses is for a reader to
see, which is why each hypothesis has a name and certificates list them.
"""

from __future__ import annotations

from dataclasses import dataclass

from lyapcheck.check.certificates.proofs import Application
from lyapcheck.check.certificates.refusal import Refused, require
from lyapcheck.check.certificates.statements import Theorem
from lyapcheck.check.certificates.verify import Accepted, rule


@dataclass(frozen=True)
class Known:
    """A theorem: its hypotheses by name, what it concludes, and where it is proved."""

    hypotheses: frozenset[str]
    conclusion: str
    reference: str


THEOREMS = {
    "Lyapunov's direct method": Known(
        frozenset(
            {
                "only equilibrium",
                "differentiable",
                "positive definite",
                "radially unbounded",
                "rate bounded by a form",
                "form negative definite",
            }
        ),
        "the equilibrium is globally asymptotically stable",
        "kelly2005control, chapter 2",
    ),
    "Lyapunov's direct method, time-varying": Known(
        frozenset(
            {
                "equilibrium",
                "differentiable",
                "bounded below by a positive definite function",
                "bounded above by a positive definite function",
                "radially unbounded",
                "rate bounded by a form",
                "form negative definite",
            }
        ),
        "the equilibrium is globally uniformly asymptotically stable",
        "khalil2002nonlinear, theorem 4.9",
    ),
}
"""The theorems that a certificate may apply."""


@rule(Theorem, Application)
def by_application(statement: Theorem, proof: Application) -> Accepted:
    """Soundness: the step itself; that each hypothesis is proved is checked where ``uses`` is."""
    known = THEOREMS.get(statement.name)
    if known is None:
        raise Refused("theorem", statement.name, "is not one that the checker knows")
    labels = [label for label, _ in statement.hypotheses]
    shown = ", ".join(labels)
    require(len(set(labels)) == len(labels), "hypotheses", shown, "one is given twice")
    require(set(labels) == known.hypotheses, "hypotheses", shown, "are not those of the theorem")
    return Accepted("proved", "exact")
