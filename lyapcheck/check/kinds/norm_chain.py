"""Products of norms: |xᵀ A y| <= ‖A‖ ‖x‖ ‖y‖, with the bounds known for each factor, against a claimed bound.

Some choice of one majorant per factor must give a product in the same symbols as the bound, after symbols
have been replaced by larger ones where ``smaller`` allows it, with a constant that is no larger.

References: ``reyes2019family`` (15), (16).
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from itertools import chain

from lyapcheck.check.expressions.domain import Domain
from lyapcheck.check.expressions.expression import Tree, ball
from lyapcheck.check.expressions.grammar import require_expressions
from lyapcheck.check.expressions.text import expression_text
from lyapcheck.check.kinds.constant import Constant
from lyapcheck.check.kinds.parts import require_distinct
from lyapcheck.check.refusal import require
from lyapcheck.check.statement import Proof, Relation, Statement
from lyapcheck.check.verify import Accepted, require_proved, rule


@dataclass(frozen=True)
class Majorant:
    """``constant · Π symbol^power``: a product of norms, named constants and ε, all of them >= 0."""

    constant: Tree
    powers: tuple[tuple[str, int], ...]


@dataclass(frozen=True)
class NormChain(Statement):
    """A product of factors is at most a bound, by the Cauchy–Schwarz inequality.

    Each factor lists its majorants, any of which may be used; ``smaller`` pairs symbols (a, b) with a <= b.
    """

    factors: tuple[tuple[Majorant, ...], ...]
    bound: Majorant
    smaller: tuple[tuple[str, str], ...] = ()

    def require_well_formed(self) -> None:
        """Refuse what the rules should not have to look at."""
        for majorant in (self.bound, *chain.from_iterable(self.factors)):
            require_expressions([majorant.constant], [])
            require_distinct("powers", [name for name, _ in majorant.powers])
            for name, power in majorant.powers:
                require(power >= 0, f"power of {name}", power, "a majorant has no negative power")

    def terms(self) -> list[tuple[Tree, Domain]]:
        """The constants."""
        return [(majorant.constant, {}) for majorant in (self.bound, *chain.from_iterable(self.factors))]

    def text(self) -> str:
        """The statement in one line."""
        factors = " · ".join(map(_factor, self.factors))
        larger = [f"{small} ≤ {large}" for small, large in self.smaller]
        using = f", with {' and '.join(larger)}" if larger else ""
        return f"{factors} ≤ {_majorant(self.bound)}{using}"


@dataclass(frozen=True)
class ChosenMajorants(Proof):
    """One majorant of each factor whose product is within the bound."""

    rule = "chosen majorants"
    choice: tuple[int, ...]
    numbers: Proof


@rule(NormChain, ChosenMajorants)
def by_choice(statement: NormChain, proof: ChosenMajorants) -> Accepted:
    """Soundness: each majorant bounds its factor, as the claims that are used say; symbols are >= 0."""
    factors, choice = statement.factors, proof.choice
    require(len(choice) == len(factors), "choice", choice, "must name one majorant per factor")
    for k, factor in zip(choice, factors, strict=True):
        require(0 <= k < len(factor), "choice", k, "does not exist")
    chosen = tuple(factor[k] for k, factor in zip(choice, factors, strict=True))
    for majorant in chosen:
        require(bool(ball(majorant.constant) >= 0), "constant", majorant.constant, "is not shown to be >= 0")
    reached = product(chosen)
    same = same_symbols(reached, statement.bound, statement.smaller)
    require(same, "choice", choice, "gives other symbols than the bound")
    relation = constant_relation(reached, statement.bound)
    return Accepted("proved", require_proved(Constant(relation), proof.numbers, "constant of the product"))


def constant_relation(reached: Majorant, bound: Majorant) -> Relation:
    """The constant of a product against that of the bound."""
    return Relation(reached.constant, "<=", bound.constant)


def product(chosen: tuple[Majorant, ...]) -> Majorant:
    """The product of majorants."""
    powers: Counter[str] = Counter()
    for factor in chosen:
        powers.update(dict(factor.powers))
    constant = ("mul", ("num", "1"), *(factor.constant for factor in chosen))
    return Majorant(constant, tuple(sorted((s, p) for s, p in powers.items() if p)))


def same_symbols(reached: Majorant, bound: Majorant, smaller: tuple[tuple[str, str], ...]) -> bool:
    """Whether the powers agree once some symbols have been replaced by larger ones."""
    powers, wanted = Counter(dict(reached.powers)), Counter(dict(bound.powers))
    for small, large in smaller:
        spare = powers[small] - wanted[small]
        if spare > 0:
            powers[small] -= spare
            powers[large] += spare
    return +powers == +wanted


def _factor(majorants: tuple[Majorant, ...]) -> str:
    shown = ", ".join(map(_majorant, majorants))
    return f"min({shown})" if len(majorants) > 1 else shown


def _majorant(majorant: Majorant) -> str:
    powers = [name if power == 1 else f"{name}^{power}" for name, power in majorant.powers]
    constant = expression_text(majorant.constant)
    return "·".join(([constant] if constant != "1" or not powers else []) + powers)
