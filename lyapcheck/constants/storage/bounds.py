"""From a chain to certified bounds: doubles propose the storage forms, the checker decides."""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction

from lyapcheck.check.kinds.chain import ChainAbove, ChainBelow, ChainGravityBelow, NoTorque, StorageForms
from lyapcheck.check.kinds.chain_coriolis import ChainCoriolisBelow, RateBounds
from lyapcheck.constants.storage.problem import StorageProblem, energy_problem, weight_problem
from lyapcheck.constants.storage.program import propose
from lyapcheck.constants.storage.rates import rate_bounds
from lyapcheck.control.judgement import proves
from lyapcheck.robots.dynamics import Chain

Bound = ChainAbove | ChainBelow | ChainGravityBelow | ChainCoriolisBelow
_MARGINS = (1e-9, 1e-8, 1e-7, 1e-6, 1e-5)
_DIGITS = 7
"""Significant digits of a bound; coefficients are kept as the doubles that they are."""


@dataclass(frozen=True)
class BoundWithProof:
    """A bound as a statement, and its proof."""

    statement: Bound
    proof: StorageForms | NoTorque | RateBounds

    @property
    def bound(self) -> Fraction:
        """λmin(M) from below, the others from above."""
        return self.statement.low if isinstance(self.statement, ChainAbove) else self.statement.high

    def at_end(self, value: Fraction) -> Bound:
        """The statement with another bound."""
        return with_end(self.statement, value)


def storage_proof(chain: Chain, name: str, still: bool = False) -> BoundWithProof | None:
    """The best bound of λmin(M), λmax(M), k_c, ‖g‖ or a |g_i| that the checker accepts; ``None`` without.

    Args:
        chain: the arm.
        name: of the constant, ``k_g`` for ‖g‖ and ``k_g1`` and so on.
        still: no torque was seen: then it is shown to be 0.
    """
    if name == "k_c":
        bounds = rate_bounds(chain.links)
        if bounds is None:
            return None
        return _accepted(BoundWithProof(ChainCoriolisBelow(chain.links, _above(bounds.reached)), bounds))
    problem, statement = _question(chain, name)
    if still:
        return _accepted(BoundWithProof(statement, NoTorque()))
    for margin in _MARGINS:
        result = propose([problem], margin)
        if result is None:
            continue
        # a little to the safe side, so that rounding takes nothing from what was proposed
        found = Fraction(float(result.prices[0]))
        kappa = _above(found * (1 + Fraction(problem.sign if found > 0 else -1, 10**8)))
        forms = tuple(tuple(Fraction(float(x)) for x in row) for row in result.coefficients[0])
        shown = _accepted(BoundWithProof(with_end(statement, problem.sign * kappa), StorageForms(forms)))
        if shown is not None:
            return shown
    return None


def _accepted(shown: BoundWithProof) -> BoundWithProof | None:
    return shown if proves(shown.statement, shown.proof) else None


def _question(chain: Chain, name: str) -> tuple[StorageProblem, Bound]:
    zero = Fraction(0)
    if name == "lambda_min":
        return energy_problem(chain, -1), ChainAbove(chain.links, zero)
    if name == "lambda_max":
        return energy_problem(chain, 1), ChainBelow(chain.links, zero)
    joints = range(chain.n) if name == "k_g" else [int(name.removeprefix("k_g")) - 1]
    counted = tuple(i + 1 for i in joints)
    return weight_problem(chain, joints), ChainGravityBelow(chain.links, chain.fall, counted, zero)


def bound_of(chain: Chain, name: str, value: Fraction) -> Bound:
    """The bound of a constant of a chain as a statement: λmin(M) from below, the others from above."""
    if name == "k_c":
        return ChainCoriolisBelow(chain.links, value)
    return with_end(_question(chain, name)[1], value)


def with_end(statement: Bound, value: Fraction) -> Bound:
    """The statement with another bound."""
    if isinstance(statement, ChainAbove):
        return replace(statement, low=value)
    return replace(statement, high=value)


def _above(kappa: Fraction) -> Fraction:
    """The nearest decimal of a few digits that is not below."""
    scale = Fraction(10) ** (_DIGITS - len(str(int(abs(kappa) * 10**6))) + 6)
    return Fraction(-((-kappa * scale) // 1)) / scale
