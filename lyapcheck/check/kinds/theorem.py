"""Theorems that the checker knows, and the hypotheses each of them must be given.

What a theorem says is taken from the literature. What each hypothesis comes to for a loop, and that the claim
behind it states this, is judged in ``premises`` where the claims that are used are at hand.
"""

from __future__ import annotations

from dataclasses import dataclass

from lyapcheck.check.expressions.domain import POSITIVE, Domain
from lyapcheck.check.expressions.expression import Tree
from lyapcheck.check.expressions.grammar import require_expressions
from lyapcheck.check.kinds.norm_bound import MAX_JOINTS
from lyapcheck.check.kinds.parts import require_distinct, require_relations, terms_of
from lyapcheck.check.refusal import Refused, require
from lyapcheck.check.statement import Proof, Statement
from lyapcheck.check.theorems.closed_loop import ClosedLoop
from lyapcheck.check.verify import Accepted, rule


@dataclass(frozen=True)
class Theorem(Statement):
    """A theorem applied to a loop: each of its hypotheses is shown by a claim that this one uses.

    ``hypotheses`` are pairs (hypothesis, id of the claim). What the statement of each claim must contain is
    in ``rules.premises``.
    """

    name: str
    loop: ClosedLoop
    hypotheses: tuple[tuple[str, str], ...]

    def require_well_formed(self) -> None:
        """Refuse what the rules should not have to look at."""
        loop = self.loop
        require_distinct("hypotheses", [name for name, _ in self.hypotheses])
        require_distinct("numbers", [name for name, _ in loop.numbers])
        require(1 <= loop.n <= MAX_JOINTS, "n", loop.n, f"must be from 1 to {MAX_JOINTS}")
        require_expressions((loop.h, loop.slope, loop.potential), ["x"])
        require_expressions(loop.form, CONSTANTS)
        require_relations(loop.condition, list(CONSTANTS[1:]))

    def terms(self) -> list[tuple[Tree, Domain]]:
        """h, h' and U for every real x, and the form and the condition for all positive constants."""
        loop = self.loop
        own: list[tuple[Tree, Domain]] = [(tree, {}) for tree in (loop.h, loop.slope, loop.potential)]
        domain = dict.fromkeys(CONSTANTS, POSITIVE)
        return [*own, *((tree, domain) for tree in loop.form), *terms_of(loop.condition, domain)]

    def text(self) -> str:
        """The statement in one line."""
        known = THEOREMS.get(self.name)
        if known is None:
            return f"by a theorem that the checker does not know, {self.name}"
        given = ", ".join(f"{label} ({claim})" for label, claim in self.hypotheses)
        return f"by {self.name} ({known.reference}), {known.conclusion}; its hypotheses: {given}"


@dataclass(frozen=True)
class Application(Proof):
    """A theorem of the checker's list; its hypotheses are the claims that the certificate uses."""

    rule = "theorem"


CONSTANTS = ("eps", "kp", "b_min", "b_max", "kv_max", "beta", "kc", "vd", "eps0")
"""The names in the form of a loop."""


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
