"""Theorems that the checker knows, and the hypotheses each of them must be given.

What a theorem says is taken from the literature. What each hypothesis comes to for a loop, and that the claim
behind it states this, is judged in ``premises`` where the claims that are used are at hand.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from lyapcheck.check.expressions.domain import POSITIVE, Domain
from lyapcheck.check.expressions.expression import Tree
from lyapcheck.check.expressions.grammar import require_expressions
from lyapcheck.check.expressions.text import diagonal_text, expression_text, number_text
from lyapcheck.check.kinds.inertia import mass_text, require_mass
from lyapcheck.check.kinds.loop_property import TORQUE, TRACKING_TORQUE
from lyapcheck.check.kinds.norm_bound import MAX_JOINTS
from lyapcheck.check.kinds.parts import relation_text, require_distinct, require_relations, terms_of
from lyapcheck.check.refusal import Refused, require
from lyapcheck.check.statement import OfTerms, Proof, Statement
from lyapcheck.check.theorems.closed_loop import ClosedLoop
from lyapcheck.check.verify import Accepted, rule


@dataclass(frozen=True)
class Theorem(OfTerms):
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
        if loop.arm is not None:
            require_mass(loop.arm.mass, ())

    def terms(self) -> list[tuple[Tree, Domain]]:
        """h, h' and U for every real x, and the form and the condition for all positive constants."""
        loop = self.loop
        own: list[tuple[Tree, Domain]] = [(tree, {}) for tree in (loop.h, loop.slope, loop.potential)]
        domain = dict.fromkeys(CONSTANTS, POSITIVE)
        return [*own, *((tree, domain) for tree in loop.form), *terms_of(loop.condition, domain)]

    @property
    def theorems(self) -> tuple[tuple[str, str], ...]:
        """Its own."""
        return ((self.name, THEOREMS[self.name].reference),)

    @property
    def hypotheses_shown_by(self) -> tuple[tuple[str, str], ...]:
        """Its hypotheses."""
        return self.hypotheses

    def lacks(self, stated: Mapping[str, Statement]) -> str | None:
        """See ``theorems.premises``, which needs this file."""
        from lyapcheck.check.theorems.premises import unmet

        return unmet(self, stated)

    @property
    def granted(self) -> tuple[str, ...]:
        """What the theorem and the loop take for granted."""
        known = THEOREMS.get(self.name)
        return () if known is None else (ARM_GRANTED if self.loop.arm else ()) + known.granted

    def text(self) -> str:
        """For which arms, gains and h, under which condition, what follows, and by which claims."""
        known, loop = THEOREMS.get(self.name), self.loop
        if known is None:
            return f"by a theorem that the checker does not know, {self.name}"
        # an id must not end its quotation
        pairs = ((label, claim.replace("”", "’’")) for label, claim in self.hypotheses)
        given = ", ".join(f"{label} by the claim “{claim}”" for label, claim in pairs)
        torque = TRACKING_TORQUE if loop.desired else TORQUE
        condition = " and ".join(map(relation_text, loop.condition))
        under = f", for ε₀ and constants with {condition}" if condition else ""
        form = "; ".join(map(expression_text, loop.form))
        return (
            f"{torque} with h(x) = {expression_text(loop.h)} makes {known.conclusion}{under}, "
            f"{_about(loop)}: by {self.name} ({known.reference}) with V of (13) and Θ = [{form}]; {given}"
        )


@dataclass(frozen=True)
class Application(Proof):
    """A theorem of the checker's list; its hypotheses are the claims that the certificate uses."""

    rule = "theorem"


CONSTANTS = ("eps", "kp", "b_min", "b_max", "kv_max", "beta", "kc", "vd", "eps0")
"""The names in the form of a loop."""


NUMBERS = ("kp", "b_min", "b_max", "kv_max", "beta", "kc", "eps0")


def _about(loop: ClosedLoop) -> str:
    """The arms and gains."""
    if loop.arm is None:
        return f"for every arm of {loop.n} joints with Properties 2.1 to 2.7 and all positive K_p, K_v"
    numbers = ", ".join(f"{name} = {number_text(value)}" for name, value in loop.numbers)
    arm = loop.arm
    return (
        f"for K_p = {diagonal_text(arm.kp)}, K_v = {diagonal_text(arm.kv)}, {numbers} on the arm with "
        f"B = {diagonal_text(arm.viscous)}, {mass_text(arm.mass, ())}"
    )


@dataclass(frozen=True)
class Known:
    """A theorem: its hypotheses by name, what it concludes and takes for granted, and where it is proved.

    ``desired`` tells whether it is about loops that depend on time through a desired velocity.
    """

    hypotheses: frozenset[str]
    conclusion: str
    granted: tuple[str, ...]
    reference: str
    desired: bool = False


GRANTED = (
    "the robot is (1) with Properties 2.1 to 2.7: 0 < μ ≤ λmin(M(q)) and ‖M(q)‖ ≤ β_M for all q, "
    "‖C(q,x)y‖ ≤ k_c ‖x‖ ‖y‖, C(q,x)y = C(q,y)x, Ṁ = C + Cᵀ, and B is diagonal with λmin(B) > 0",
    "K_p and K_v are diagonal and positive, the torque is applied as it is, and (6) knows g(q) exactly",
)
TIME_GRANTED = (
    "q_d(t) is twice continuously differentiable with ‖q̇_d‖ ≤ v_d, and (21) knows M, C, g and B exactly",
)
ARM_GRANTED = (
    "M(q), B, K_p and K_v of the statement are those of the robot, and its C is by Christoffel symbols",
)
OF_THE_ARM = frozenset({"bounds of M", "bounds of C"})
"""Hypotheses beside those of the theorem, where numbers stand for the constants of an arm."""

THEOREMS = {
    "Lyapunov's direct method": Known(
        frozenset(
            {
                "only equilibrium",
                "differentiable",
                "positive definite",
                "radially unbounded",
                "bounds of h",
                "rate bounded by a form",
                "form negative definite",
            }
        ),
        "q̃ = 0, q̇ = 0 globally asymptotically stable",
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
                "bounds of h",
                "rate bounded by a form",
                "form negative definite",
            }
        ),
        "q̃ = 0, dq̃/dt = 0 globally uniformly asymptotically stable",
        (*GRANTED, *TIME_GRANTED),
        "khalil2002nonlinear, theorem 4.9",
        desired=True,
    ),
}
"""The theorems that a certificate may apply."""


@rule(Theorem, Application)
def by_application(statement: Theorem, proof: Application) -> Accepted:
    """Soundness: the step itself; that each hypothesis is shown is judged where ``uses`` is."""
    known, loop = THEOREMS.get(statement.name), statement.loop
    if known is None:
        raise Refused("theorem", statement.name, "is not one that the checker knows")
    labels = [label for label, _ in statement.hypotheses]
    wanted = known.hypotheses | (OF_THE_ARM if loop.arm else frozenset())
    require(set(labels) == wanted, "hypotheses", ", ".join(labels), "are not those of the theorem")
    require(loop.desired == known.desired, "desired", loop.desired, "is not what the theorem is about")
    _require_bounds(loop)
    _require_numbers(loop)
    return Accepted("proved", "exact")


def _require_bounds(loop: ClosedLoop) -> None:
    """√nγ <= reach, and min(Lr, reach)/(1 + r) <= reach·L/(reach + L) <= G, the greatest where both agree.

    Raises:
        Refused: they do not hold.
    """
    for name in ("gamma", "rho", "L", "reach", "G"):
        require(getattr(loop, name) > 0, name, getattr(loop, name), "must be positive")
    require(loop.n * loop.gamma**2 <= loop.reach**2, "reach", loop.reach, "must be at least √nγ")
    share = loop.reach * loop.L / (loop.reach + loop.L)
    require(share <= loop.G, "G", loop.G, "must be at least reach·L/(reach + L)")


def _require_numbers(loop: ClosedLoop) -> None:
    """Numbers stand for an arm, all of them, and bound what is read off its gains and friction.

    Raises:
        Refused: one is missing, or is no bound of the arm.
    """
    numbers, arm = dict(loop.numbers), loop.arm
    if arm is None:
        require(not numbers, "numbers", ", ".join(numbers), "stand for an arm, and none is given")
        return
    wanted = {*NUMBERS, "vd"} if loop.desired else {*NUMBERS}
    require(set(numbers) == wanted, "numbers", ", ".join(numbers), f"must be {', '.join(sorted(wanted))}")
    require(not loop.condition, "condition", "", "has no place beside numbers")
    sizes = {len(part) for part in (arm.mass, arm.viscous, arm.kp, arm.kv)}
    require(sizes == {loop.n}, "arm", sorted(sizes), f"must be of {loop.n} joints")
    for name, value in numbers.items():
        least = name in ("kp", "b_min", "eps0")
        require(value > 0 or (value == 0 and not least), name, value, "must be positive")
    for name, reached, low in (
        ("kp", min(arm.kp), True),
        ("b_min", min(arm.viscous), True),
        ("b_max", max(arm.viscous), False),
        ("kv_max", max(arm.kv), False),
    ):
        bounds = numbers[name] <= reached if low else numbers[name] >= reached
        require(bounds, name, numbers[name], f"must be at {'most' if low else 'least'} {reached}")
    require(min(arm.kv) > 0, "K_v", min(arm.kv), "must be positive")
