"""M(q) of one arm: how small and how large it is at most.

References: ``reyes2019family``, Properties 2.1 and 2.2.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import chain, product
from math import prod

from flint import arb

from lyapcheck.check.expressions.text import diagonal_text, number_text
from lyapcheck.check.judgement import MAX_ARM
from lyapcheck.check.loop import masses_at_corners
from lyapcheck.check.loop.chain import RigidLink, makes
from lyapcheck.check.loop.field import MOST_BOXES
from lyapcheck.check.loop.inertia import Inertia, inertia_of
from lyapcheck.check.numbers.balls import to_arb
from lyapcheck.check.numbers.members import member_text
from lyapcheck.check.refusal import require
from lyapcheck.check.statement import Ends, Mass, Monomials, Proof, Total
from lyapcheck.check.verify import Accepted, all_proved, rule

MAX_POWER = 40
MAX_PARAMETERS = 16
MAX_HARMONICS = 2_000_000
"""Products of exponentials to which polynomials may be expanded; those of a seven-joint arm are 260,000."""
LONGEST = 150
"""Characters beyond which M(q) is no longer written out in a statement."""


def require_mass(mass: Mass, parameters: tuple[Ends, ...]) -> None:
    """Refuse what is not a square matrix of polynomials in sines, cosines and parameters."""
    n = len(mass)
    require(all(len(row) == n for row in mass), "mass", "a row", f"must have {n} entries")
    require_polynomials(chain.from_iterable(mass), n, parameters)


def require_polynomials(entries: Iterable[Monomials], n: int, parameters: tuple[Ends, ...]) -> None:
    """Refuse what are not polynomials in the sines and cosines of n angles and in parameters with ranges."""
    length = 2 * n + len(parameters)
    require(1 <= n <= MAX_ARM, "joints", n, f"must be from 1 to {MAX_ARM}")
    harmonics = 0
    for powers, _ in chain.from_iterable(entries):
        fits = len(powers) == length and all(0 <= p <= MAX_POWER for p in powers)
        require(fits, "exponents", powers, f"must be {length} numbers from 0 to {MAX_POWER}")
        harmonics += prod(sine + cosine + 1 for sine, cosine in zip(powers[:n], powers[n:], strict=False))
        require(harmonics <= MAX_HARMONICS, "harmonics", harmonics, f"must not exceed {MAX_HARMONICS}")
    require(len(parameters) <= MAX_PARAMETERS, "parameters", len(parameters), "are too many")
    for low, high in parameters:
        require(low <= high, "range", f"[{low}, {high}]", "is empty")


def require_one_a_joint(statement: object, n: int, *subjects: str) -> None:
    """Refuse more joints than an arm may have, and fields of another length."""
    require(1 <= n <= MAX_ARM, "joints", n, f"must be from 1 to {MAX_ARM}")
    for subject in subjects:
        size = len(getattr(statement, subject))
        require(size == n, subject, size, f"must be {n}, one a joint")


def mass_text(mass: Mass, parameters: tuple[Ends, ...]) -> str:
    """M(q) written out, or where that is long its size and a digest of its entries."""
    return written_out(mass_entries(mass, parameters), f"M(q) of {len(mass)} joints", mass, parameters)


def mass_entries(mass: Mass, parameters: tuple[Ends, ...]) -> list[str]:
    """The entries written out, those below the diagonal where they differ from those above."""
    n, names = len(mass), variable_names(len(mass), len(parameters))
    return [
        f"M{i + 1}{j + 1} = {polynomial_text(mass[i][j], names)}"
        for i, j in product(range(n), repeat=2)
        if j >= i or mass[i][j] != mass[j][i]
    ]


def written_out(entries: list[str], what: str, data: object, parameters: tuple[Ends, ...]) -> str:
    """Entries and the ranges of parameters, or where that is long what they are and a digest of them."""
    ranged = [f"p{k + 1} in [{number_text(a)}, {number_text(b)}]" for k, (a, b) in enumerate(parameters)]
    written = ", ".join([*entries, *ranged])
    if len(written) <= LONGEST:
        return written
    from hashlib import sha256  # which loads a library of its own, and is seldom needed

    digest = sha256(repr((data, parameters)).encode()).hexdigest()[:32]
    more = f" and {len(parameters)} uncertain numbers" if parameters else ""
    return f"the {what}{more} with digest {digest}"


def variable_names(n: int, parameters: int) -> list[str]:
    """What the exponents of a term belong to."""
    harmonics = [*(f"sin q{i + 1}" for i in range(n)), *(f"cos q{i + 1}" for i in range(n))]
    return harmonics + [f"p{k + 1}" for k in range(parameters)]


def polynomial_text(entry: Monomials, names: Sequence[str]) -> str:
    """A polynomial with these names of its variables."""
    terms = []
    for powers, c in entry:
        factors = [f"{name}^{p}" if p > 1 else name for name, p in zip(names, powers, strict=True) if p]
        if abs(c) != 1 or not factors:
            factors.insert(0, number_text(abs(c)))
        terms.append(("−" if c < 0 else "") + "·".join(factors))
    return " + ".join(terms).replace("+ −", "− ") or "0"


def potential_text(
    energy: Monomials, n: int, parameters: int, what: str = "potential U(q)", name: str = "U"
) -> str:
    """An energy written out, or its digest."""
    entry = f"{name} = {polynomial_text(energy, variable_names(n, parameters))}"
    return written_out([entry], what, energy, ())


DECREASING = (
    "M(q) ≻ 0, and dV/dt < 0 along (11) at every state but the origin, which is therefore globally "
    "asymptotically stable by Lyapunov's direct method"
)


def law_text(
    viscous: Sequence[Ends],
    family: str,
    m: int | None,
    kp: Sequence[Fraction],
    kv: Sequence[Fraction],
    beside: str = ", K_v",
) -> str:
    """B, h and the gains of a closed loop."""
    friction = ", ".join(" … ".join(dict.fromkeys(map(number_text, ends))) for ends in viscous)
    return (
        f"B = diag({friction}), h = {member_text(family, m)}, "
        f"K_p = {diagonal_text(kp)}{beside} = {diagonal_text(kv)}"
    )


@dataclass(frozen=True)
class Bisection(Proof):
    """The checker cuts the angles and parameters into boxes until each shows it."""

    rule = "bisection"


@dataclass(frozen=True)
class HarmonicSizes(Proof):
    """The sum of the sizes of the harmonics of each entry suffices."""

    rule = "sizes of harmonics"


@dataclass(frozen=True)
class PostureWitness(Proof):
    """A posture q, parameters and vectors x, y at which the bound fails, by balls; y for C alone."""

    rule = "posture"
    q: tuple[Fraction, ...]
    parameters: tuple[Fraction, ...]
    x: tuple[Fraction, ...]
    y: tuple[Fraction, ...] = ()


class Bound(Total):
    """A bound for all postures and parameters of one arm."""

    @abstractmethod
    def excess(self, at: PostureWitness) -> arb:
        """What is positive only where the bound fails, at one posture; refused if that does not fit."""


class Bounded(Bound):
    """A bound of polynomials."""

    @abstractmethod
    def shown_by_boxes(self, most: int = MOST_BOXES) -> bool:
        """Whether it is shown by boxes that are cut until they show it."""


class BoundedAbove(Bounded):
    """A bound ``high`` of a norm."""

    high: Fraction

    @abstractmethod
    def square_by_sizes(self) -> Fraction:
        """A bound of the square of the norm, from the sizes of harmonics."""


@rule(Bounded, Bisection)
def by_boxes(statement: Bounded, proof: Bisection) -> Accepted:
    """Soundness: see :meth:`Field.throughout`; each box shows the bound for all that it encloses."""
    require(statement.shown_by_boxes(), "bound", "", "is not shown by boxes")
    return Accepted("proved", "enclosure")


@rule(BoundedAbove, HarmonicSizes)
def by_sizes(statement: BoundedAbove, proof: HarmonicSizes) -> Accepted:
    """Soundness: no polynomial is larger than the sizes of its harmonics together."""
    require(statement.high >= 0, "high", statement.high, "must not be negative")
    reached = statement.square_by_sizes()
    require(reached <= statement.high**2, "squares", reached, f"are above {statement.high}²")
    return Accepted("proved", "exact")


@rule(Bound, PostureWitness)
def by_posture(statement: Bound, proof: PostureWitness) -> Accepted:
    """Soundness: the bound fails at one posture, by balls."""
    require(statement.excess(proof) > 0, "posture", "", "does not show that the bound fails")
    return Accepted("refuted", "enclosure")


def require_posture(proof: PostureWitness, n: int, parameters: tuple[Ends, ...]) -> None:
    """Refuse angles of another number of joints, and parameters out of their ranges."""
    require(len(proof.q) == n, "posture", len(proof.q), f"must have {n} joints")
    require_within("parameters", proof.parameters, parameters)


def require_within(subject: str, values: Sequence[Fraction], ranges: Sequence[Ends]) -> None:
    """Refuse values out of their ranges, or of another number."""
    require(len(values) == len(ranges), subject, len(values), f"must be {len(ranges)}")
    for value, (low, high) in zip(values, ranges, strict=True):
        require(low <= value <= high, subject, value, f"must be between {low} and {high}")


def vector(name: str, entries: tuple[Fraction, ...], n: int) -> list[arb]:
    """A vector of a witness in balls, refused where it does not fit."""
    require(len(entries) == n, name, len(entries), f"must have {n} entries")
    require(any(entries), name, "0", "must not be the zero vector")
    return [to_arb(value) for value in entries]


@dataclass(frozen=True)
class OfArm(Total):
    """What statements on M(q) share: M, kg·m², and the range of each parameter in it."""

    mass: Mass
    parameters: tuple[Ends, ...]

    def require_well_formed(self) -> None:
        require_mass(self.mass, self.parameters)

    @property
    def joints(self) -> int:
        return len(self.mass)

    @property
    def inertia(self) -> Inertia:
        return inertia_of(self.mass, self.parameters)

    @property
    def symmetric(self) -> Inertia:
        """M(q), refused where it is not symmetric."""
        require(self.inertia.symmetric, "M", "", "is not symmetric")
        return self.inertia

    @property
    def over(self) -> str:
        return f"for all q, with {mass_text(self.mass, self.parameters)}"


@dataclass(frozen=True)
class MassAbove(OfArm, Bounded):
    """M(q) is symmetric and M(q) − low·I positive definite, for all q and parameters; kg·m²."""

    low: Fraction

    def require_well_formed(self) -> None:
        super().require_well_formed()
        require(self.low >= 0, "low", self.low, "must not be negative")

    def text(self) -> str:
        return f"M(q) = M(q)ᵀ ≻ {number_text(self.low) + '·I' if self.low else '0'} {self.over}"

    def shown_by_boxes(self, most: int = MOST_BOXES) -> bool:
        return self.symmetric.above([self.low] * self.joints, most)

    def excess(self, at: PostureWitness) -> arb:
        """low xᵀx − xᵀMx."""
        require_posture(at, self.joints, self.parameters)
        x = vector("x", at.x, self.joints)
        return to_arb(self.low) * dot(x, x) - dot(x, self.inertia.times(at.q, at.parameters, x))


@dataclass(frozen=True)
class MassBelow(OfArm, BoundedAbove):
    """‖M(q)‖ <= high, for all q and parameters; kg·m²."""

    high: Fraction

    def text(self) -> str:
        return f"‖M(q)‖ ≤ {number_text(self.high)} {self.over}"

    def shown_by_boxes(self, most: int = MOST_BOXES) -> bool:
        """See :meth:`Inertia.below`; a symmetric matrix is as large as its eigenvalues."""
        return self.symmetric.below(self.high, most)

    def square_by_sizes(self) -> Fraction:
        """A symmetric matrix is nowhere larger than its largest row sum of absolute values."""
        return self.symmetric.largest_row**2

    def excess(self, at: PostureWitness) -> arb:
        """‖Mx‖² − high² ‖x‖²; no norm is negative."""
        require_posture(at, self.joints, self.parameters)
        x = vector("x", at.x, self.joints)
        moved = self.symmetric.times(at.q, at.parameters, x)
        return dot(moved, moved) - to_arb(max(self.high, Fraction(0))) ** 2 * dot(x, x)


@dataclass(frozen=True)
class Links(Proof):
    """The links of the arm: M ≻ 0, because the first that moves has a positive energy."""

    rule = "links"
    links: tuple[RigidLink, ...]


@rule(MassAbove, Links)
def by_links(statement: MassAbove, proof: Links) -> Accepted:
    """Soundness: xᵀMx is the sum of energies none of which is negative; the first that moves is positive."""
    require(statement.low == 0, "low", statement.low, "must be 0: energies give no number")
    require(not statement.parameters, "parameters", len(statement.parameters), "must be none")
    made = makes(proof.links, statement.mass)
    require(made, "links", len(proof.links), "must be one joint and real body for each row, making this M")
    moves = all(link.about_axis > 0 for link in proof.links)
    require(moves, "links", "", "have one without energy about its own axis")
    return Accepted("proved", "exact")


def dot(x: Sequence[arb], y: Sequence[arb]) -> arb:
    """xᵀy."""
    return sum((a * b for a, b in zip(x, y, strict=True)), arb(0))


# --- Proofs over ranges of M's parameters by one proof for each corner, where M is affine in each of them.
#
# M and dV/dt at one state then are affine in each parameter too: M is a mean of its values at the corners,
# and dV/dt is nowhere above the largest of its values there.
#
# References: ``reyes2019family`` (11), (15).


@dataclass(frozen=True)
class MassAtCorners(Proof):
    """Proofs of M(q) − low·I ≻ 0, one for each corner of the ranges, in the order of ``corners_of``."""

    rule = "M at corners"
    each: tuple[Proof, ...]


@rule(MassAbove, MassAtCorners)
def mass_by_corners(statement: MassAbove, proof: MassAtCorners) -> Accepted:
    """Soundness: at one posture M is a mean of its values at the corners, and so is xᵀ(M − low·I)x."""
    require(bool(statement.parameters), "parameters", "", "must be there")
    corners = masses_at_corners(statement.mass, statement.parameters)
    at = [("M at a corner", MassAbove(mass, (), statement.low)) for mass in corners]
    return all_proved(at, proof.each, "corners")
