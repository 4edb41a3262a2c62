"""What all motions of ẋ = f(x) do, by a V; f and V are polynomials of states, sines and cosines of states.

A state that occurs in sines and cosines alone is an angle. It counts up to full turns: motions are those on
the product of circles and lines. |x|² is the sum of 2(1 − cos θ) over angles θ and of y² over other states y.
It is 0 at the origin alone, and |x|² <= R is compact.

- ``nearby``: f(0) = 0, V(0) = 0 < c, and V > c where |x|² = R. So Ω, where |x|² <= R and V <= c, is compact
  within the open ball. In Ω but at 0, V > 0 and dV/dt < 0: no motion leaves it, as V falls where V = c. So
  the origin is asymptotically stable, and attracts Ω.
- ``everywhere``: f(0) = 0, V(0) = 0, and V > 0 and dV/dt < 0 but at 0. V >= a|x|² − b with a > 0 grows
  without end. There are no angles: on a circle no single rest attracts all.
- ``bounded``: V grows likewise, and dV/dt < 0 where V >= c. So V does not rise above the larger of c and V
  at first: motions are bounded and go on for all time. Where c <= V <= V at first, which is compact, dV/dt
  is at most a negative number: every motion comes to V <= c, and stays there.
- ``towards``: V grows likewise, and dV/dt <= 0. So motions are bounded and go on for all time. Every part p
  is 0 wherever dV/dt, the parts before it and their derivatives are: p → 0 along each motion.

For the last, V has a limit, and all functions here have bounded derivatives along a bounded motion. So
dV/dt → 0 by Barbalat's lemma, and with a part its derivative tends to 0. If p did not, then p ≠ 0 at a limit
point of the motion, where dV/dt and all that is before p are 0.

``nearby`` and ``everywhere`` may have parts, too. Then dV/dt <= 0 is enough, if all parts are 0 at the origin
alone: that is the only limit point. For ``nearby``, dV/dt <= 0 where |x|² <= R, and the rest is asked for in
Ω. No motion leaves Ω, as V does not rise in the ball and is above c on its sphere. (dV/dt <= 0 in Ω would not
do: Ω may have a point at which V = c is a minimum of V, and a motion may leave from there.)

If a state θ occurs also outside of sines, 0 <= θ² − sin² θ, 0 <= θ² − 2(1 − cos θ), θ² − θ⁴/6 <= θ sin θ and
θ² − θ⁴/12 <= 2(1 − cos θ) are known: for θ >= 0, cos θ <= 1 gives sin θ <= θ, then 1 − θ²/2 <= cos θ, then
θ − θ³/6 <= sin θ, then cos θ <= 1 − θ²/2 + θ⁴/24, each by integration from 0. All are even in θ.

References: ``khalil2002nonlinear``, theorems 4.1, 4.2, 4.4 and 4.18, lemma 8.2.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction

from lyapcheck.check.expressions.expression import LEAVES, Tree, derivative, nodes, substitute, variables
from lyapcheck.check.expressions.grammar import require_expressions
from lyapcheck.check.expressions.normal_form import normal_form
from lyapcheck.check.expressions.text import expression_text
from lyapcheck.check.kinds.identity import Identity
from lyapcheck.check.kinds.implies import Implies
from lyapcheck.check.kinds.stability import ByObligations
from lyapcheck.check.refusal import require
from lyapcheck.check.replay import require_distinct
from lyapcheck.check.statement import Relation, Statement, Total, Variable
from lyapcheck.check.verify import Accepted, all_proved, rule

ZERO: Tree = ("num", "0")
ONE: Tree = ("num", "1")
CIRCULAR = ("sin", "cos")
POLYNOMIAL = ("num", "var", "add", "mul", "neg", "div", "pow")
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
        fits = {"towards": bool(self.parts), "bounded": not self.parts}.get(self.conclusion, True)
        require(fits, "parts", len(self.parts), "are what motions tend to")
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
            for node in nodes(tree):
                sine = node[0] in CIRCULAR and node[1][0] == "var" and node[1][1] in self.names
                says = "is not a polynomial in its variables, and in sin and cos of one state each"
                require(sine or node[0] in POLYNOMIAL, "expression", node[0], says)
            ratio, _ = normal_form(tree)
            constant = ratio.bottom.is_constant()
            require(constant, "expression", "", "is not a polynomial in its variables")
        turning = self.conclusion == "everywhere" and self.angles
        require(not turning, "angles", ", ".join(self.angles), "have no single rest that attracts all")

    @property
    def names(self) -> tuple[str, ...]:
        """Those of the states."""
        return tuple(name for name, _ in self.rates)

    @property
    def slope(self) -> Tree:
        """dV/dt."""
        return self.along(self.energy)

    def along(self, tree: Tree) -> Tree:
        """The derivative of an expression along motions."""
        return ("add", *(("mul", derivative(tree, name), rate) for name, rate in self.rates))

    @property
    def angles(self) -> tuple[str, ...]:
        """The states that occur in sines and cosines alone."""
        trees = [*(rate for _, rate in self.rates), self.energy, *self.parts]
        turning = {node[1][1] for node in nodes(*trees) if node[0] in CIRCULAR}
        plain = set().union(*(variables(_without_circular(tree)) for tree in trees))
        return tuple(name for name in self.names if name in turning - plain)

    @property
    def square(self) -> Tree:
        """|x|²."""
        return (
            "add",
            *(_chord(name) if name in self.angles else ("pow", ("var", name), 2) for name in self.names),
        )

    def obligations(self) -> Iterator[tuple[str, Statement]]:
        """What the conclusion follows from, by name."""
        V, rises = self.energy, self.slope
        off: tuple[Relation, ...] = (Relation(ZERO, "<", self.square),)
        region: tuple[Relation, ...] = ()
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
            region = (within, Relation(V, "<=", self.level))
        if self.conclusion in FIXED:
            yield "V > 0", self._if((*off, *region), ZERO, "<", V)
        if self.parts:
            yield "fall", self._if(region[:1], rises, "<=", ZERO)
            yield from self._steps(region)
        elif self.conclusion in FIXED:
            yield "fall", self._if((*off, *region), rises, "<", ZERO)
        elif self.level is not None:
            yield "fall", self._if((Relation(self.level, "<=", V),), rises, "<", ZERO)

    def _steps(self, region: tuple[Relation, ...]) -> Iterator[tuple[str, Statement]]:
        """That each part is 0 where all before it is, and that all are only at the origin if that is said."""
        known: tuple[Relation, ...] = vanishing(self.slope)
        for part in self.parts:
            name = f"{expression_text(part)} → 0"
            yield name, self._if((*region, *known), ("pow", part, 2), "<=", ZERO)
            known = (*known, *vanishing(part), *vanishing(self.along(part)))
        if self.conclusion in FIXED:
            yield "origin", self._if((*region, *known), self.square, "<=", ZERO)

    def _if(self, given: tuple[Relation, ...], left: Tree, operator: str, right: Tree) -> Implies:
        relation = Relation(left, operator, right)
        turning = {node[1][1] for one in (*given, relation) for node in nodes(one.gap) if node[0] in CIRCULAR}
        facts = (fact for name in sorted(turning - {*self.angles}) for fact in known_of_sine(name))
        given = (*given, *facts)
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
        turns = f", {', '.join(self.angles)} up to full turns" if self.angles else ""
        grows = f", which is at least ({a})·({square}) − ({b})" if a else ""
        return f"{says} under {law}{over}{turns}, with V = {expression_text(self.energy)}{grows}"


THEOREMS = {
    "nearby": "Lyapunov's direct method",
    "everywhere": "Lyapunov's direct method",
    "bounded": "Lyapunov's direct method for ultimate bounds",
    "towards": "Barbalat's lemma",
}


def vanishing(tree: Tree) -> tuple[Relation, Relation]:
    """That an expression is 0."""
    return Relation(tree, "<=", ZERO), Relation(ZERO, "<=", tree)


def known_of_sine(name: str) -> tuple[Relation, ...]:
    """What holds of sin θ and cos θ beside θ, for all θ; see above."""
    x: Tree = ("var", name)
    sine, square, fourth = ("sin", x), ("pow", x, 2), ("pow", x, 4)
    return (
        Relation(("pow", sine, 2), "<=", square),
        Relation(_chord(name), "<=", square),
        Relation(("add", square, ("mul", ("num", "-1/6"), fourth)), "<=", ("mul", x, sine)),
        Relation(("add", square, ("mul", ("num", "-1/12"), fourth)), "<=", _chord(name)),
    )


def _chord(name: str) -> Tree:
    """2(1 − cos θ), the square of a chord."""
    return ("mul", ("num", "2"), ("add", ONE, ("neg", ("cos", ("var", name)))))


def _without_circular(tree: Tree) -> Tree:
    if tree[0] in (*CIRCULAR, *LEAVES):
        return ONE if tree[0] in CIRCULAR else tree
    return tuple(_without_circular(part) if isinstance(part, tuple) else part for part in tree)


@rule(Flow, ByObligations)
def by_obligations(statement: Flow, proof: ByObligations) -> Accepted:
    """Soundness: see above; the constants are positive numbers, without conditions."""
    require(proof.met is None, "conditions", "", "are none here")
    return all_proved(statement.obligations(), proof.proofs, "proofs")
