"""Bounds along a chain of links: forms that show them, else the posture at which the bound fails."""

from __future__ import annotations

from fractions import Fraction

from lyapcheck.check.kinds.chain import ChainBelow, ChainCoriolisBelow, ChainGravityBelow
from lyapcheck.check.kinds.inertia import PostureWitness
from lyapcheck.claims.search_result import (
    SearchResult,
    broken,
    entries,
    failing,
    procedure,
    shown,
    still_open,
)
from lyapcheck.constants.arm import extreme
from lyapcheck.constants.storage import storage_proof
from lyapcheck.robots.dynamics import Chain
from lyapcheck.robots.fields import Number
from lyapcheck.robots.plant import Plant

METHOD = "links"


@procedure(ChainBelow, ChainGravityBelow, ChainCoriolisBelow)
def find_chain_bound(statement: ChainBelow | ChainGravityBelow | ChainCoriolisBelow) -> SearchResult:
    """The posture at which local searches end, where it breaks the bound; else forms that show it."""
    chain, name = Chain(statement.links, (Fraction(0),) * 3), "lambda_max"
    if isinstance(statement, ChainCoriolisBelow):
        name = "k_c"
    elif isinstance(statement, ChainGravityBelow):
        chain, name = Chain(statement.links, statement.fall), "k_g"
        if len(statement.joints) < len(statement.links):
            if len(statement.joints) > 1:
                return still_open("bounds are looked for of one torque or of all", METHOD)
            name = f"k_g{statement.joints[0]}"
    joints = tuple(f"joint {i + 1}" for i in range(chain.n))
    reached = extreme(
        Plant(name="chain", joints=joints, dynamics=chain, viscous=(Number(Fraction(0)),) * chain.n), name
    )
    if reached.value > statement.high:
        witness = failing(entries(q=reached.q, x=reached.x), reached.value, "<=", statement.high)
        return broken(PostureWitness(reached.q, (), reached.x), f"{METHOD}: a posture", witness)
    result = storage_proof(chain, name)
    if result is None or result.bound > statement.high:
        least = "none" if result is None else f"{float(result.bound):.6g}"
        return still_open(
            f"{float(reached.value):.6g} is reached, and the least bound that forms show is {least}; take a "
            "larger one",
            METHOD,
        )
    return shown(result.proof, f"{METHOD}: {result.proof.rule}")
