"""Products of norms: |xᵀ A y| <= ‖A‖ ‖x‖ ‖y‖, with the bounds known for each factor, against a claimed bound.

Some choice of one majorant per factor must give a product in the same symbols as the bound, after symbols
have been replaced by larger ones where ``smaller`` allows it, with a constant that is no larger.

References: ``reyes2019family`` (15), (16).
"""

from __future__ import annotations

from collections import Counter

from lyapcheck.check.certificates.proofs import ChosenMajorants
from lyapcheck.check.certificates.refusal import require
from lyapcheck.check.certificates.statements import Constant, Majorant, NormChain, Relation
from lyapcheck.check.certificates.verify import Accepted, require_proved, rule
from lyapcheck.check.functions import ball


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
