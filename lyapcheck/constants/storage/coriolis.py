"""k_c = sup ‖C(q, x)x‖ over unit vectors x from storage forms, for all angles at once.

    2 zᵀC(q, x)x ≤ κ (‖z‖² + ‖x‖⁴)  for all z and x says  k_c ≤ κ,

and both sides are quadratic in the states of `lyapcheck.constants.storage.lift`: the cost of a joint is the
power of its link, its price κ z², and at the end −κ N² with N = ‖x‖². Forms that vanish because products of
the same numbers are products help (`relations`), and so does N ≥ 0 (`positive_products`). The angle of the
second joint is kept and its circle parted into sectors, see `lyapcheck.constants.storage.first_joints`; from
the third joint on the forms are those that turns leave alone.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import inf, isfinite

import numpy as np
from flint import arb, ctx, fmpq

from lyapcheck._types import Array
from lyapcheck.check.loop.arithmetic import BALLS
from lyapcheck.constants.storage import first_joints, lift
from lyapcheck.constants.storage.exact import Exact, rounded, zeros
from lyapcheck.constants.storage.hinges import Hinge
from lyapcheck.constants.storage.program import Blocks, solve
from lyapcheck.constants.torus import PI_ABOVE

_MARGIN = 1e-5
_ANGLES = 17
_SECTORS = 6
_HEAD = 30.0
_TOLERANCE = 1e-5
_BITS = 256


@dataclass(frozen=True, eq=False)
class Basis:
    """The forms of which the unknowns are made."""

    own: list[Array]
    relations: list[Array]
    positive: dict[tuple[int, int], Array]

    @property
    def each(self) -> int:
        """Unknowns a joint."""
        return len(self.own) + len(self.relations) + len(self.positive)


def coriolis_bound(hinges: Sequence[Hinge]) -> Fraction | None:
    """An upper bound of k_c; ``None`` where none was certified, and for fewer than three joints.

    Soundness: as for the other storage forms; the condition of the first two joints by bounds over intervals
        of one angle.
    """
    if len(hinges) < 3:
        return None
    basis = Basis(lift.invariant_forms(), lift.relations(), lift.positive_products())
    known: list[tuple[float, Exact]] = []
    half = PI_ABOVE / _SECTORS
    result = [_sector(hinges, basis, ((2 * k + 1) * half, half), known) for k in range(_SECTORS)]
    return Fraction(max(result)) if isfinite(max(result)) else None


def _sector(
    hinges: Sequence[Hinge], basis: Basis, sector: tuple[float, float], known: list[tuple[float, Exact]]
) -> float:
    """A κ that holds for q_2 in the sector (middle, half width); infinite where none was found.

    Args:
        hinges: base first.
        basis: of the forms.
        sector: rad.
        known: κ and what the second joint stores of what held for other sectors, to which more is added. Of
            an arm whose second axis is across the first one, opposite sectors are alike.
    """
    for kappa, stored in known:
        if first_joints.certain(hinges, fmpq_of(kappa), stored, *sector):
            return kappa
    unknowns = 1 + (len(hinges) - 2) * basis.each + _ANGLES
    x = solve(_blocks(hinges, basis, sector), unknowns, _TOLERANCE)
    after = None if x is None else _stored(hinges, basis, x)
    if x is None or after is None or not first_joints.certain(hinges, fmpq_of(float(x[0])), after, *sector):
        return inf
    known.append((float(x[0]), after))
    return float(x[0])


def _blocks(hinges: Sequence[Hinge], basis: Basis, sector: tuple[float, float]) -> Blocks:
    """κ first, then for each joint from the third on its forms; then ν for some angles of the sector."""
    blocks, n = Blocks(), len(hinges)
    least = _MARGIN * max(float(np.abs(rounded(h.body)).max()) for h in hinges)
    step = rounded(lift.step())
    carries = [rounded(lift.carried(hinge.carry)) for hinge in hinges]
    costs = [rounded(lift.power(hinge.body)) for hinge in hinges]
    base = rounded(first_joints.first_cost(hinges))
    # angles a little beyond the sector, and none at which sines vanish: that is hard on the solver
    for t, angle in enumerate(sector[0] + sector[1] * np.linspace(-1.01, 1.02, _ANGLES)):
        reached = rounded(first_joints.states(hinges, fmpq_of(np.sin(angle)), fmpq_of(np.cos(angle))))
        slopes = {0: first_joints.PRICE, 1 + (n - 2) * basis.each + t: first_joints.RELATION}
        moved = carries[2] @ reached
        slopes |= {1 + i: -(moved.T @ form @ moved) for i, form in enumerate(basis.own)}
        blocks.add(-base - reached.T @ costs[1] @ reached - _HEAD * least * np.eye(first_joints.SIZE), slopes)
    for k in range(2, n):
        slopes = {0: np.zeros((lift.ROWS, lift.ROWS))}
        slopes[0][lift.RATE, lift.RATE] = 1.0
        first = 1 + (k - 2) * basis.each
        for i, form in enumerate(basis.own):
            slopes[first + i] = np.pad(form, (0, lift.INPUT))
        rest = [*basis.relations, *(-form for form in basis.positive.values())]
        slopes |= {first + len(basis.own) + i: form for i, form in enumerate(rest)}
        if k == n - 1:
            slopes[0] += np.outer(step[lift.N], step[lift.N])
        else:
            moved = carries[k + 1] @ step
            slopes |= {first + basis.each + i: -(moved.T @ form @ moved) for i, form in enumerate(basis.own)}
        blocks.add(-step.T @ costs[k] @ step - least * np.eye(lift.ROWS), slopes)
        offset = first + len(basis.own) + len(basis.relations)
        blocks.add(-least * np.eye(7), {offset + i: _unit(place) for i, place in enumerate(basis.positive)})
    return blocks


def _unit(place: tuple[int, int]) -> Array:
    """The entry of the matrix that multiplies N (V, x)(V, x)ᵀ, half on either side of the diagonal."""
    result = np.zeros((7, 7))
    result[place] += 0.5
    result[place[::-1]] += 0.5
    return result


def _stored(hinges: Sequence[Hinge], basis: Basis, x: Array) -> Exact | None:
    """The cost of the second joint and what follows it, if the forms hold from the third on; exactly."""
    n, kappa = len(hinges), fmpq_of(float(x[0]))
    parts = x[1 : 1 + (n - 2) * basis.each].reshape(n - 2, basis.each)
    one, two = len(basis.own), len(basis.own) + len(basis.relations)
    forms = [_sum(row[:one], basis.own) for row in parts]
    step = lift.step()
    for k in range(2, n):
        row = parts[k - 2]
        if not _definite(_sum(row[two:], [_unit(place) for place in basis.positive])):
            return None
        slack = _sum(row[one:two], basis.relations) - _sum(row[two:], list(basis.positive.values()))
        slack[: lift.STATE, : lift.STATE] += forms[k - 2]
        slack[lift.RATE, lift.RATE] += kappa
        after = lift.power(hinges[k].body)
        if k == n - 1:
            after[lift.N, lift.N] -= kappa
        else:
            carry = lift.carried(hinges[k + 1].carry)
            after = after + carry.T @ forms[k - 1] @ carry
        if not _definite(slack - step.T @ after @ step):
            return None
    carry = lift.carried(hinges[2].carry)
    return np.asarray(lift.power(hinges[1].body) + carry.T @ forms[0] @ carry)


def _sum(coefficients: Array, forms: Sequence[Array]) -> Exact:
    """Σ c_i form_i, exactly."""
    total = zeros(len(forms[0]), len(forms[0]))
    for coefficient, form in zip(coefficients, forms, strict=True):
        for i, j in np.argwhere(form):
            total[i, j] += fmpq_of(float(coefficient)) * fmpq_of(float(form[i, j]))
    return total


def fmpq_of(value: float) -> fmpq:
    """A double, exactly."""
    numerator, denominator = float(value).as_integer_ratio()
    return fmpq(numerator, denominator)


def _definite(matrix: Exact) -> bool:
    previous = ctx.prec
    ctx.prec = _BITS
    try:
        return BALLS.positive_definite([[arb(x) for x in row] for row in matrix])
    finally:
        ctx.prec = previous
