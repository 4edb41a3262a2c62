"""M(q) and g(q) of a chain of links, as a tree of rotations: how small and how large they are at most.

A chain stands for the M and g that ``lyapcheck.check.loop.chain`` evaluates; nothing is written out.

References: ``reyes2019family``, Properties 2.1, 2.2, 2.6 and 2.8.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import chain, product

from flint import arb

from lyapcheck.check.expressions.text import list_text, number_text
from lyapcheck.check.kinds.inertia import Bound, PostureWitness, dot, require_posture, vector, written_out
from lyapcheck.check.loop import storage
from lyapcheck.check.loop.chain import Posture, RigidLink, lever_bound, pulls, turning
from lyapcheck.check.loop.storage import Shown, rate_of_mass
from lyapcheck.check.numbers.balls import to_arb
from lyapcheck.check.numbers.vectors import ZERO, Algebra, transposed
from lyapcheck.check.refusal import require
from lyapcheck.check.statement import Proof, Total
from lyapcheck.check.verify import Accepted, rule

MAX_LINKS = 12
MAX_DIGITS = 400
"""Of a numerator or denominator of a link."""


@dataclass(frozen=True)
class OfLinks(Total):
    """What the kinds below share: ``links`` are the joints and bodies, base first."""

    links: tuple[RigidLink, ...]

    def require_well_formed(self) -> None:
        n = len(self.links)
        require(1 <= n <= MAX_LINKS, "links", n, f"must be 1 to {MAX_LINKS}")
        for link in self.links:
            rows = (link.axis, link.origin, link.com, *link.inertia, *link.turn)
            sizes = (
                max(abs(x.numerator), x.denominator)
                for x in (link.mass, link.rotor, *chain.from_iterable(rows))
            )
            short = all(len(str(size)) <= MAX_DIGITS for size in sizes)
            require(short, "link", "", f"must have numbers of at most {MAX_DIGITS} digits")
            require(link.fits, "link", "", "must have a unit axis, a rotation, mass, inertia and rotor ⪰ 0")

    @property
    def over(self) -> str:
        entries = [f"link {k + 1}: {_link_text(link)}" for k, link in enumerate(self.links)]
        return f"for all q, with {written_out(entries, f'chain of {len(self.links)} links', self.links, ())}"


@dataclass(frozen=True)
class OfChain(OfLinks, Bound):
    """A bound of M(q) or g(q) of some links."""

    def at(self, witness: PostureWitness) -> Posture:
        """The chain at the posture of a witness, in balls; refused if that does not fit."""
        require_posture(witness, len(self.links), ())
        q = [to_arb(angle) for angle in witness.q]
        return Posture(self.links, [x.sin() for x in q], [x.cos() for x in q], Algebra(to_arb))

    def moved(self, witness: PostureWitness) -> tuple[list[arb], list[arb]]:
        rows = self.at(witness).mass()
        x = vector("x", witness.x, len(self.links))
        return x, [dot(row, x) for row in rows]


@dataclass(frozen=True)
class ChainAbove(OfChain):
    """M(q) − low·I is positive definite for all q; kg·m²."""

    low: Fraction

    def require_well_formed(self) -> None:
        super().require_well_formed()
        require(self.low >= 0, "low", self.low, "must not be negative")

    def text(self) -> str:
        return f"M(q) ≻ {number_text(self.low) + '·I' if self.low else '0'} {self.over}"

    def attempts(self) -> list[Proof]:
        return [OwnMoments()] if self.low == 0 else []

    def excess(self, at: PostureWitness) -> arb:
        """low xᵀx − xᵀMx."""
        x, moved = self.moved(at)
        return to_arb(self.low) * dot(x, x) - dot(x, moved)


@dataclass(frozen=True)
class ChainBelow(OfChain):
    """‖M(q)‖ <= high for all q; kg·m²."""

    high: Fraction

    def text(self) -> str:
        return f"‖M(q)‖ ≤ {number_text(self.high)} {self.over}"

    def excess(self, at: PostureWitness) -> arb:
        """‖Mx‖² − high² ‖x‖²; no norm is negative."""
        x, moved = self.moved(at)
        return dot(moved, moved) - to_arb(max(self.high, ZERO)) ** 2 * dot(x, x)


@dataclass(frozen=True)
class ChainGravityBelow(OfChain):
    """√Σ g_i(q)² <= high over some joints i, for all q; N·m.

    ``fall`` is the acceleration of free fall in the base frame, m/s²; ``joints`` count from 1 and rise.
    """

    fall: tuple[Fraction, ...]
    joints: tuple[int, ...]
    high: Fraction

    def require_well_formed(self) -> None:
        super().require_well_formed()
        require(len(self.fall) == 3, "fall", len(self.fall), "must have 3 entries")
        rising = list(self.joints) == sorted(set(self.joints))
        known = len(self.joints) > 0 and all(1 <= i <= len(self.links) for i in self.joints)
        require(rising and known, "joints", self.joints, "must be some joints, each once, in order")
        require(self.high >= 0, "high", self.high, "must not be negative")

    def text(self) -> str:
        names = ", ".join(f"g{i}(q)" for i in self.joints)
        size = f"|{names}|" if len(self.joints) == 1 else f"‖({names})‖"
        return f"{size} ≤ {number_text(self.high)} with free fall {list_text(self.fall)}, {self.over}"

    def excess(self, at: PostureWitness) -> arb:
        """Σ g_i² − high²."""
        torques = self.at(at).torques(self.fall)
        counted = [torques[i - 1] for i in self.joints]
        return dot(counted, counted) - to_arb(self.high**2)


@dataclass(frozen=True)
class StorageForms(Proof):
    """For each joint the coefficients of its storage form; see :func:`storage.invariant_form`."""

    rule = "storage forms"
    forms: storage.Forms


@dataclass(frozen=True)
class OwnMoments(Proof):
    """Each link has a moment of inertia about its own axis."""

    rule = "own moments"


@dataclass(frozen=True)
class NoTorque(Proof):
    """Gravity exerts no torque at these joints; the checker computes it, so the proof has no data."""

    rule = "no torque"


@dataclass(frozen=True)
class OwnLevers(Proof):
    """Masses times distances from each axis; for ``along`` see `lyapcheck.check.loop.chain.lever_bound`."""

    rule = "own levers"
    along: tuple[int, ...]


@rule(ChainAbove, OwnMoments)
def by_own_moments(statement: ChainAbove, proof: OwnMoments) -> Accepted:
    """Soundness: xᵀMx is a sum of energies, none negative; that of the first link that moves is positive."""
    require(statement.low == 0, "low", statement.low, "must be 0: moments give no number")
    moves = all(link.about_axis > 0 for link in statement.links)
    require(moves, "links", "", "have one without a moment about its own axis")
    return Accepted("proved", "exact")


@rule(ChainAbove, StorageForms)
def by_energy_from_below(statement: ChainAbove, proof: StorageForms) -> Accepted:
    """Soundness: −xᵀMx < κ‖x‖² for x ≠ 0 with κ = −low, see `lyapcheck.check.loop.storage`."""
    return _by_forms(storage.energy(statement.links, -1), proof, -statement.low, 2)


@rule(ChainBelow, StorageForms)
def by_energy_from_above(statement: ChainBelow, proof: StorageForms) -> Accepted:
    """Soundness: 0 ≤ xᵀMx < κ‖x‖² for x ≠ 0 with κ = high: M is symmetric and a sum of energies."""
    return _by_forms(storage.energy(statement.links, 1), proof, statement.high, 2)


@rule(ChainGravityBelow, StorageForms)
def by_power_of_gravity(statement: ChainGravityBelow, proof: StorageForms) -> Accepted:
    """Soundness: 2zᵀg ≤ κ‖z‖² + s_1(X_1 w_0) ≤ κ(‖z‖² + 1), κ = high; z along g, ‖z‖ = 1."""
    stages = storage.weight(statement.links, [i - 1 for i in statement.joints])
    result = _by_forms(stages, proof, statement.high, 3)
    at_base = storage.invariant_form(proof.forms[0], 3)
    stored = storage.stored_at_base(stages, [at_base], statement.fall)
    require(stored <= statement.high, "form at the base", stored, f"is above {statement.high}")
    return result


def _by_forms(
    stages: Sequence[storage.Stage], proof: StorageForms, kappa: Fraction, vectors: int
) -> Accepted:
    shown = Shown((kappa,) * len(stages), (proof.forms,)).holds([stages], vectors)
    require(shown, "forms", "", "do not show the bound at every joint")
    return Accepted("proved", "enclosure")


@rule(ChainGravityBelow, OwnLevers)
def by_own_levers(statement: ChainGravityBelow, proof: OwnLevers) -> Accepted:
    """Soundness: see `lyapcheck.check.loop.chain.lever_bound`, of each joint by itself."""
    bounds = (lever_bound(statement.links, statement.fall, i - 1, proof.along) for i in statement.joints)
    reached = sum((bound**2 for bound in bounds), Fraction(0))
    require(reached <= statement.high**2, "squares", reached, f"are above {statement.high}²")
    return Accepted("proved", "exact")


@rule(ChainGravityBelow, NoTorque)
def by_no_torque(statement: ChainGravityBelow, proof: NoTorque) -> Accepted:
    """Soundness: see `lyapcheck.check.loop.chain.pulls`; high is not negative."""
    none = all(pulls(statement.links, statement.fall, i - 1, ()) for i in statement.joints)
    require(none, "g", "", "does not vanish at these joints")
    return Accepted("proved", "exact")


def _link_text(link: RigidLink) -> str:
    inertia, turn = (f"({', '.join(map(list_text, rows))})" for rows in (link.inertia, link.turn))
    rotor = f", rotor {number_text(link.rotor)}" if link.rotor else ""
    return (
        f"axis {list_text(link.axis)}, place {list_text(link.origin)}, turn {turn}, "
        f"mass {number_text(link.mass)}, centre {list_text(link.com)}, inertia {inertia}{rotor}"
    )


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
        super().require_well_formed()
        require(self.high >= 0, "high", self.high, "must not be negative")

    def text(self) -> str:
        bound = f"‖C(q, x)y‖ ≤ {number_text(self.high)} ‖x‖ ‖y‖"
        return f"{bound} for all x, y, {self.over}; C by Christoffel symbols"

    def excess(self, at: PostureWitness) -> arb:
        """‖C(q, x)x‖² − (high ‖x‖²)², with C(q, x)x = Ṁx − ½ (∂/∂q)(xᵀMx) and Ṁ along q̇ = x."""
        n = len(self.links)
        require_posture(at, n, ())
        require(len(at.x) == n and not at.y, "x", len(at.x), f"must have {n} entries, and y none")
        x = [to_arb(value) for value in at.x]
        q = [to_arb(value) for value in at.q]
        slopes = (turning(self.links, q, k).mass() for k in range(n))
        moved = [[dot([entry[1] for entry in row], x) for row in rows] for rows in slopes]
        pairs = zip(transposed(moved), moved, strict=True)
        torques = [dot(column, x) - dot(x, own) / 2 for column, own in pairs]
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
        super().require_well_formed()
        require(self.identity in IDENTITIES, "identity", self.identity, f"must be one of {list(IDENTITIES)}")

    def text(self) -> str:
        return f"{IDENTITIES[self.identity]} {self.over}; C by Christoffel symbols"

    def attempts(self) -> list[Proof]:
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
