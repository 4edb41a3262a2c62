"""Theorems that the checker knows, and the hypotheses each of them must be given.

What a theorem says is taken from the literature. What each hypothesis comes to for a loop, and that the claim
behind it states this, is judged in ``premises`` where the claims that are used are at hand.
"""

from __future__ import annotations

from dataclasses import dataclass

from lyapcheck.check.certificates.proofs import Application
from lyapcheck.check.certificates.refusal import Refused, require
from lyapcheck.check.certificates.theorems import ClosedLoop, Theorem
from lyapcheck.check.certificates.verify import Accepted, rule


@dataclass(frozen=True)
class Known:
    """A theorem: its hypotheses by name, what it concludes and takes for granted, and where it is proved.

    ``desired`` tells whether it is about loops that depend on time through a desired velocity.
    """

    hypotheses: frozenset[str]
    conclusion: str
    granted: str
    reference: str
    desired: bool = False


GRANTED = "the robot is (1) with Properties 2.1 to 2.7, and the constants of the form are those of the robot"
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
        GRANTED,
        "kelly2005control, chapter 2",
    ),
    "Lyapunov's direct method, time-varying": Known(
        frozenset(
            {
                "equilibrium",
                "differentiable",
                "positive definite",
                "bounded below by a positive definite function",
                "bounded above by a positive definite function",
                "radially unbounded",
                "rate bounded by a form",
                "form negative definite",
            }
        ),
        "the equilibrium is globally uniformly asymptotically stable",
        GRANTED,
        "khalil2002nonlinear, theorem 4.9",
        desired=True,
    ),
}
"""The theorems that a certificate may apply."""


@rule(Theorem, Application)
def by_application(statement: Theorem, proof: Application) -> Accepted:
    """Soundness: the step itself; that each hypothesis is shown is judged where ``uses`` is."""
    known = THEOREMS.get(statement.name)
    if known is None:
        raise Refused("theorem", statement.name, "is not one that the checker knows")
    labels = [label for label, _ in statement.hypotheses]
    shown = ", ".join(labels)
    require(len(set(labels)) == len(labels), "hypotheses", shown, "one is given twice")
    require(set(labels) == known.hypotheses, "hypotheses", shown, "are not those of the theorem")
    desired = statement.loop.desired
    require(desired == known.desired, "desired", desired, "is not what the theorem is about")
    _require_bounds(statement.loop)
    return Accepted("proved", "exact")


def _require_bounds(loop: ClosedLoop) -> None:
    """√nγ <= reach, and min(Lr, reach)/(1 + r) <= reach·L/(reach + L) <= G, the greatest where both agree.

    Raises:
        Refused: they do not hold.
    """
    for name in ("gamma", "rho", "L", "reach", "G"):
        require(getattr(loop, name) > 0, name, getattr(loop, name), "must be positive")
    for name, value in loop.numbers:
        require(value >= 0, name, value, "must not be negative")
        require(value > 0 or name not in ("kp", "b_min", "eps0"), name, value, "must be positive")
    require(loop.n * loop.gamma**2 <= loop.reach**2, "reach", loop.reach, "must be at least √nγ")
    share = loop.reach * loop.L / (loop.reach + loop.L)
    require(share <= loop.G, "G", loop.G, "must be at least reach·L/(reach + L)")
