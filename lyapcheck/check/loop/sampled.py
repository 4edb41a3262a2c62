"""The loop that a computer runs, from one sample to the next, linearised at its goal, in balls.

Readings p_k = q(t_k) are taken every T seconds. The torque that is held from t_k on is

    τ = K_p h(q_d − p_{k−d}) − K_v h(v) + g(p_{k−d}),   v = Σ_j f_j (p_{k−d−j} − p_{k−d−j−1})/T.

Near q = q_d, w = 0, with x = (q, w, p_{k−1}, …, p_{k−d−J}), angles counted from q_d, and G = ∂g/∂q at q_d,

    M ẇ = −G q − B w + u,   u = (G − h'(0)K_p) p_{k−d} − h'(0)K_v v,   x_{k+1} = Φ x_k:

C(q, w)w is quadratic in w, and what M changes by is a factor of a ẇ that vanishes at the goal.

References: ``reyes2019family`` (1), (6).
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from flint import arb, arb_mat

from lyapcheck.check.loop.arithmetic import BALLS
from lyapcheck.check.numbers.balls import to_arb

Rows = Sequence[Sequence[arb]]


def transition(
    mass: Rows,
    slope: Rows,
    viscous: Sequence[Fraction],
    stiffness: Sequence[arb],
    damping: Sequence[arb],
    period: Fraction,
    delay: int,
    taps: Sequence[Fraction],
) -> arb_mat:
    """A matrix of balls that contains Φ.

    Args:
        mass: M(q_d), kg·m².
        slope: G, N·m/rad.
        viscous: diagonal of B, N·m·s/rad.
        stiffness: diagonal of h'(0)K_p, N·m/rad.
        damping: diagonal of h'(0)K_v, N·m·s/rad.
        period: T, s.
        delay: d, samples from a reading to its torque.
        taps: f_0, f_1, … of the velocity filter.

    Raises:
        ZeroDivisionError: M may be singular.

    Soundness: under a held u, (q, w) at the end of a period is linear in (q, w, u) at its begin, by the
        exponential of [[0, I, 0], [−M⁻¹G, −M⁻¹B, M⁻¹], [0, 0, 0]] T; flint encloses it.
    """
    n, joints, T = len(viscous), range(len(viscous)), to_arb(period)
    unit = [[arb(int(i == k)) for k in joints] for i in joints]
    right = [[-x for x in slope[i]] + [-to_arb(viscous[i]) * x for x in unit[i]] + unit[i] for i in joints]
    moves = arb_mat(mass).solve(arb_mat(right)).tolist()
    still = [[arb(0)] * (2 * n) for _ in joints]
    rates = [still[i][:n] + unit[i] + still[i][:n] for i in joints] + moves + [[arb(0)] * (3 * n)] * n
    step = (arb_mat(rates) * T).exp().tolist()[: 2 * n]
    free, held = arb_mat([row[: 2 * n] for row in step]), arb_mat([row[2 * n :] for row in step])
    weights = [[[arb(0)] * n for _ in joints] for _ in range(delay + len(taps) + 1)]
    for i in joints:
        weights[delay][i] = [g - stiffness[i] * one for g, one in zip(slope[i], unit[i], strict=True)]
    for j, tap in enumerate(taps, start=delay):
        for i in joints:
            share = to_arb(tap) * damping[i] / T
            weights[j][i][i] -= share
            weights[j + 1][i][i] += share
    on = [(held * arb_mat(weight)).tolist() for weight in weights]
    size = n * (1 + len(weights))
    moved = [
        [x + on[0][i][k] if k < n else x for k, x in enumerate(row)] + [x for part in on[1:] for x in part[i]]
        for i, row in enumerate(free.tolist())
    ]
    kept = [*joints, *range(2 * n, size - n)]
    return arb_mat(moved + [[arb(int(k == place)) for k in range(size)] for place in kept])


def grows(step: arb_mat, form: arb_mat, growth: Fraction) -> bool:
    """Whether μ²S − ΦᵀSΦ is positive definite for all Φ in a matrix of balls; ``False`` says nothing."""
    gap = (form * to_arb(growth**2) - step.transpose() * form * step).tolist()
    return BALLS.positive_definite([row[: i + 1] for i, row in enumerate(gap)])
