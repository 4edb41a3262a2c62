"""The first joints of a chain at one posture: what they ask of a bound of ‖C(q, x)x‖, as a matrix.

With v the rates z_1, …, z_K and the products x_i x_j, i ≤ j, what ``motion`` asks of the first K joints is
vᵀHv ≥ 0,

    H = diag(κ, …, κ, 0) − (C_v + C_vᵀ) − RᵀFR + N,     Σ_k cost_k = 2 zᵀC_v (x_i x_j),

where R v are the entries of X_{K+1} (Z', A', V' V', N'), s_{K+1} is F of them, and N vanishes on products. N
may be another one at each posture: it is given at nodes, and so is a trigonometric polynomial as H is.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import combinations_with_replacement, product

from flint import arb, arb_mat, fmpq

from lyapcheck.check.loop.storage import TWIST, Hinge
from lyapcheck.check.numbers.polynomials import rational
from lyapcheck.check.numbers.vectors import LEVI_CIVITA
from lyapcheck.check.refusal import require

Split = tuple[tuple[int, int], tuple[int, int]]

PAIRS = list(combinations_with_replacement(range(TWIST), 2))
PARTS = 2 * TWIST + len(PAIRS) + 1
"""Entries of Z, A, the products of two of V, and N."""
DEGREE = 4
"""Of H in each angle, at most: the Christoffel symbols of each link are of degree 2, as its inertia matrix
is; Z, A and V are of degree 1, and F is of degree 4 in V."""
DEGREE_ALONE = 2
"""That where nothing is handed on: of the Christoffel symbols alone."""


@dataclass(frozen=True, eq=False)
class Head:
    """The first joints of a chain.

    Args:
        hinges: base first; one more than those, to whose frame the state is carried, if there is one.
        joints: K of them, two or more.
        kappa: κ.
        stored: F, (PARTS, PARTS).
    """

    hinges: Sequence[Hinge]
    joints: int
    kappa: Fraction
    stored: arb_mat

    @cached_property
    def products(self) -> list[tuple[int, int]]:
        """i ≤ j of the x_i x_j."""
        return list(combinations_with_replacement(range(self.joints), 2))

    @cached_property
    def _carries(self) -> list[arb_mat]:
        return [_balls(hinge.carry) for hinge in self.hinges]

    @cached_property
    def _bodies(self) -> list[arb_mat]:
        return [_balls(hinge.body) for hinge in self.hinges]

    def entries(self, angles: Sequence[fmpq], relation: arb_mat) -> list[arb]:
        """The entries of H on and below the diagonal, by rows, at q_2, …, q_K in units of π, with an N."""
        power, state = self.posture(angles)
        return assembled(power, relation - state.transpose() * self.stored * state, self.kappa)

    def posture(self, angles: Sequence[fmpq]) -> tuple[arb_mat, arb_mat]:
        """C_v, (K, products), and R, (PARTS, K + products)."""
        n, place = self.joints, {pair: i for i, pair in enumerate(self.products)}
        rates, speeds, rise = arb_mat(TWIST, n), arb_mat(TWIST, n), arb_mat(TWIST, len(place))
        power = arb_mat(n, len(place))
        for k in range(n):
            turn = _turn(angles[k - 1]) * self._carries[k] if k else self._carries[k]
            rates, speeds, rise = turn * rates, turn * speeds, turn * rise
            for a in range(n):
                column = place[min(a, k), max(a, k)]
                for i in (0, 3):
                    rise[i, column] += speeds[i + 1, a]
                    rise[i + 1, column] -= speeds[i, a]
            rates[2, k] += 1
            speeds[2, k] += 1
            momenta, force = self._bodies[k] * speeds, self._bodies[k] * rise
            for a in range(n):
                torques = _crossed(speeds, a) * momenta
                for b, i in product(range(n), range(TWIST)):
                    force[i, place[min(a, b), max(a, b)]] += torques[i, b]
            power += rates.transpose() * force
        if len(self.hinges) > n:
            carry = self._carries[n]
            rates, speeds, rise = carry * rates, carry * speeds, carry * rise
        return power, self._state(rates, rise, speeds)

    def _state(self, rates: arb_mat, rise: arb_mat, speeds: arb_mat) -> arb_mat:
        """The entries of Z, A, the products of two of V, and N, of v."""
        n = self.joints
        state = arb_mat(PARTS, n + len(self.products))
        for i, a in product(range(TWIST), range(n)):
            state[i, a] = rates[i, a]
        for column, (a, b) in enumerate(self.products):
            for i in range(TWIST):
                state[TWIST + i, n + column] = rise[i, column]
            for row, (i, j) in enumerate(PAIRS, 2 * TWIST):
                other = speeds[i, b] * speeds[j, a] if a != b else 0
                state[row, n + column] = speeds[i, a] * speeds[j, b] + other
            state[PARTS - 1, n + column] = int(a == b)
        return state


def assembled(power: arb_mat, form: arb_mat, kappa: Fraction) -> list[arb]:
    """The entries on and below the diagonal, by rows, of diag(κ, …, κ, 0) − (C_v + C_vᵀ) and a form."""
    n, price, result = power.nrows(), _ball(kappa), []
    for row in range(form.nrows()):
        for column in range(row + 1):
            entry = form[row, column]
            if column < n <= row:
                entry -= power[column, row - n]
            result.append(entry + price if row == column < n else entry)
    return result


def splits(joints: int) -> list[tuple[Split, Split]]:
    """The ways to part four speeds x_a x_b x_c x_d into two products, each beside the first way."""
    result = []
    for a, b, c, d in combinations_with_replacement(range(joints), 4):
        first, *others = dict.fromkeys(
            (min(way), max(way)) for way in (((a, b), (c, d)), ((a, c), (b, d)), ((a, d), (b, c)))
        )
        result += [(first, other) for other in others]
    return result


def relation(coefficients: Sequence[Fraction], joints: int) -> arb_mat:
    """N, which vanishes on products: the sum of coefficients times one way to part four speeds less another.

    Raises:
        Refused: there are not as many coefficients as `splits`.
    """
    ways, products = splits(joints), list(combinations_with_replacement(range(joints), 2))
    require(len(coefficients) == len(ways), "relations", len(coefficients), f"must be {len(ways)} numbers")
    place = {pair: joints + i for i, pair in enumerate(products)}
    result = arb_mat(joints + len(products), joints + len(products))
    for coefficient, (first, other) in zip(coefficients, ways, strict=True):
        for (left, right), sign in ((first, -1), (other, 1)):
            for i, j in ((place[left], place[right]), (place[right], place[left])):
                result[i, j] += sign * _ball(coefficient) / 2
    return result


def stored_form(terms: Mapping[tuple[int, ...], fmpq]) -> arb_mat:
    """F of a form of the state, which is quadratic in the entries of Z, A, the products of two of V, and N.

    Args:
        terms: the coefficients of s by the powers of Z, A, V and N.

    Raises:
        Refused: s is no such form.
    """
    result = arb_mat(PARTS, PARTS)
    place = {pair: 2 * TWIST + i for i, pair in enumerate(PAIRS)}
    for powers, coefficient in terms.items():
        entries = [i for i, power in enumerate(powers) for _ in range(power)]
        speeds = [i - 2 * TWIST for i in entries if 2 * TWIST <= i < 3 * TWIST]
        parts = [i for i in entries if i < 2 * TWIST] + [PARTS - 1 for i in entries if i == 3 * TWIST]
        parts += [place[pair] for pair in zip(speeds[::2], speeds[1::2], strict=False)]
        require(len(speeds) % 2 == 0 and len(parts) == 2, "forms", "", "must hand on a form of the motion")
        i, j = parts
        result[i, j] += arb(coefficient) / 2
        result[j, i] += arb(coefficient) / 2
    return result


def _crossed(speeds: arb_mat, column: int) -> arb_mat:
    """The matrix of V ×* ·, which takes (h, p) to (ω × h + v × p, ω × p), of one V = (ω, v)."""
    result = arb_mat(TWIST, TWIST)
    for k, (row, start) in enumerate(((0, 0), (3, 3), (0, 3))):
        part = 0 if k < 2 else 3
        for axis, (i, j) in enumerate(LEVI_CIVITA):
            result[row + j, start + i] = speeds[part + axis, column]
            result[row + i, start + j] = -speeds[part + axis, column]
    return result


def _turn(angle: fmpq) -> arb_mat:
    """From the frame of the joint at 0 to that at an angle in units of π."""
    sine, cosine = arb(angle).sin_pi(), arb(angle).cos_pi()
    result = arb_mat(TWIST, TWIST)
    for i in (0, 3):
        result[i, i] = result[i + 1, i + 1] = cosine
        result[i, i + 1], result[i + 1, i], result[i + 2, i + 2] = sine, -sine, arb(1)
    return result


def _balls(rows: Sequence[Sequence[Fraction]]) -> arb_mat:
    return arb_mat([[_ball(x) for x in row] for row in rows])


def _ball(value: Fraction) -> arb:
    return arb(rational(value))
