"""Against a sampling period: one goal of the arm, beside which motions from rest grow sample by sample.

References: ``reyes2019family`` (1), (6); Chetaev's theorem, here in steps: ``khalil2002nonlinear`` 4.3.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import prod
from typing import Any

from flint import arb, arb_mat

from lyapcheck.check.kinds.chain import ChainAbove
from lyapcheck.check.kinds.inertia import MassAbove, PostureWitness, require_posture
from lyapcheck.check.kinds.sampled import GOAL, SampledStable
from lyapcheck.check.kinds.stable_arm import hessian
from lyapcheck.check.loop.chain import Posture
from lyapcheck.check.loop.sampled import Rows, grows, transition
from lyapcheck.check.numbers.balls import precision, to_arb
from lyapcheck.check.numbers.members import member
from lyapcheck.check.numbers.vectors import Algebra
from lyapcheck.check.refusal import require
from lyapcheck.check.statement import Monomials, Proof
from lyapcheck.check.verify import Accepted, require_proved, rule

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
        form: S on and below the diagonal, for x of ``lyapcheck.check.loop.sampled``.
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
        require(grows(step, form, proof.growth), "form", "", "does not show μ²S − ΦᵀSΦ ≻ 0")
    return Accepted("refuted", "enclosure")


def _arm_at(statement: SampledStable, proof: GrowingMotion) -> tuple[Rows, Rows]:
    """M and ∂g/∂q in balls at the goal; refused unless the arm is one of the statement.

    Soundness: in each angle g is of the form a + b cos q_j + c sin q_j, so that its slope is half the
        difference of its values a quarter of a turn before and behind.
    """
    n, unit = statement.n, arb.pi() / 180
    angles, of = [to_arb(x) * unit for x in proof.goal], Algebra(to_arb)
    sines, cosines = [x.sin() for x in angles], [x.cos() for x in angles]
    require_posture(PostureWitness(proof.goal, proof.parameters, ()), n, statement.parameters)
    if not statement.links:
        point = [*sines, *cosines, *map(to_arb, proof.parameters)]

        def ball(entry: Monomials) -> arb:
            parts = (
                prod((point[k] for k, p in enumerate(powers) for _ in range(p)), start=to_arb(c))
                for powers, c in entry
            )
            return sum(parts, arb(0))

        fixed = tuple((x, x) for x in proof.parameters)
        require_proved(MassAbove(statement.mass, fixed, Fraction(0)), proof.inertia, "M(q)")
        slopes = [ball(entry) for entry in hessian(statement.potential, n)]
        return [[ball(entry) for entry in row] for row in statement.mass], [
            slopes[i * n : (i + 1) * n] for i in range(n)
        ]
    require_proved(ChainAbove(statement.links, Fraction(0)), proof.inertia, "M(q)")

    def torques(k: int, turn: int) -> list[Any]:
        """g with joint k a quarter of a turn further."""
        s, c = list(sines), list(cosines)
        s[k], c[k] = turn * cosines[k], -turn * sines[k]
        return Posture(statement.links, s, c, of).torques(statement.fall)

    pairs = [zip(torques(k, 1), torques(k, -1), strict=True) for k in range(n)]
    columns = [[of.value(a - b) / 2 for a, b in pair] for pair in pairs]
    mass_rows = Posture(statement.links, sines, cosines, of).mass()
    return mass_rows, [[columns[k][i] for k in range(n)] for i in range(n)]
