"""Against a sampling period: one goal of the arm, beside which motions from rest grow sample by sample.

Readings p_k = q(t_k) are taken every T seconds. The torque that is held from t_k on is

    τ = K_p h(q_d − p_{k−d}) − K_v h(v) + g(p_{k−d}),   v = Σ_j f_j (p_{k−d−j} − p_{k−d−j−1})/T.

Near q = q_d, w = 0, with x = (q, w, p_{k−1}, …, p_{k−d−J}), angles counted from q_d, and G = ∂g/∂q at q_d,

    M ẇ = −G q − B w + u,   u = (G − h'(0)K_p) p_{k−d} − h'(0)K_v v,   x_{k+1} = Φ x_k:

C(q, w)w is quadratic in w, and what M changes by is a factor of a ẇ that vanishes at the goal.

References: ``reyes2019family`` (1), (6); Chetaev's theorem, here in steps: ``khalil2002nonlinear`` 4.3.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from flint import arb, arb_mat

from lyapcheck.check.kinds.chain import ChainAbove
from lyapcheck.check.kinds.inertia import MassAbove, PostureWitness, require_posture
from lyapcheck.check.kinds.sampled import GOAL, SampledStable
from lyapcheck.check.kinds.stable_arm import hessian
from lyapcheck.check.loop.chain import turning
from lyapcheck.check.loop.field import BALLS, value_at
from lyapcheck.check.numbers.balls import precision, to_arb
from lyapcheck.check.numbers.harmonics import by_parameters
from lyapcheck.check.numbers.members import member
from lyapcheck.check.numbers.vectors import transposed
from lyapcheck.check.refusal import require
from lyapcheck.check.statement import Monomials, Proof
from lyapcheck.check.verify import Accepted, require_proved, rule

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


BITS = 256
MOST_STATES = 200


@dataclass(frozen=True)
class GrowingMotion(Proof):
    """At intervals of exactly ``period``, s, motions near one goal grow by ``growth`` a sample, or faster.

    Args:
        period: T, at most that of the statement.
        goal: q_d, in degrees.
        parameters: those of the arm, in their ranges.
        growth: μ > 1.
        form: S on and below the diagonal, for x as above.
        start: q − q_d, rad, and w, rad/s, up to a factor; all earlier readings were of this q.
        inertia: that M(q) of this arm is positive definite at all postures.
    """

    rule = "growing motion"
    period: Fraction
    goal: tuple[Fraction, ...]
    parameters: tuple[Fraction, ...]
    growth: Fraction
    form: tuple[tuple[Fraction, ...], ...]
    start: tuple[Fraction, ...]
    inertia: Proof


@rule(SampledStable, GrowingMotion)
def by_growing_motion(statement: SampledStable, proof: GrowingMotion) -> Accepted:
    """Soundness: one loop of the statement has a goal that is not stable.

    It is the one with b_i = ``viscous_min``, the parameters of the proof, and all intervals T. Near its fixed
    point x = 0 the motion from a sample to the next is a C¹ map f with f'(0) = Φ: M, C and g are analytic, h
    is C¹, M ≻ 0. With V = xᵀSx, μ²S − ΦᵀSΦ ≻ 0 gives an r with V(f(x)) ≤ μ²V(x) for |x| ≤ r. The proof has
    a v with V(v) < 0. From x_0 = s v it is V(x_k) ≤ μ²ᵏ s² V(v) as long as all |x_k| ≤ r, where V is bounded:
    however small s > 0, the motion leaves that ball. So the goal is not stable. No other eigenvalue of Φ
    matters, nor does h beyond h'(0); where that is 0, as for m ≥ 2, late gravity alone must make it grow.
    """
    n, T = statement.n, proof.period
    require(statement.conclusion == GOAL, "conclusion", statement.conclusion, "is nothing about a goal")
    require(not statement.k_g, "arm", "", "must be given by links or by M")
    require(0 < T <= statement.period, "period", T, "must be positive, and not above that of the statement")
    require(proof.growth > 1, "growth", proof.growth, "must be above 1")
    size = n * (2 + statement.delay + len(statement.taps))
    require(size <= MOST_STATES, "states", size, f"must not exceed {MOST_STATES}")
    lengths = [len(row) for row in proof.form]
    require(lengths == [*range(1, size + 1)], "form", len(lengths), f"must be the lower half of {size} rows")
    require(len(proof.start) == 2 * n, "start", len(proof.start), f"must be {2 * n} entries, q and w")
    with precision(BITS):
        mass, slope = _arm_at(statement, proof)
        steep = member(statement.family, statement.m).dh(arb(0))
        stiffness, damping = ([steep * to_arb(k) for k in gains] for gains in (statement.kp, statement.kv))
        step = transition(
            mass, slope, statement.viscous_min, stiffness, damping, T, statement.delay, statement.taps
        )
        form = arb_mat([[to_arb(proof.form[max(i, k)][min(i, k)]) for k in range(size)] for i in range(size)])
        state = [*proof.start, *proof.start[:n] * (size // n - 2)]
        v = arb_mat([[to_arb(x)] for x in state])
        require((v.transpose() * form * v)[0, 0] < 0, "start", "", "is not shown to have vᵀSv < 0")
        gap = (form * to_arb(proof.growth**2) - step.transpose() * form * step).tolist()
        grows = BALLS.positive_definite([row[: i + 1] for i, row in enumerate(gap)])
        require(grows, "form", "", "does not show μ²S − ΦᵀSΦ ≻ 0")
    return Accepted("refuted", "enclosure")


def _arm_at(statement: SampledStable, proof: GrowingMotion) -> tuple[Rows, Rows]:
    """M and ∂g/∂q in balls at the goal; refused unless the arm is one of the statement."""
    n, unit = statement.n, arb.pi() / 180
    require_posture(PostureWitness(proof.goal, proof.parameters, ()), n, statement.parameters)
    if not statement.links:

        def ball(entry: Monomials) -> arb:
            return value_at(by_parameters(entry, n), proof.goal, proof.parameters, unit)

        fixed = tuple((x, x) for x in proof.parameters)
        require_proved(MassAbove(statement.mass, fixed, Fraction(0)), proof.inertia, "M(q)")
        slopes = [ball(entry) for entry in hessian(statement.potential, n)]
        return [[ball(entry) for entry in row] for row in statement.mass], [
            slopes[i * n : (i + 1) * n] for i in range(n)
        ]
    require_proved(ChainAbove(statement.links, Fraction(0)), proof.inertia, "M(q)")
    angles = [to_arb(x) * unit for x in proof.goal]
    turned = [turning(statement.links, angles, k) for k in range(n)]
    columns = [[torque[1] for torque in posture.torques(statement.fall)] for posture in turned]
    return [[entry[0] for entry in row] for row in turned[0].mass()], transposed(columns)
