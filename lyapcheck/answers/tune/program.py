"""The convex program of tuning: a second-order cone program in √k_p and k_v.

    maximise    Σ s_i / √P_i                           s_i = √k_pi, P_i the limit of (10p)
    subject to  s_i² + k_vi ≤ P_i                      (10p)
                f_i ≤ k_vi ≤ V                         the targets, and (19)
                2 ζ_i √(J_i L) s_i ≤ b_i + L k_vi      the damping ratio, where one is asked for

The joints are coupled by nothing, but one program serves all. Its answer is a proposal in floating point;
``lyapcheck.answers.tune.rounding`` makes exact gains of it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import sqrt

from lyapcheck.answers.tune.gain_range import GainRange
from lyapcheck.convex import Ended, solved


@dataclass(frozen=True)
class GainProposal:
    """The optimum of the program for each joint, N·m; ``kv`` is empty where the solver gave none."""

    status: str
    kp: tuple[float, ...] = ()
    kv: tuple[float, ...] = ()


def propose(gain_ranges: Sequence[GainRange]) -> GainProposal:
    """Clarabel's answer; only ``optimal`` is one."""
    import cvxpy as cp

    torque = [float(gain_range.sum_limit.mid) for gain_range in gain_ranges]
    low = [float(gain_range.least_kv * gain_range.unit) for gain_range in gain_ranges]
    high = [
        float(min(gain_range.most_kv, gain_range.most_sum - 1) * gain_range.unit)
        for gain_range in gain_ranges
    ]
    root, kv = cp.Variable(len(gain_ranges), nonneg=True), cp.Variable(len(gain_ranges), nonneg=True)
    # each joint in units of its own limit: gains of 10⁻² and 10³ N·m stand side by side
    constraints = [cp.square(root) + kv <= 1]
    constraints += [kv >= _over(low, torque), kv <= _over(high, torque)]
    for i, gain_range in enumerate(gain_ranges):
        if gain_range.damping is not None:
            ratio, friction, inertia = (
                float(x)
                for x in (gain_range.damping.ratio, gain_range.damping.friction, gain_range.damping.inertia)
            )
            slope = float(gain_range.damping.slope[0])
            stiff = 2 * ratio * sqrt(inertia * slope * torque[i])
            damped = friction + slope * torque[i] * kv[i]
            constraints.append(root[i] <= damped / stiff)
    solution = solved(cp.sum(root), constraints, [root, kv])
    if solution.ended is not Ended.SOLVED:
        return GainProposal(solution.reason)
    pairs = [(float(s), float(v), t) for s, v, t in zip(*solution.values, torque, strict=True)]
    return GainProposal("optimal", tuple(s * s * t for s, _, t in pairs), tuple(v * t for _, v, t in pairs))


def _over(values: Sequence[float], scale: Sequence[float]) -> list[float]:
    return [value / unit for value, unit in zip(values, scale, strict=True)]
