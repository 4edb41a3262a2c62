"""Implications between inequalities: an identity of signs, or a point at which they fail."""

from __future__ import annotations

from lyapcheck.check.certificates.proofs import SignIdentity, Witness
from lyapcheck.check.certificates.refusal import require
from lyapcheck.check.certificates.rules.replay import coordinates, require_failure
from lyapcheck.check.certificates.rules.signs import Signs, require_identity
from lyapcheck.check.certificates.statements import Implies
from lyapcheck.check.certificates.verify import Accepted, rule


@rule(Implies, SignIdentity)
def by_signs(statement: Implies, proof: SignIdentity) -> Accepted:
    """Soundness: see :func:`require_identity`."""
    signs = Signs(statement)
    require_identity(signs, signs.conclusion, statement.conclusion.strict, proof)
    return Accepted("proved", "exact")


@rule(Implies, Witness)
def by_witness(statement: Implies, proof: Witness) -> Accepted:
    """Soundness: variables in their ranges; every hypothesis holds and the conclusion fails, in balls."""
    point = coordinates(proof.point, [v.name for v in statement.variables])
    for v in statement.variables:
        x = point[v.name]
        inside = v.low is None or x > v.low or (x == v.low and not v.strict)
        require(inside, v.name, x, f"must be {'above' if v.strict else 'at least'} {v.low}")
    given = tuple(hypothesis.comparison for hypothesis in statement.hypotheses)
    require_failure(statement.conclusion.comparison, point, proof.bits, given)
    return Accepted("refuted", "enclosure")
