"""Identities: equal normal forms, or a point at which both sides differ.

References: ``geddes1992algorithms``, chapter 3.
"""

from __future__ import annotations

from lyapcheck.check.certificates.proofs import NormalForm, Witness
from lyapcheck.check.certificates.refusal import require
from lyapcheck.check.certificates.rules.replay import coordinates, require_failure
from lyapcheck.check.certificates.statements import Identity
from lyapcheck.check.certificates.verify import Accepted, rule
from lyapcheck.check.functions import Tree, variables
from lyapcheck.check.normal_form import is_zero


@rule(Identity, NormalForm)
def by_normal_form(statement: Identity, proof: NormalForm) -> Accepted:
    """Soundness: equal normal forms are equal functions, wherever both sides are defined."""
    require(is_zero(gap_of(statement)), "normal form", "", "that of the difference is not zero")
    return Accepted("proved", "exact")


@rule(Identity, Witness)
def by_witness(statement: Identity, proof: Witness) -> Accepted:
    """Soundness: disjoint balls for both sides at one point."""
    names = variables(statement.left) | variables(statement.right)
    point = coordinates(proof.point, names)
    require_failure((statement.left, "=", statement.right), point, proof.bits)
    return Accepted("refuted", "enclosure")


def gap_of(statement: Identity) -> Tree:
    """The difference of both sides."""
    return ("add", statement.right, ("neg", statement.left))
