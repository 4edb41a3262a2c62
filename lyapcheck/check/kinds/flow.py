"""What all motions of ẋ = f(x) do, for polynomials f of a few variables, by a polynomial V.

- ``nearby``: f(0) = 0, V(0) = 0 < c, and V > c on the sphere xᵀx = R. So Ω, where xᵀx <= R and V <= c, is
  compact within the open ball. In Ω but at 0, V > 0 and dV/dt < 0: no motion leaves it, as V falls where
  V = c. So the origin is asymptotically stable, and attracts Ω.
- ``everywhere``: f(0) = 0, V(0) = 0, and V > 0 and dV/dt < 0 but at 0. V >= a xᵀx − b with a > 0 grows
  without end.
- ``bounded``: V grows likewise, and dV/dt < 0 where V >= c. So V does not rise above the larger of c and V
  at first: motions are bounded and go on for all time. Where c <= V <= V at first, which is compact, dV/dt
  is at most a negative number: every motion comes to V <= c, and stays there.
- ``towards``: V grows likewise, and Σ p² <= −dV/dt. So motions are bounded and go on for all time, and p has
  a bounded derivative and a square of finite integral: p → 0 along each motion, by Barbalat's lemma.

References: ``khalil2002nonlinear``, theorems 4.1, 4.2 and 4.18, lemma 8.2.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction

from lyapcheck.check.expressions.expression import Tree, derivative, substitute, variables
from lyapcheck.check.expressions.grammar import require_expressions
from lyapcheck.check.expressions.text import expression_text
from lyapcheck.check.kinds.bound_every_n import terms_of
from lyapcheck.check.kinds.identity import Identity
from lyapcheck.check.kinds.implies import Implies
from lyapcheck.check.kinds.stability import ByObligations
from lyapcheck.check.refusal import require
from lyapcheck.check.replay import require_distinct
from lyapcheck.check.statement import Relation, Statement, Total, Variable
from lyapcheck.check.verify import Accepted, all_proved, rule

ZERO: Tree = ("num", "0")
FIXED = ("nearby", "everywhere")
GROWS = ("a", "b")
NUMBERS = {
    "nearby": ("level", "radius"),
    "everywhere": GROWS,
    "bounded": ("level", *GROWS),
    "towards": GROWS,
}
"""Which numbers each conclusion needs."""
MAX_STATES = 12


@dataclass(frozen=True)
class Flow(Total):
    """What motions do; the numbers are c, R, a and b, in the positive constants, and ``parts`` are p."""

    conclusion: str
    rates: tuple[tuple[str, Tree], ...]
    constants: tuple[str, ...]
    energy: Tree
    level: Tree | None
    radius: Tree | None
    a: Tree | None
    b: Tree | None
    parts: tuple[Tree, ...]

    def require_well_formed(self) -> None:
        """Refuse what is no polynomial, and numbers that the conclusion does not need."""
        require(
            self.conclusion in NUMBERS, "conclusion", self.conclusion, "is not one that the checker knows"
        )
        require_distinct("names", [*self.names, *self.constants])
        require(0 < len(self.names) <= MAX_STATES, "rates", len(self.names), f"must be 1 to {MAX_STATES}")
        given = {
            name: tree for name in ("level", "radius", "a", "b") if (tree := getattr(self, name)) is not None
        }
        wanted = {*NUMBERS[self.conclusion]}
        require(given.keys() == wanted, "numbers", ", ".join(given), f"must be {', '.join(sorted(wanted))}")
        require((self.conclusion == "towards") == bool(self.parts), "parts", "", "are what motions tend to")
        require_expressions(
            (*(("var", name) for name in self.constants), *given.values()), list(self.constants)
        )
        both = [*self.names, *self.constants]
        for tree in (
            *(("var", name) for name in both),
            *(rate for _, rate in self.rates),
            self.energy,
            *self.parts,
        ):
            require_expressions((tree,), both)
            terms_of(tree)  # refuses what is no polynomial

    @property
    def names(self) -> tuple[str, ...]:
        """Those of the states."""
        return tuple(name for name, _ in self.rates)

    @property
    def slope(self) -> Tree:
        """dV/dt."""
        return ("add", *(("mul", derivative(self.energy, name), rate) for name, rate in self.rates))

    @property
    def square(self) -> Tree:
        """xᵀx."""
        return ("add", *(("pow", ("var", name), 2) for name in self.names))

    def obligations(self) -> Iterator[tuple[str, Statement]]:
        """What the conclusion follows from, by name."""
        V, rises = self.energy, self.slope
        off: tuple[Relation, ...] = (Relation(ZERO, "<", self.square),)
        if self.conclusion in FIXED:
            zero = dict.fromkeys(self.names, ZERO)
            for name, tree in (*((f"rest of {name}", rate) for name, rate in self.rates), ("V at rest", V)):
                yield name, Identity(substitute(tree, zero), ZERO)
        for name, number in (("c", self.level), ("R", self.radius), ("a", self.a)):
            if number is not None and (name != "c" or self.conclusion == "nearby"):
                yield f"{name} > 0", self._if((), ZERO, "<", number)
        if self.a is not None and self.b is not None:
            yield "growth", self._if((), ("add", ("mul", self.a, self.square), ("neg", self.b)), "<=", V)
        if self.level is not None and self.radius is not None:
            within = Relation(self.square, "<=", self.radius)
            edge = (within, Relation(self.radius, "<=", self.square))
            yield "edge", self._if(edge, self.level, "<", V)
            off = (*off, within, Relation(V, "<=", self.level))
        if self.conclusion in FIXED:
            yield "V > 0", self._if(off, ZERO, "<", V)
            yield "fall", self._if(off, rises, "<", ZERO)
        elif self.level is not None:
            yield "fall", self._if((Relation(self.level, "<=", V),), rises, "<", ZERO)
        else:
            squares: Tree = ("add", *(("pow", part, 2) for part in self.parts))
            yield "fall", self._if((), squares, "<=", ("neg", rises))

    def _if(self, given: tuple[Relation, ...], left: Tree, operator: str, right: Tree) -> Implies:
        relation = Relation(left, operator, right)
        used = set().union(*(variables(one.gap) for one in (*given, relation)))
        known = [
            *(Variable(name) for name in self.names),
            *(Variable(name, Fraction(0)) for name in self.constants),
        ]
        return Implies(tuple(one for one in known if one.name in used), given, relation)

    @property
    def theorems(self) -> tuple[tuple[str, str], ...]:
        return ((THEOREMS[self.conclusion], "khalil2002nonlinear"),)

    def text(self) -> str:
        """What holds of which motions, and by which V."""
        level, radius, a, b = (
            "" if tree is None else expression_text(tree)
            for tree in (self.level, self.radius, self.a, self.b)
        )
        origin = ", ".join(f"{name} = 0" for name in self.names)
        square = expression_text(self.square)
        says = {
            "nearby": f"{origin} is asymptotically stable and attracts {square} ≤ {radius}, V ≤ {level}",
            "everywhere": f"{origin} is globally asymptotically stable",
            "bounded": f"every motion is bounded, comes to V ≤ {level} and stays there",
            "towards": f"every motion is bounded, with {', '.join(map(expression_text, self.parts))} → 0",
        }[self.conclusion]
        law = "; ".join(f"d{name}/dt = {expression_text(rate)}" for name, rate in self.rates)
        over = f", for all {', '.join(self.constants)} > 0" if self.constants else ""
        grows = f", which is at least ({a})·({square}) − ({b})" if a else ""
        return f"{says} under {law}{over}, with V = {expression_text(self.energy)}{grows}"


THEOREMS = {
    "nearby": "Lyapunov's direct method",
    "everywhere": "Lyapunov's direct method",
    "bounded": "Lyapunov's direct method for ultimate bounds",
    "towards": "Barbalat's lemma",
}


@rule(Flow, ByObligations)
def by_obligations(statement: Flow, proof: ByObligations) -> Accepted:
    """Soundness: see above; the constants are positive numbers, without conditions."""
    require(proof.met is None, "conditions", "", "are none here")
    return all_proved(statement.obligations(), proof.proofs, "proofs")
