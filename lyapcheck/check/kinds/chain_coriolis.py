"""What holds of M(q) and C(q, w) of every chain of links as such; how large C is at most."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from itertools import product

from flint import arb

from lyapcheck.check.expressions.text import number_text
from lyapcheck.check.kinds.chain import OfLinks
from lyapcheck.check.kinds.inertia import Bound, PostureWitness, dot, require_posture
from lyapcheck.check.loop.storage import Shown, coriolis_power, hinges, rate_of_mass
from lyapcheck.check.numbers.balls import to_arb
from lyapcheck.check.numbers.vectors import ZERO, Algebra
from lyapcheck.check.refusal import require
from lyapcheck.check.statement import Proof
from lyapcheck.check.verify import Accepted, rule

# --- C(q, x) of a chain of links: how large it is at most.
#
# References: ``reyes2019family``, Property 2.6.


@dataclass(frozen=True)
class ChainCoriolisBelow(OfLinks, Bound):
    """‖C(q, x)y‖ <= high ‖x‖ ‖y‖ for the C of Christoffel symbols, all q, x and y; kg·m².

    That C(q, x)y is bilinear and symmetric in x and y; so is zᵀC(q, x)y for each z, and with it the largest
    value over unit vectors x, y is taken with y = ± x: ‖C(q, x)x‖ <= high ‖x‖² says the same.
    """

    high: Fraction

    def require_well_formed(self) -> None:
        """A chain, and a bound that is not negative."""
        super().require_well_formed()
        require(self.high >= 0, "high", self.high, "must not be negative")

    def text(self) -> str:
        """``‖C(q, x)y‖ ≤ high ‖x‖ ‖y‖ …``."""
        bound = f"‖C(q, x)y‖ ≤ {number_text(self.high)} ‖x‖ ‖y‖"
        return f"{bound} for all x, y, {self.over}; C by Christoffel symbols"

    def excess(self, at: PostureWitness) -> arb:
        """‖C(q, x)x‖² − (high ‖x‖²)²."""
        n = len(self.links)
        require_posture(at, n, ())
        require(len(at.x) == n and not at.y, "x", len(at.x), f"must have {n} entries, and y none")
        q, x = ([to_arb(value) for value in part] for part in (at.q, at.x))
        turns = [angle.sin() for angle in q], [angle.cos() for angle in q]
        chain, of = hinges(self.links), Algebra(to_arb)
        units = ([Fraction(int(i == k)) for k in range(n)] for i in range(n))
        torques = [coriolis_power(of, chain, *turns, unit, x) for unit in units]
        return dot(torques, torques) - to_arb(self.high**2) * dot(x, x) ** 2


@dataclass(frozen=True)
class RateBounds(Proof):
    """Diagonal bounds Q_j of ± ½ ∂M/∂q_j, and how their products are shared out; untrusted.

    Args:
        rates: Q_j of the second and each further joint, shown for ½ ∂M/∂q_j and for −½ ∂M/∂q_j.
        crossed: s_j > 0.
        squared: t_j > 0.
    """

    rule = "rates of M along the links"
    rates: tuple[Shown, ...]
    crossed: tuple[Fraction, ...]
    squared: tuple[Fraction, ...]

    @property
    def reached(self) -> Fraction:
        """The least bound that the numbers show, see :func:`by_rates`."""
        n, rest = 1 + len(self.rates), [bound.prices for bound in self.rates]
        Q, s = [(ZERO,) * n, *rest], (Fraction(1), *self.crossed)
        charged = [
            sum((s[j] * Q[j][i] for j in range(n)), half / 2) for i, half in enumerate((ZERO, *self.squared))
        ]
        spent = [
            sum((row[i] * row[k] / t for row, t in zip(rest, self.squared, strict=True)), beside) / 2
            for i, k in product(range(n), repeat=2)
            for beside in [Q[i][k] / s[i] + Q[k][i] / s[k]]
        ]
        return 2 * max(*charged, *spent)


@rule(ChainCoriolisBelow, RateBounds)
def by_rates(statement: ChainCoriolisBelow, proof: RateBounds) -> Accepted:
    """Soundness: with R_j = ½ ∂M/∂q_j, of which R_1 = 0, and |xᵀR_jz|² ≤ xᵀQ_jx zᵀQ_jz,

    zᵀC(q, x)x = Σ_j (2 x_j zᵀR_jx − z_j xᵀR_jx)
    ≤ Σ_j (s_j zᵀQ_jz + x_j² xᵀQ_jx/s_j + ½ t_j z_j² + ½ (xᵀQ_jx)²/t_j) ≤ ½ κ (‖z‖² + ‖x‖⁴):

    ½ κ is above each coefficient of a z_i², and above each of an x_i² x_k². So ‖C(q, x)x‖ ≤ κ for unit z, x.
    """
    links, n = statement.links, len(statement.links)
    sizes = {len(proof.rates), len(proof.crossed), len(proof.squared)}
    require(sizes == {n - 1}, "rates", sizes, f"must be bounded for {n - 1} joints")
    positive = all(share > 0 for share in (*proof.crossed, *proof.squared))
    require(positive, "shares", "", "must be positive")
    shown = all(
        bound.holds([rate_of_mass(links, j, sign) for sign in (1, -1)], 4)
        for j, bound in enumerate(proof.rates, 1)
    )
    require(shown, "forms", "", "do not show the bounds of the rates of M")
    require(proof.reached <= statement.high, "high", statement.high, f"must be at least {proof.reached}")
    return Accepted("proved", "enclosure")


# --- What holds of M(q) and C(q, w) of every chain of links, because of what they are.
#
# References: ``reyes2019family``, Properties 2.1 and 2.3 to 2.5.

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
