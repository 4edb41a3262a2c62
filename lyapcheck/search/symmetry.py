"""Sign changes of the joint angles that leave dV/dt as it is, and the part of the errors they let one skip.

If M(σq) = Σ M(q) Σ with Σ = diag(σ), σ_i = ±1, then the Christoffel matrix obeys C(σq, Σx) = Σ C(q, x) Σ, and
with e → Σe, w → Σw every term of dV/dt keeps its value, because h is odd, h' even, and B, K_p, K_v are
diagonal. States that differ by such a change need be looked at only once.
"""

from __future__ import annotations

from itertools import product

from flint import fmpq_mpoly

from lyapcheck.robots import RobotModel, trig


def sign_symmetries(model: RobotModel) -> list[tuple[int, ...]]:
    """All σ with M(σq) = Σ M(q) Σ as an identity of polynomials, the trivial one left out."""
    return [signs for signs in product((1, -1), repeat=model.n) if -1 in signs and _keeps(model, signs)]


def _keeps(model: RobotModel, signs: tuple[int, ...]) -> bool:
    joints = range(model.n)
    return all(
        _mirrored(model.mass[i][j], signs) == trig.normal_form(signs[i] * signs[j] * model.mass[i][j])
        for i in joints
        for j in joints
    )


def _mirrored(poly: fmpq_mpoly, signs: tuple[int, ...]) -> fmpq_mpoly:
    """The polynomial with q_i replaced by σ_i q_i: s_i changes sign, c_i does not."""
    n = len(signs)
    terms = []
    for powers, coefficient in trig.to_terms(poly):
        flips = sum(powers[i] for i in range(n) if signs[i] < 0)
        terms.append((powers, -coefficient if flips % 2 else coefficient))
    return trig.normal_form(trig.from_terms(poly.context(), terms))


def one_sided(symmetries: list[tuple[int, ...]]) -> tuple[int, ...]:
    """The joints whose error may be taken ≥ 0: the pivots of the symmetries as vectors over GF(2).

    In reduced echelon form each basis symmetry flips its own pivot and no other one, so that the errors at
    the pivots can be made non-negative one after the other.
    """
    basis: list[tuple[int, ...]] = []
    for signs in symmetries:
        row = tuple(int(sign < 0) for sign in signs)
        for kept in basis:
            if row[kept.index(1)]:
                row = _sum(row, kept)
        if any(row):
            basis = [_sum(kept, row) if kept[row.index(1)] else kept for kept in basis] + [row]
    return tuple(sorted(row.index(1) for row in basis))


def _sum(a: tuple[int, ...], b: tuple[int, ...]) -> tuple[int, ...]:
    return tuple((x + y) % 2 for x, y in zip(a, b, strict=True))
