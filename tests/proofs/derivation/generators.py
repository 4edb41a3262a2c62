"""A polynomial ring in which V, (14) and (15) have normal forms, and differentiation along (11) in it.

Every entry of M, of C(q, w) and of the gains is a generator, and so are h_i = h(e_i), d_i = h'(e_i),
U_i = U(e_i), g_i = h(w_i), w_i, e_i, a_i = ẇ_i, ε₀, r = ‖e‖, ri = 1/r and s = 1/(1 + r). Nothing is assumed
about them but

    r ri = 1     s (1 + r) = 1     s ri = ri − s        (the last follows from the others)
    M_jj a_j = (K_p h − K_v g − B w − C w)_j − Σ_{i≠j} M_ji a_i                       the second line of (11)

read from left to right. The left sides M_jj a_j share no generator with the other three, whose overlap
r s ri reduces to s either way, so they are a Gröbner basis: two polynomials are equal modulo the relations
exactly when their normal forms are the same.

Differentiation: ė = −w, ẇ = a, ḣ_i = −d_i w_i, U̇_i = −h_i w_i, Ṁ_ij = C_ij + C_ji (property 2.4),
ṙ = −eᵀw/r, ṡ = s² eᵀw/r.

References: (11) and property 2.4 of ``reyes2019family``; ``geddes1992algorithms``, chapter 10.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cached_property, lru_cache
from itertools import product

from flint import Ordering, fmpq, fmpq_mpoly, fmpq_mpoly_ctx

Rule = tuple[tuple[int, ...], fmpq_mpoly]
Matrix = list[list[fmpq_mpoly]]
Vector = list[fmpq_mpoly]

_VECTORS = ("kp", "kv", "b", "h", "d", "U", "g", "w", "e", "a")
_SCALARS = ("eps0", "r", "ri", "s")


@lru_cache(maxsize=32)
def generators(n: int) -> Generators:
    """The ring for n joints."""
    return Generators(n)


class Generators:
    """The generators for n joints as vectors and matrices, with reduction and differentiation.

    Args:
        n: number of joints, at least 1.
    """

    def __init__(self, n: int) -> None:
        if n < 1:
            raise ValueError(f"an arm has at least one joint, got n = {n}")
        self.n = n
        joints = range(n)
        names = [f"{name}{i + 1}" for name in _VECTORS for i in joints]
        names += [f"M{i + 1}_{j + 1}" for i in joints for j in range(i, n)]
        names += [f"C{i + 1}_{j + 1}" for i, j in product(joints, joints)]
        self.names = tuple(names + list(_SCALARS))
        self.ring = fmpq_mpoly_ctx.get(list(self.names), Ordering.lex)
        self._index = {name: k for k, name in enumerate(self.names)}

    def __getitem__(self, name: str) -> fmpq_mpoly:
        """One generator by name, such as ``eps0`` or ``M1_2``."""
        return self.ring.gen(self._index[name])

    def vector(self, name: str) -> Vector:
        """The generators name1 … namen."""
        return [self[f"{name}{i + 1}"] for i in range(self.n)]

    def diagonal(self, name: str) -> Matrix:
        """diag(name1 … namen): K_p, K_v or B."""
        entries, zero = self.vector(name), self.ring.constant(0)
        return [[entries[i] if i == j else zero for j in range(self.n)] for i in range(self.n)]

    @cached_property
    def M(self) -> Matrix:
        """The inertia matrix, symmetric."""
        joints = range(self.n)
        return [[self[f"M{min(i, j) + 1}_{max(i, j) + 1}"] for j in joints] for i in joints]

    @cached_property
    def C(self) -> Matrix:
        """C(q, w)."""
        return [[self[f"C{i + 1}_{j + 1}"] for j in range(self.n)] for i in range(self.n)]

    @cached_property
    def eps(self) -> fmpq_mpoly:
        """ε = ε₀/(1 + r)."""
        return self["eps0"] * self["s"]

    @cached_property
    def half(self) -> fmpq_mpoly:
        """½."""
        return self.ring.constant(fmpq(1, 2))

    @cached_property
    def rates(self) -> dict[int, fmpq_mpoly]:
        """The time derivative of each generator of V that has one, by its place."""
        e, w, h, d, a = (self.vector(name) for name in "ewhda")
        inward = dot(e, w) * self["ri"]
        result = {"r": -inward, "s": self["s"] ** 2 * inward}
        for i in range(self.n):
            k = i + 1
            result |= {f"e{k}": -w[i], f"w{k}": a[i], f"h{k}": -d[i] * w[i], f"U{k}": -h[i] * w[i]}
            result |= {f"M{k}_{j + 1}": self.C[i][j] + self.C[j][i] for j in range(i, self.n)}
        return {self._index[name]: rate for name, rate in result.items()}

    def rate(self, value: fmpq_mpoly) -> fmpq_mpoly:
        """The time derivative along (11) of a polynomial in the state, as a normal form.

        Raises:
            ValueError: the polynomial holds 1/r, h', h(w) or a, whose rates are not generators.
        """
        used = {k for exponents in value.monoms() for k, power in enumerate(exponents) if power}
        frozen = {self._index[name] for name in self.names if name[:2] in ("kp", "kv") or name[0] == "b"}
        unknown = used - set(self.rates) - frozen - {self._index["eps0"]}
        if unknown:
            raise ValueError(f"no rate is known for {', '.join(self.names[k] for k in sorted(unknown))}")
        terms = (value.derivative(k) * rate for k, rate in self.rates.items() if k in used)
        return self.normal_form(total(terms, self.ring.constant(0)))

    @cached_property
    def rules(self) -> tuple[Rule, ...]:
        """The relations as leading monomial and what replaces it."""
        one, r, ri, s = self.ring.constant(1), self["r"], self["ri"], self["s"]
        result = [(r * ri, one), (r * s, one - s), (s * ri, ri - s)]
        a = self.vector("a")
        for j, torque in enumerate(self._torques()):
            others = [self.M[j][i] * a[i] for i in range(self.n) if i != j]
            result.append((self.M[j][j] * a[j], torque - total(others, self.ring.constant(0))))
        return tuple((lead.monoms()[0], value) for lead, value in result)

    def normal_form(self, value: fmpq_mpoly) -> fmpq_mpoly:
        """The one polynomial that equals ``value`` modulo the relations and holds none of the left sides."""
        changed = True
        while changed:
            changed = False
            for lead, replacement in self.rules:
                if any(power > highest for power, highest in zip(lead, value.degrees(), strict=True)):
                    continue
                kept, lifted = self._split(value, lead)
                if lifted:
                    value = self.ring.from_dict(kept) + self.ring.from_dict(lifted) * replacement
                    changed = True
        return value

    def _torques(self) -> Vector:
        """K_p h − K_v g − B w − C w: what M a equals."""
        kp, kv, b, h, g, w = (self.vector(name) for name in ("kp", "kv", "b", "h", "g", "w"))
        turned = times(self.C, w)
        return [kp[i] * h[i] - kv[i] * g[i] - b[i] * w[i] - turned[i] for i in range(self.n)]

    def _split(
        self, value: fmpq_mpoly, lead: tuple[int, ...]
    ) -> tuple[dict[tuple[int, ...], fmpq], dict[tuple[int, ...], fmpq]]:
        """The terms that the leading monomial does not divide, and the quotients of those that it does."""
        places = [(k, power) for k, power in enumerate(lead) if power]
        kept, lifted = {}, {}
        for exponents, coefficient in value.to_dict().items():
            if all(exponents[k] >= power for k, power in places):
                lifted[tuple(x - y for x, y in zip(exponents, lead, strict=True))] = coefficient
            else:
                kept[exponents] = coefficient
        return kept, lifted


def dot(x: Sequence[fmpq_mpoly], y: Sequence[fmpq_mpoly]) -> fmpq_mpoly:
    """xᵀ y."""
    products = [a * b for a, b in zip(x, y, strict=True)]
    return total(products[1:], products[0])


def times(rows: Matrix, x: Sequence[fmpq_mpoly]) -> Vector:
    """The product of a matrix and a vector."""
    return [dot(row, x) for row in rows]


def total(values: Iterable[fmpq_mpoly], start: fmpq_mpoly) -> fmpq_mpoly:
    """start plus all values."""
    for value in values:
        start = start + value
    return start
