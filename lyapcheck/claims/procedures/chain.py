"""Products of norms: |xᵀ A y| <= ‖A‖ ‖x‖ ‖y‖, with the bounds known for each factor, against a claimed bound.

Some choice of one majorant per factor must give a product in the same symbols as the bound, after symbols
have been replaced by larger ones where ``smaller`` allows it, with a constant that is no larger.

References: ``reyes2019family`` (15), (16).
"""

from __future__ import annotations

from collections import Counter
from itertools import product

from lyapcheck.claims.decision import Decision, proved, undecided
from lyapcheck.claims.expressions import Expr, expr
from lyapcheck.claims.procedures.constants import decide_relation
from lyapcheck.claims.statements import Majorant, NormChain
from lyapcheck.verdicts import Verdict

METHOD = "product of norms"


def decide_chain(statement: NormChain) -> Decision:
    """Decide whether the majorants of the factors give the bound; never refutes.

    Soundness: each majorant must bound its factor, which the claims that are used say.
    """
    closest = ""
    for choice in product(*statement.factors):
        reached = multiply(choice)
        if not _same_symbols(reached, statement.bound, statement.smaller):
            continue
        decision = decide_relation(Expr(reached.constant) <= Expr(statement.bound.constant), METHOD)
        if decision.verdict is Verdict.PROVED:
            return proved(decision.grade, f"{METHOD} (Cauchy–Schwarz); {decision.method}")
        closest = "; the constant of the product is larger than the claimed one"
    return undecided(
        f"no choice of the known bounds gives the claimed one{closest}; look for a state that breaks it",
        METHOD,
    )


def multiply(choice: tuple[Majorant, ...]) -> Majorant:
    """The product of majorants."""
    powers: Counter[str] = Counter()
    constant = expr(1)
    for factor in choice:
        powers.update(dict(factor.powers))
        constant = constant * Expr(factor.constant)
    return Majorant(constant.tree, tuple(sorted((s, p) for s, p in powers.items() if p)))


def _same_symbols(reached: Majorant, bound: Majorant, smaller: tuple[tuple[str, str], ...]) -> bool:
    """Whether the powers agree once some symbols have been replaced by larger ones."""
    powers, wanted = Counter(dict(reached.powers)), Counter(dict(bound.powers))
    for small, large in smaller:
        spare = powers[small] - wanted[small]
        if spare > 0:
            powers[small] -= spare
            powers[large] += spare
    return +powers == +wanted
