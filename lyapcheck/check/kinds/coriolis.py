"""Symmetry of M(q), and the Coriolis matrix of one arm: how it goes with the rate of M(q).

C(q, w)_ij = Σ_k c_ijk(q) w_k + c_ij(q), by Christoffel symbols of M(q) or as it is printed.

References: ``reyes2019family``, Properties 2.1 and 2.3 to 2.5.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache, partial
from itertools import chain, product

from flint import arb

from lyapcheck.check.expressions.text import number_text
from lyapcheck.check.kinds.identity import Compared, Gap
from lyapcheck.check.kinds.inertia import (
    BoundedAbove,
    OfArm,
    PostureWitness,
    dot,
    polynomial_text,
    require_polynomials,
    require_posture,
    variable_names,
    vector,
    written_out,
)
from lyapcheck.check.loop.field import MOST_BOXES
from lyapcheck.check.loop.inertia import Inertia
from lyapcheck.check.numbers.balls import to_arb
from lyapcheck.check.numbers.harmonics import Uncertain, by_parameters, mixed, slope
from lyapcheck.check.refusal import require
from lyapcheck.check.statement import Mass

Lost = list[tuple[tuple[int, ...], Uncertain]]


@dataclass(frozen=True)
class MassSymmetric(OfArm, Compared):
    """M(q) = M(q)ᵀ, for all q and parameters."""

    def gaps(self) -> Iterator[Gap]:
        """Each entry below the diagonal less that above."""
        for i, j in product(range(self.joints), repeat=2):
            if j < i:
                gap = mixed([(1, self.inertia.mass[i][j]), (-1, self.inertia.mass[j][i])])
                yield f"M{i + 1}{j + 1}", (), gap

    def text(self) -> str:
        return f"M(q) = M(q)ᵀ {super().over}"


@dataclass(frozen=True)
class _OfCoriolis(OfArm, Compared):
    """``printed`` has for each i and j the polynomials that w1 … wn multiply, and then the one without rate.

    Empty where C is that of Christoffel symbols.
    """

    printed: tuple[Mass, ...]

    def require_well_formed(self) -> None:
        """Polynomials, n + 1 an entry, or none; a symmetric M where its Christoffel symbols are meant."""
        super().require_well_formed()
        if self.speaks_of_symbols:
            for i, j in product(range(self.joints), repeat=2):
                place = f"M{i + 1}{j + 1}"
                require(self.same(i, j), "mass", place, "must be symmetric to have Christoffel symbols")
        n = self.joints
        sizes = [[len(entry) for entry in row] for row in self.printed]
        rule = f"must be nothing or {n} rows of {n} entries, each with {n + 1} polynomials"
        require(sizes in ([], [[n + 1] * n] * n), "printed", sizes, rule)
        require_polynomials(chain.from_iterable(chain.from_iterable(self.printed)), n, self.parameters)

    def same(self, i: int, j: int) -> bool:
        return self.inertia.mass[i][j] == self.inertia.mass[j][i]

    @property
    def speaks_of_symbols(self) -> bool:
        """Whether c_ijk = ½(∂M_ij/∂q_k + ∂M_ik/∂q_j − ∂M_jk/∂q_i) enter, which need M = Mᵀ."""
        return not self.printed

    def symbol(self, i: int, j: int, k: int) -> Uncertain:
        """What w_k multiplies in C_ij; what has no rate for k = n."""
        if self.printed:
            return by_parameters(self.printed[i][j][k], self.joints)
        return _christoffel(self.inertia, i, j, k)

    def lost(self, i: int, j: int) -> Lost:
        """∂M_ij/∂q_k − c_ijk − c_jik for each rate, and what has none."""
        if not self.printed:
            return _lost_by_symbols(self.inertia, i, j)
        n, at, entry = self.joints, self.symbol, self.inertia.mass[i][j]
        result = [((k,), _less(slope(entry, k), at(i, j, k), at(j, i, k))) for k in range(n)]
        return [*result, ((), _less({}, at(i, j, n), at(j, i, n)))]

    @property
    def over(self) -> str:
        about = super().over
        if not self.printed:
            return f"{about}; C by Christoffel symbols"
        n = self.joints
        names = [*variable_names(n, len(self.parameters)), *(f"w{k + 1}" for k in range(n))]
        entries = []
        for i, j in product(range(n), repeat=2):
            rated = [
                ((*powers, *(int(m == k) for m in range(n))), c)
                for k, polynomial in enumerate(self.printed[i][j])
                for powers, c in polynomial
            ]
            entries.append(f"C{i + 1}{j + 1} = {polynomial_text(tuple(rated), names)}")
        return f"{about}; {written_out(entries, 'C as printed', self.printed, ())}"


@dataclass(frozen=True)
class CoriolisAtRest(_OfCoriolis):
    """C(q, 0) = 0, for all q and parameters."""

    def gaps(self) -> Iterator[Gap]:
        for i, j in product(range(self.joints), repeat=2):
            yield f"C{i + 1}{j + 1}", (), self.symbol(i, j, self.joints)

    def text(self) -> str:
        return f"C(q, 0) = 0 {self.over}"


@dataclass(frozen=True)
class RateOfMass(_OfCoriolis):
    """Ṁ(q) = C(q, w) + C(q, w)ᵀ, and both are symmetric, for all q, w and parameters."""

    def gaps(self) -> Iterator[Gap]:
        """∂M_ij/∂q_k − c_ijk − c_jik, which is the same for j and i where M_ij = M_ji."""
        for i, j in product(range(self.joints), repeat=2):
            if j <= i or not self.same(i, j):
                for rates, gap in self.lost(i, j):
                    yield f"entry {i + 1}{j + 1}", rates, gap

    def text(self) -> str:
        return f"Ṁ(q) = C(q, w) + C(q, w)ᵀ with Ṁ along q̇ = w, and both are symmetric, {self.over}"


@dataclass(frozen=True)
class RateLessTwiceCoriolis(_OfCoriolis):
    """Ṁ(q) − 2C(q, w) is skew-symmetric, so that wᵀ[Ṁ − 2C]w = 0, for all q, w and parameters."""

    def gaps(self) -> Iterator[Gap]:
        """∂(M_ij + M_ji)/∂q_k − 2c_ijk − 2c_jik; a skew-symmetric matrix has the quadratic form 0."""
        for i, j in product(range(self.joints), repeat=2):
            if j <= i:
                lost = self.lost(i, j)
                turned = lost if self.same(i, j) else self.lost(j, i)
                for (rates, gap), (_, other) in zip(lost, turned, strict=True):
                    yield f"entry {i + 1}{j + 1}", rates, mixed([(1, gap), (1, other)])

    def text(self) -> str:
        return f"Ṁ(q) − 2C(q, w) is skew-symmetric with Ṁ along q̇ = w, so that wᵀ[Ṁ − 2C]w = 0, {self.over}"


@dataclass(frozen=True)
class CoriolisTorque(_OfCoriolis):
    """C(q, w)w is that of the Christoffel symbols of M(q), for all q, w and parameters."""

    @property
    def speaks_of_symbols(self) -> bool:
        return True

    def gaps(self) -> Iterator[Gap]:
        """What w_j w_k multiplies, and what w_j multiplies."""
        n, own = self.joints, self.inertia.symbols
        for i, j, k in product(range(n), range(n), range(n + 1)):
            if j < k < n:
                both = [(1, self.symbol(i, j, k)), (1, self.symbol(i, k, j))]
                yield f"row {i + 1}", (j, k), mixed([*both, (-2, own.get((i, k, j), {}))])
            elif j == k:
                yield f"row {i + 1}", (j, j), mixed([(1, self.symbol(i, j, j)), (-1, own.get((i, j, j), {}))])
            elif k == n:
                yield f"row {i + 1}", (j,), self.symbol(i, j, n)

    def text(self) -> str:
        return f"C(q, w)w is that of the Christoffel symbols of M, {self.over}"


@lru_cache(maxsize=256)
def _lost_by_symbols(inertia: Inertia, i: int, j: int) -> Lost:
    """For the Christoffel symbols; several statements ask for the same, and it can take seconds."""
    c, entry = partial(_christoffel, inertia), inertia.mass[i][j]
    return [((k,), _less(slope(entry, k), c(i, j, k), c(j, i, k))) for k in range(inertia.n)]


def _christoffel(inertia: Inertia, i: int, j: int, k: int) -> Uncertain:
    return inertia.symbols.get((i, max(j, k), min(j, k)), {})


def _less(entry: Uncertain, first: Uncertain, second: Uncertain) -> Uncertain:
    return mixed([(1, entry), (-1, first), (-1, second)])


# --- C(q, x) of one arm whose M(q) is written out: how large it is at most.
#
# References: ``reyes2019family``, Property 2.6.


@dataclass(frozen=True)
class CoriolisBelow(OfArm, BoundedAbove):
    """‖C(q, x)y‖ <= high ‖x‖ ‖y‖ for the C of Christoffel symbols, all q, x, y and parameters; kg·m²."""

    high: Fraction

    def text(self) -> str:
        bound = f"‖C(q, x)y‖ ≤ {number_text(self.high)} ‖x‖ ‖y‖"
        return f"{bound} for all x, y, {self.over}; C by Christoffel symbols"

    def shown_by_boxes(self, most: int = MOST_BOXES) -> bool:
        """See :meth:`Inertia.coriolis_below`, for a positive bound."""
        return self.high > 0 and self.symmetric.coriolis_below(self.high, most)

    def square_by_sizes(self) -> Fraction:
        return self.symmetric.squares_of_symbols

    def excess(self, at: PostureWitness) -> arb:
        """‖C(q, x)y‖² − high² ‖x‖² ‖y‖²; no norm is negative."""
        require_posture(at, self.joints, self.parameters)
        x, y = vector("x", at.x, self.joints), vector("y", at.y, self.joints)
        turned = self.symmetric.coriolis(at.q, at.parameters, x, y)
        return dot(turned, turned) - to_arb(max(self.high, Fraction(0))) ** 2 * dot(x, x) * dot(y, y)
