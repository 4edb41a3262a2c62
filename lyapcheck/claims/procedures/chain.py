"""Products of norms: |xᵀ A y| <= ‖A‖ ‖x‖ ‖y‖, with the bounds known for each factor, against a claimed bound.

Some choice of one majorant per factor must give a product in the same symbols as the bound, after symbols
have been replaced by larger ones where ``smaller`` allows it, with a constant that is no larger.

References: ``reyes2019family`` (15), (16).
"""

from __future__ import annotations

from itertools import product as combinations

from lyapcheck.check.kinds.norm_chain import (
    ChosenMajorants,
    NormChain,
    constant_relation,
    product,
    same_symbols,
)
from lyapcheck.claims.finding import Finding, shown, still_open
from lyapcheck.claims.procedures.constants import find_relation

METHOD = "product of norms"


def find_chain(statement: NormChain) -> Finding:
    """Try every choice of majorants; never refutes."""
    closest = ""
    for choice in combinations(*(range(len(factor)) for factor in statement.factors)):
        reached = product(tuple(factor[k] for k, factor in zip(choice, statement.factors, strict=True)))
        if not same_symbols(reached, statement.bound, statement.smaller):
            continue
        numbers = find_relation(constant_relation(reached, statement.bound), METHOD)
        if numbers.is_proof and numbers.proof is not None:
            proof = ChosenMajorants(choice, numbers.proof)
            return shown(proof, f"{METHOD} (Cauchy–Schwarz); {numbers.method}")
        closest = "; the constant of the product is larger than the claimed one"
    return still_open(
        f"no choice of the known bounds gives the claimed one{closest}; look for a state that breaks it",
        METHOD,
    )
