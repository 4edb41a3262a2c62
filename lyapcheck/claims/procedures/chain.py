"""Bounds along a chain of links: storage forms, else the posture at which the bound fails."""

from __future__ import annotations

from fractions import Fraction

from lyapcheck.check.kinds.chain import ChainBelow, ChainGravityBelow
from lyapcheck.check.kinds.chain_coriolis import ChainCoriolisBelow
from lyapcheck.claims.registry import procedure
from lyapcheck.claims.search_result import SearchResult, shown, still_open
from lyapcheck.constants.storage import storage_proof
from lyapcheck.robots.dynamics import Chain

METHOD = "links"


@procedure(ChainBelow, ChainGravityBelow, ChainCoriolisBelow)
def find_chain_bound(statement: ChainBelow | ChainGravityBelow | ChainCoriolisBelow) -> SearchResult:
    """The forms of the least bound, which hold for every larger one."""
    fall, name = (
        tuple([Fraction(0)] * 3),
        "k_c" if isinstance(statement, ChainCoriolisBelow) else "lambda_max",
    )
    if isinstance(statement, ChainGravityBelow):
        fall, name = statement.fall, "k_g"
        if len(statement.joints) < len(statement.links):
            if len(statement.joints) > 1:
                return still_open("bounds are looked for of one torque or of all", METHOD)
            name = f"k_g{statement.joints[0]}"
    result = storage_proof(Chain(statement.links, fall), name)
    if result is None or result.bound > statement.high:
        least = "none" if result is None else f"{float(result.bound):.6g}"
        return still_open(f"the least bound that storage forms show is {least}; take a larger one", METHOD)
    return shown(result.proof, f"{METHOD}: {result.proof.rule}")
