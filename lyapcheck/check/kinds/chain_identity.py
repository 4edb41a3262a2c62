"""What holds of M(q) and C(q, w) of every chain of links, because of what they are.

References: ``reyes2019family``, Properties 2.1 and 2.3 to 2.5.
"""

from __future__ import annotations

from dataclasses import dataclass

from lyapcheck.check.kinds.chain import OfLinks
from lyapcheck.check.refusal import require
from lyapcheck.check.statement import Proof
from lyapcheck.check.verify import Accepted, rule

IDENTITIES = {
    "symmetric": "M(q) = M(q)ᵀ",
    "at rest": "C(q, 0) = 0",
    "rate": "Ṁ(q) = C(q, w) + C(q, w)ᵀ with Ṁ along q̇ = w, and both are symmetric,",
    "skew": "Ṁ(q) − 2C(q, w) is skew-symmetric with Ṁ along q̇ = w, so that wᵀ[Ṁ − 2C]w = 0,",
}


@dataclass(frozen=True)
class ChainIdentity(OfLinks):
    """One of the identities above, for all q and w; xᵀM(q)x is twice the energy at rates x."""

    identity: str

    def require_well_formed(self) -> None:
        """A chain, and an identity that is listed."""
        super().require_well_formed()
        require(self.identity in IDENTITIES, "identity", self.identity, f"must be one of {list(IDENTITIES)}")

    def text(self) -> str:
        """The identity, and what M and C are."""
        return f"{IDENTITIES[self.identity]} {self.over}; C by Christoffel symbols"

    def attempts(self) -> list[Proof]:
        """The only rule there is."""
        return [ByDefinition()]


@dataclass(frozen=True)
class ByDefinition(Proof):
    """It follows from what M and C are."""

    rule = "definition of M and C"


@rule(ChainIdentity, ByDefinition)
def by_definition(statement: ChainIdentity, proof: ByDefinition) -> Accepted:
    """Soundness: M is the symmetric matrix of a quadratic form, a polynomial in sines and cosines of q.

    C(q, w)_ij = Σ_k c_ijk w_k is linear in w, and from c_ijk = ½(∂M_ij/∂q_k + ∂M_ik/∂q_j − ∂M_jk/∂q_i) and
    the symmetry of M follows c_ijk + c_jik = ∂M_ij/∂q_k; so C + Cᵀ = Ṁ, and Ṁ − 2C = Cᵀ − C.
    """
    return Accepted("proved", "exact")
