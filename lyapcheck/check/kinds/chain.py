"""M(q) and g(q) of a chain of links, as a tree of rotations: how small and how large they are at most.

A chain stands for the M and g that ``lyapcheck.check.loop.chain`` evaluates; nothing is written out.

References: ``reyes2019family``, Properties 2.1, 2.2, 2.6 and 2.8.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from flint import arb, fmpq_mat

from lyapcheck.check.expressions.text import number_text
from lyapcheck.check.kinds.inertia import Bound, PostureWitness, dot, require_posture, written_out
from lyapcheck.check.loop import storage
from lyapcheck.check.loop.chain import Posture, RigidLink
from lyapcheck.check.loop.links import lever_bound, pulls
from lyapcheck.check.numbers.balls import to_arb
from lyapcheck.check.numbers.vectors import ZERO, Algebra
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
        """Joints with axes of length 1, rotations and bodies."""
        n = len(self.links)
        require(1 <= n <= MAX_LINKS, "links", n, f"must be 1 to {MAX_LINKS}")
        for link in self.links:
            short = all(len(str(max(abs(x.numerator), x.denominator))) <= MAX_DIGITS for x in _numbers(link))
            require(short, "link", "", f"must have numbers of at most {MAX_DIGITS} digits")
            require(link.fits, "link", "", "must have a unit axis, a rotation, mass and inertia ⪰ 0")

    @property
    def over(self) -> str:
        """``for all q, …``."""
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
        """x and M(q)x in balls."""
        rows, n = self.at(witness).mass(), len(self.links)
        require(len(witness.x) == n, "x", len(witness.x), f"must have {n} entries")
        require(any(witness.x), "x", "0", "must not be the zero vector")
        x = [to_arb(value) for value in witness.x]
        return x, [dot(row, x) for row in rows]


@dataclass(frozen=True)
class ChainAbove(OfChain):
    """M(q) − low·I is positive definite for all q; kg·m²."""

    low: Fraction

    def require_well_formed(self) -> None:
        """A chain, and a bound that is not negative."""
        super().require_well_formed()
        require(self.low >= 0, "low", self.low, "must not be negative")

    def text(self) -> str:
        """``M(q) ≻ low·I …``."""
        return f"M(q) ≻ {number_text(self.low) + '·I' if self.low else '0'} {self.over}"

    def attempts(self) -> list[Proof]:
        """Of the bound 0."""
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
        """``‖M(q)‖ ≤ high …``."""
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
        """A chain, a vector and some of its joints."""
        super().require_well_formed()
        require(len(self.fall) == 3, "fall", len(self.fall), "must have 3 entries")
        rising = list(self.joints) == sorted(set(self.joints))
        known = len(self.joints) > 0 and all(1 <= i <= len(self.links) for i in self.joints)
        require(rising and known, "joints", self.joints, "must be some joints, each once, in order")
        require(self.high >= 0, "high", self.high, "must not be negative")

    def text(self) -> str:
        """``‖(g1, …)‖ ≤ high …``."""
        names = ", ".join(f"g{i}(q)" for i in self.joints)
        size = f"|{names}|" if len(self.joints) == 1 else f"‖({names})‖"
        return f"{size} ≤ {number_text(self.high)} with free fall {_vector(self.fall)}, {self.over}"

    def excess(self, at: PostureWitness) -> arb:
        """Σ g_i² − high²."""
        torques = self.at(at).torques(self.fall)
        counted = [torques[i - 1] for i in self.joints]
        return dot(counted, counted) - to_arb(self.high**2)


@dataclass(frozen=True)
class StorageForms(Proof):
    """For each joint the coefficients of its storage form; see :func:`storage.turning_form`."""

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
    """Masses times distances from each axis; for ``along`` see `lyapcheck.check.loop.links.lever_bound`."""

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
    stages = storage.energy(statement.links, -1)
    _require_shown(stages, _forms(proof, statement, 2), -statement.low)
    return Accepted("proved", "enclosure")


@rule(ChainBelow, StorageForms)
def by_energy_from_above(statement: ChainBelow, proof: StorageForms) -> Accepted:
    """Soundness: 0 ≤ xᵀMx < κ‖x‖² for x ≠ 0 with κ = high: M is symmetric and a sum of energies."""
    stages = storage.energy(statement.links, 1)
    _require_shown(stages, _forms(proof, statement, 2), statement.high)
    return Accepted("proved", "enclosure")


@rule(ChainGravityBelow, StorageForms)
def by_power_of_gravity(statement: ChainGravityBelow, proof: StorageForms) -> Accepted:
    """Soundness: 2zᵀg ≤ κ‖z‖² + s_1(X_1 w_0) ≤ κ(‖z‖² + 1), κ = high; z along g, ‖z‖ = 1."""
    stages = storage.weight(statement.links, [i - 1 for i in statement.joints])
    forms = _forms(proof, statement, 3)
    _require_shown(stages, forms, statement.high)
    stored = storage.stored_at_base(stages, forms, statement.fall)
    require(stored <= statement.high, "form at the base", stored, f"is above {statement.high}")
    return Accepted("proved", "enclosure")


@rule(ChainGravityBelow, OwnLevers)
def by_own_levers(statement: ChainGravityBelow, proof: OwnLevers) -> Accepted:
    """Soundness: see `lyapcheck.check.loop.links.lever_bound`, of each joint by itself."""
    bounds = (lever_bound(statement.links, statement.fall, i - 1, proof.along) for i in statement.joints)
    reached = sum((bound**2 for bound in bounds), Fraction(0))
    require(reached <= statement.high**2, "squares", reached, f"are above {statement.high}²")
    return Accepted("proved", "exact")


@rule(ChainGravityBelow, NoTorque)
def by_no_torque(statement: ChainGravityBelow, proof: NoTorque) -> Accepted:
    """Soundness: see `lyapcheck.check.loop.links.pulls`; high is not negative."""
    none = all(pulls(statement.links, statement.fall, i - 1, ()) for i in statement.joints)
    require(none, "g", "", "does not vanish at these joints")
    return Accepted("proved", "exact")


def _forms(proof: StorageForms, statement: OfChain, vectors: int) -> list[fmpq_mat]:
    count = vectors * (3 * vectors + 1) // 2
    sizes = len(proof.forms) == len(statement.links) and all(len(row) == count for row in proof.forms)
    require(sizes, "forms", len(proof.forms), f"must be {count} coefficients for each joint")
    return [storage.invariant_form(row, vectors) for row in proof.forms]


def _require_shown(stages: Sequence[storage.Stage], forms: Sequence[fmpq_mat], kappa: Fraction) -> None:
    prices = [kappa] * len(stages)
    require(storage.shows(stages, forms, prices), "forms", "", "do not show the bound at every joint")


def _numbers(link: RigidLink) -> list[Fraction]:
    rows = (link.axis, link.origin, link.com, *link.inertia, *link.turn)
    return [link.mass, *(x for row in rows for x in row)]


def _link_text(link: RigidLink) -> str:
    inertia, turn = (f"({', '.join(map(_vector, rows))})" for rows in (link.inertia, link.turn))
    return (
        f"axis {_vector(link.axis)}, place {_vector(link.origin)}, turn {turn}, "
        f"mass {number_text(link.mass)}, centre {_vector(link.com)}, inertia {inertia}"
    )


def _vector(entries: Sequence[Fraction]) -> str:
    return f"({', '.join(map(number_text, entries))})"
