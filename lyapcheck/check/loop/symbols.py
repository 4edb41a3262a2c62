"""C(q, x)x of an arm whose M(q) is written out: a bound at all postures, as a matrix of rates and products.

With v the rates z_1, …, z_n and the products x_i x_j, i ≤ j, 2 zᵀC(q, x)x ≤ κ(‖z‖² + ‖x‖⁴) is vᵀHv ≥ 0,

    H = diag(κ, …, κ, 0) − (C_v + C_vᵀ) + κ s sᵀ + N,    zᵀC(q, x)x = zᵀC_v (x_i x_j),    sᵀ(x_i x_j) = ‖x‖²,

where C_v are the Christoffel symbols and N vanishes on products, see ``head``. As trigonometric polynomials
of the angles both are seen at control points.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from functools import cached_property
from itertools import combinations_with_replacement

from flint import arb, arb_mat, fmpq

from lyapcheck.check.loop.control_points import definite_at_all_angles, nodes
from lyapcheck.check.loop.head import assembled, relation
from lyapcheck.check.loop.inertia import Inertia
from lyapcheck.check.numbers.balls import to_arb
from lyapcheck.check.numbers.harmonics import angles_in
from lyapcheck.check.refusal import require


class Symbols:
    """The Christoffel symbols of an arm without uncertain parameters, at one posture."""

    def __init__(self, inertia: Inertia) -> None:
        self.joints = inertia.n
        self.angles = angles_in([list(inertia.symbols.values())])
        """The joints whose angles enter."""
        self._terms = {
            place: [term for part in entry.values() for term in part.items()]
            for place, entry in inertia.symbols.items()
        }
        self.degree = max((abs(x) for terms in self._terms.values() for k, _ in terms for x in k), default=0)
        """In each angle, at most."""

    @cached_property
    def products(self) -> list[tuple[int, int]]:
        """i ≤ j of the x_i x_j."""
        return list(combinations_with_replacement(range(self.joints), 2))

    @cached_property
    def square(self) -> arb_mat:
        """sᵀ of v, (1, n + products)."""
        return arb_mat([[0] * self.joints + [int(i == j) for i, j in self.products]])

    def power(self, angles: Sequence[fmpq]) -> arb_mat:
        """C_v, (n, products), at the angles that enter, in units of π."""
        result = arb_mat(self.joints, len(self.products))
        turns = dict(zip(self.angles, angles, strict=True))
        for (i, j, k), terms in self._terms.items():
            value = arb(0)
            for multiples, (a, b) in terms:
                angle = arb(sum((x * turns[joint] for joint, x in enumerate(multiples) if x), fmpq(0)))
                value += to_arb(a) * angle.cos_pi() + to_arb(b) * angle.sin_pi()
            result[i, self.products.index((k, j))] += value if j == k else 2 * value
        return result


def shows(
    symbols: Symbols,
    kappa: Fraction,
    relations: Sequence[Sequence[Fraction]],
    start: Sequence[int],
    halvings: Sequence[int],
) -> bool:
    """Whether control points show 2 zᵀC(q, x)x ≤ κ(‖z‖² + ‖x‖⁴) for all q, z and x.

    Args:
        symbols: of the arm.
        kappa: the bound.
        relations: see `head.relation`, at each of the nodes of the angles that enter.
        start: see `definite_at_all_angles`.
        halvings: likewise.
    """
    postures = nodes(symbols.degree, len(symbols.angles))
    require(len(relations) == len(postures), "relations", len(relations), f"must be {len(postures)} rows")
    sizes = symbols.square.transpose() * symbols.square * to_arb(kappa)
    values = (
        assembled(symbols.power(angles), relation(row, symbols.joints) + sizes, kappa)
        for angles, row in zip(postures, relations, strict=True)
    )
    return definite_at_all_angles(values, symbols.degree, start, halvings)
