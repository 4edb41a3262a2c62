"""What Lyapunov's direct method asks of the closed loop (11) and of V of (13), for every n, arm and gains.

    V(e, w) = ½ yᵀM(q)y + Σ k_pi U(e_i),   y = w − εh(e),   ε = ε₀/(1 + r),   r = ‖e‖,   ė = −w

M has Property 2.1, 0 < μ <= λmin(M(q)) and λmax(M(q)) <= β, and K_p is diagonal and positive. Each property
follows from facts in one variable about h, h' and U:

- equilibrium: at rest Mẇ = K_p h(e), and h odd with h(x) > 0 for x > 0 vanishes at 0 alone;
- positive definite: U' = h and U(0) = 0 give U(x) > 0 for x ≠ 0; where e = 0, y = w; and so for its bounds
  ½μ‖y‖² + Σ k_pi U(e_i) <= V <= ½β‖y‖² + Σ k_pi U(e_i), in which there is no time;
- radially unbounded: h >= c > 0 from some x on makes U grow without end in both directions, as h is odd, and
  |h| <= γ keeps ‖y − w‖ below ε₀√nγ;
- continuously differentiable: ‖e‖ enters through εh alone. With ‖h(e)‖ <= L r, εh differs from ε₀h by at most
  ε₀L r², and the part ε₀ h êᵀ/(1 + r)² of its gradient is at most ε₀L r: both vanish at e = 0.

References: ``kelly2005control``, chapter 2; ``reyes2019family`` (6), (11), (13), (21).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction

from lyapcheck.check.expressions.domain import Domain
from lyapcheck.check.expressions.expression import Tree, derivative, substitute
from lyapcheck.check.expressions.grammar import require_expressions
from lyapcheck.check.expressions.text import expression_text
from lyapcheck.check.kinds.every_n import EveryN
from lyapcheck.check.kinds.for_all import ForAll
from lyapcheck.check.kinds.identity import Identity
from lyapcheck.check.kinds.norm_bound import NormBound
from lyapcheck.check.refusal import require
from lyapcheck.check.statement import OfTerms, Proof, Relation, Statement
from lyapcheck.check.systems.system import DDQD, DG, DQD, GD, B, C, D, Entrywise, G, M, System, W, minus
from lyapcheck.check.verify import Accepted, require_proved, rule, weakest

X: Tree = ("var", "x")
ZERO: Tree = ("num", "0")
EQUILIBRIUM = "the origin is the only equilibrium"
AN_EQUILIBRIUM = "the origin is an equilibrium"
POSITIVE = "V is positive definite"
BELOW = "V is bounded below by a positive definite function"
ABOVE = "V is bounded above by a positive definite function"
UNBOUNDED = "V is radially unbounded"
SMOOTH = "V is continuously differentiable"
OF_THE_LOOP = (EQUILIBRIUM, AN_EQUILIBRIUM)
"""The properties that depend on the torque, and not on V."""
TORQUE = "τ = K_p h(q̃) − K_v h(q̇) + g(q)"
TRACKING_TORQUE = "τ = K_p h(q̃) + K_v h(dq̃/dt) + M q̈_d + C q̇_d + g + B q̇_d"


@dataclass(frozen=True)
class LoopProperty(OfTerms):
    """A property of the loop that (6), or with ``desired`` (21), closes, or of V of (13).

    ``h`` is an expression in x, ``slope`` its derivative and ``potential`` U.
    """

    property: str
    h: Tree
    slope: Tree
    potential: Tree
    desired: bool = False

    def require_well_formed(self) -> None:
        """A property of the list, and expressions in x."""
        require(self.property in FACTS, "property", self.property, "is not one that the checker knows")
        fits = not self.desired or self.property == AN_EQUILIBRIUM
        require(fits, "desired", self.desired, "is for the equilibrium of (21) alone")
        require_expressions((self.h, self.slope, self.potential), ["x"])

    def terms(self) -> list[tuple[Tree, Domain]]:
        """h, h' and U for every real x."""
        return [(tree, {}) for tree in (self.h, self.slope, self.potential)]

    def text(self) -> str:
        """The property, and of which V and loop."""
        arms = "for every n, every arm with Properties 2.1 to 2.7 and all positive K_p, K_v"
        h = f"h(x) = {expression_text(self.h)}"
        if self.property in OF_THE_LOOP:
            torque = TRACKING_TORQUE if self.desired else TORQUE
            return f"{self.property}, with {torque}, {h}, {arms}"
        energy = "V = ½yᵀM(q)y + Σ k_pi U(q̃_i), y = w − ε₀h(q̃)/(1 + ‖q̃‖), dq̃/dt = −w"
        return f"{self.property}: {energy}, {h}, U(x) = {expression_text(self.potential)}, {arms} and ε₀ > 0"


@dataclass(frozen=True)
class Facts(Proof):
    """Numbers for the bounds of h that the property needs, and a proof of each fact in one variable."""

    rule = "facts in one variable"
    numbers: tuple[Fraction, ...]
    proofs: tuple[Proof, ...]


@rule(LoopProperty, Facts)
def by_facts(statement: LoopProperty, proof: Facts) -> Accepted:
    """Soundness: see the head of this file."""
    facts = facts_of(statement, proof.numbers)
    require(len(proof.proofs) == len(facts), "proofs", len(proof.proofs), f"must be {len(facts)}")
    pairs = zip(facts, proof.proofs, strict=True)
    return Accepted("proved", weakest([require_proved(fact, own, name) for (name, fact), own in pairs]))


def facts_of(statement: LoopProperty, numbers: tuple[Fraction, ...]) -> list[tuple[str, Statement]]:
    """What is to be shown of h, h' and U, by name.

    Raises:
        Refused: there are too few or too many numbers, or one has the wrong sign.
    """
    wanted, listed = FACTS[statement.property]
    require(len(numbers) == wanted, "numbers", len(numbers), f"must be {wanted}")
    require(all(number > 0 for number in numbers), "numbers", numbers, "must be positive")
    slope = ("h' is the derivative of h", Identity(derivative(statement.h, "x"), statement.slope))
    result = listed(statement, *numbers)
    return result if slope in result else [slope, *result]


Named = list[tuple[str, Statement]]


def sign_facts(h: Tree) -> Named:
    """h is odd, and positive for positive x."""
    mirrored = substitute(h, {"x": ("neg", X)})
    return [
        ("h(−x) = −h(x)", Identity(mirrored, ("neg", h))),
        ("0 < h(x) for x > 0", ForAll(Relation(ZERO, "<", h), Fraction(0), None, open_low=True)),
    ]


def slope_facts(h: Tree, slope: Tree, rho: Fraction) -> Named:
    """h' as it is, and its bound."""
    bound: Tree = ("num", str(rho))
    return [
        ("h' is the derivative of h", Identity(derivative(h, "x"), slope)),
        ("h' ≤ ρ", ForAll(Relation(slope, "<=", bound))),
        ("−ρ ≤ h'", ForAll(Relation(("neg", bound), "<=", slope))),
    ]


def secant_fact(h: Tree, largest: Fraction) -> Named:
    """|h(x)| <= L|x|, so that ‖h(e)‖ <= L‖e‖ for every n."""
    return [("|h(x)| ≤ L|x|", NormBound(h, 1, ("num", str(largest)), 1))]


def size_facts(h: Tree, gamma: Fraction) -> Named:
    """|h| <= γ."""
    bound: Tree = ("num", str(gamma))
    return [
        ("h ≤ γ", ForAll(Relation(h, "<=", bound))),
        ("−γ ≤ h", ForAll(Relation(("neg", bound), "<=", h))),
    ]


def _rises(statement: LoopProperty) -> Named:
    return [("U' = h", Identity(derivative(statement.potential, "x"), statement.h))]


def _at_rest(statement: LoopProperty) -> Named:
    return [*sign_facts(statement.h), ("the loop that the controller closes", _closed(statement.desired))]


def _closed(desired: bool) -> EveryN:
    """Under (6), or (21), M ẇ is K_p h(e) − K_v h(w) − Bw − C(q,q̇)w; as h is odd, h(ė) = −h(w)."""
    kp, kv, h, k = ("diag", "Kp"), ("diag", "Kv"), ("vec", "h"), ("vec", "k")
    feedback: Tree = ("sum", ("apply", kp, h), minus(("apply", kv, k)))
    coriolis: Tree = ("sum", C, D) if desired else C
    needed = (("apply", M, DDQD), ("apply", coriolis, DQD), ("apply", B, DQD), G) if desired else (GD, DG)
    functions = (Entrywise("h", "e", True, None), Entrywise("k", "w", True, None))
    torque: Tree = ("sum", feedback, *needed)
    system = System(torque, ("Kp", "Kv"), functions, (), (), desired, "positive")
    right: Tree = ("sum", feedback, minus(("apply", B, W)), minus(("apply", coriolis, W)))
    return EveryN(("dot", ("vec", "x"), system.force), ("dot", ("vec", "x"), right))


def _positive(statement: LoopProperty) -> Named:
    at_zero = substitute(statement.potential, {"x": ZERO})
    return [*_rises(statement), ("U(0) = 0", Identity(at_zero, ZERO)), *sign_facts(statement.h)]


def _unbounded(statement: LoopProperty, least: Fraction, start: Fraction, gamma: Fraction) -> Named:
    stays = ForAll(Relation(("num", str(least)), "<=", statement.h), start)
    odd = sign_facts(statement.h)[:1]
    return [*_rises(statement), *odd, ("c ≤ h(x) from some x on", stays), *size_facts(statement.h, gamma)]


def _smooth(statement: LoopProperty, rho: Fraction, largest: Fraction) -> Named:
    slope = slope_facts(statement.h, statement.slope, rho)
    return [*_rises(statement), *slope, *secant_fact(statement.h, largest)]


FACTS: dict[str, tuple[int, Callable[..., Named]]] = {
    EQUILIBRIUM: (0, _at_rest),
    AN_EQUILIBRIUM: (0, _at_rest),
    POSITIVE: (0, _positive),
    BELOW: (0, _positive),
    ABOVE: (0, _positive),
    UNBOUNDED: (3, _unbounded),
    SMOOTH: (2, _smooth),
}
"""For each property how many numbers its facts need, and these facts."""
