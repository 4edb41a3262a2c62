"""The largest gains of each joint: their range, exactly, the convex program that proposes, and rounding.

The program is a second-order cone program in √k_p and k_v.

    maximise    Σ s_i / √P_i                           s_i = √k_pi, P_i the limit of (10p)
    subject to  s_i² + k_vi ≤ P_i                      (10p)
                f_i ≤ k_vi ≤ V                         the targets, and (19)
                2 ζ_i √(J_i L) s_i ≤ b_i + L k_vi      the damping ratio, where one is asked for

The joints are coupled by nothing, but one program serves all. Its answer is a proposal in floating point, of
which exact decimals are made.

The damping ratio is that of one joint, with h replaced by its steepest secant. A joint that moves alone obeys
J ë + b ė + k_v h(ė) + k_p h(e) = 0. Both h(x) are at most L x in size; with L x in their place the joint is a
linear oscillator with

    ζ = (b + L k_v) / (2 √(J L k_p)).

For m = 1 it is the linearisation at the goal (L = h'(0) = 1). For m >= 2 it describes a motion as large as
the one at which h(x)/x is largest; closer to the goal the spring goes soft.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import floor, isqrt, prod, sqrt

from lyapcheck.answers.tune.targets import ONE, Targets
from lyapcheck.check.numbers.balls import hyperbolic_constants
from lyapcheck.check.numbers.harmonics import by_parameters, largest
from lyapcheck.check.numbers.polynomials import Enclosure
from lyapcheck.control.limits import Limits
from lyapcheck.control.threshold import scaled
from lyapcheck.convex import Ended, solved
from lyapcheck.family.base import named
from lyapcheck.files.decimals import decimal_text, round_down
from lyapcheck.robots import RobotModel
from lyapcheck.robots.trig import to_terms

DIGITS = 30


@dataclass(frozen=True)
class Damping:
    """What the damping ratio of a joint depends on beside its gains.

    Args:
        ratio: the ζ that is asked for.
        friction: b, the least of the ranges, N·m·s/rad.
        inertia: J, an upper bound of M_ii over all angles and ranges, kg·m².
        slope: L_m from below and from above.
    """

    ratio: Fraction
    friction: Fraction
    inertia: Fraction
    slope: tuple[Fraction, Fraction]

    def largest_kp(self, kv: Fraction) -> Fraction:
        """The largest k_p that keeps ζ: (b + L k_v)²/(4 ζ² J L), from below.

        Soundness: L enters the square by its lower and the divisor by its upper end.
        """
        return self._square(kv) / self.ratio**2

    def reached(self, kp: Fraction, kv: Fraction) -> Fraction:
        """ζ of two gains, from below, to nine decimal places."""
        return Fraction(isqrt(int(self._square(kv) / kp * 10**18)), 10**9)

    def _square(self, kv: Fraction) -> Fraction:
        """k_p ζ² from below."""
        low, high = self.slope
        return (self.friction + low * kv) ** 2 / (4 * self.inertia * high)


def damping_of(
    model: RobotModel, m: int, ratios: tuple[Fraction, ...], viscous_min: Fraction | None = None
) -> tuple[Damping, ...]:
    """The least damping of every joint over the ranges of an arm.

    Args:
        model: the arm with its ranges.
        m: the member of the family.
        ratios: one ζ a joint.
        viscous_min: λmin(B) to judge by; it is the friction of each joint, unless it is the arm's own.

    Soundness: ζ falls with the inertia and grows with the friction, so that the ends of both give the least.
    """
    L = hyperbolic_constants(m, DIGITS).L
    inertias = [_largest_inertia(model, i) for i in range(model.n)]
    frictions = [number.bounds[0] for number in model.viscous]
    if viscous_min not in (None, min(frictions)):
        frictions = [viscous_min or Fraction(0)] * model.n
    return tuple(
        Damping(ratio, friction, inertia, (L.lower, L.upper))
        for ratio, friction, inertia in zip(ratios, frictions, inertias, strict=True)
    )


def _largest_inertia(model: RobotModel, i: int) -> Fraction:
    """An upper bound of M_ii over all angles and all values of the parameters, kg·m²."""
    sizes = [max(map(abs, number.bounds)) for number in model.parameters.values()]
    parts = by_parameters(to_terms(model.mass[i][i]), model.n).items()
    rows = (largest(part) * prod(map(pow, sizes, powers), start=Fraction(1)) for powers, part in parts)
    return sum(rows, Fraction(0))


@dataclass(frozen=True)
class GainRange:
    """What one joint's gains must keep to; integers count units in the last decimal place.

    Args:
        unit: the size of one unit, N·m.
        sum_limit: (τmax − k_g)/(√n γ), which k_p + k_v stays below, N·m.
        kv_limit: λmin(B)/(√n γ), which k_v stays below, N·m.
        most_sum: the largest k_p + k_v that passes (10p).
        most_kv: the largest k_v that passes (19).
        least_kv: the smallest k_v that the targets allow.
        damping: the damping ratio that is asked for, ``None`` where none is.

    References: (10), (19) and the tuning rule of Section 4, reyes2019family.
    """

    unit: Fraction
    sum_limit: Enclosure
    kv_limit: Enclosure
    most_sum: int
    most_kv: int
    least_kv: int
    damping: Damping | None = None

    @property
    def kv_range(self) -> tuple[int, int]:
        """The k_v that leave room for a k_p of one unit; empty where the first exceeds the second."""
        return self.least_kv, min(self.most_kv, self.most_sum - 1)

    def damped_kp(self, kv: int) -> int | None:
        """The largest k_p that keeps the damping ratio; ``None`` where any does."""
        return None if self.damping is None else floor(self.damping.largest_kp(kv * self.unit) / self.unit)

    def most_kp(self, kv: int) -> int:
        """The largest k_p beside a k_v."""
        damped = self.damped_kp(kv)
        return self.most_sum - kv if damped is None else min(self.most_sum - kv, damped)


def gain_ranges(m: int, model: RobotModel, limits: Limits, targets: Targets) -> list[GainRange]:
    """The range of each joint of an arm whose torque limits and friction are known.

    Soundness: every largest decimal is proved to pass (10p) or (19) as the gate's checks are.
    """
    n, digits, gamma, friction = limits.n, targets.digits, named("hyperbolic", m).gamma, limits.viscous_min
    if friction is None or gamma is None:
        raise ValueError("a range needs a friction and a bounded function")
    asked: Sequence[Damping | None] = (None,) * n
    if targets.damping:
        asked = damping_of(limits.model or model, m, targets.damping, friction)
    dampings, result = scaled(friction, n, gamma), []
    for room, share, damping in zip(limits.room, targets.kv_share or ONE * n, asked, strict=True):
        if room is None:
            raise ValueError("a range needs a torque limit")
        torques, kept = scaled(room, n, gamma), scaled(share * friction, n, gamma)
        most = torques.most_units(digits), dampings.most_units(digits), max(kept.most_units(digits), 1)
        result.append(GainRange(targets.unit, torques.near(), dampings.near(), *most, damping))
    return result


def propose(gain_ranges: Sequence[GainRange]) -> tuple[str, list[tuple[float, float]]]:
    """Clarabel's word, and k_p and k_v of each joint, N·m; only ``optimal`` has them."""
    import cvxpy as cp
    import numpy as np

    torque = np.array([float(each.sum_limit.mid) for each in gain_ranges])
    low, high = np.array([[float(kv * each.unit) for kv in each.kv_range] for each in gain_ranges]).T
    root, kv = cp.Variable(len(gain_ranges), nonneg=True), cp.Variable(len(gain_ranges), nonneg=True)
    # each joint in units of its own limit: gains of 10⁻² and 10³ N·m stand side by side
    constraints = [cp.square(root) + kv <= 1, kv >= low / torque, kv <= high / torque]
    for i, damping in enumerate(each.damping for each in gain_ranges):
        if damping is not None:
            numbers = damping.ratio, damping.friction, damping.inertia, damping.slope[0]
            ratio, friction, inertia, slope = map(float, numbers)
            stiff = 2 * ratio * sqrt(inertia * slope * torque[i])
            constraints.append(root[i] <= (friction + slope * torque[i] * kv[i]) / stiff)
    solution = solved(cp.sum(root), constraints, [root, kv])
    if solution.ended is not Ended.SOLVED:
        return solution.reason, []
    rows = zip(*solution.values, torque, strict=True)
    return "optimal", [(float(s * s * most), float(v * most)) for s, v, most in rows]


def best_units(gain_range: GainRange, proposal: float | None = None) -> tuple[int, int]:
    """The largest k_p, and beside it the largest k_v, in units of the last digit.

    As k_v grows, the k_p that the damping ratio allows does not fall, and the one that (10p) allows does: the
    best is at the first k_v where the former is at least the latter, or just before.

    Args:
        gain_range: what the joint must keep to; its ``kv_range`` is not empty.
        proposal: k_v of the convex program, N·m, where the search begins.

    Soundness: the answer does not depend on the proposal, which only says where to look first.
    """

    def undamped(kv: int) -> bool:
        """Whether (10p) limits k_p, and not the damping ratio."""
        damped = gain_range.damped_kp(kv)
        return damped is None or damped >= gain_range.most_sum - kv

    low, last = gain_range.kv_range
    start, end = low, last + 1
    guess = low if proposal is None else max(low, min(last, int(proposal / float(gain_range.unit))))
    for step in (guess - 1, guess, guess + 1):
        if start <= step < end:
            start, end = (start, step) if undamped(step) else (step + 1, end)
    first = bisect_left(range(end), True, start, end, key=undamped)
    kp = max(gain_range.most_kp(kv) for kv in (first - 1, first) if low <= kv <= last)
    return kp, min(gain_range.most_kv, gain_range.most_sum - kp)


def binding(gain_range: GainRange, kp: int, kv: int) -> tuple[str, str]:
    """What forbids one unit more of k_p, and of k_v: ``10p``, ``19`` or ``damping``.

    Raises:
        ArithmeticError: nothing does, so the gains are not the largest.
    """
    damped = gain_range.damped_kp(kv)
    full = kp + kv + 1 > gain_range.most_sum
    for_kp = "10p" if full else "damping" if damped is not None and kp + 1 > damped else ""
    for_kv = "19" if kv + 1 > gain_range.most_kv else "10p" if full else ""
    if not (for_kp and for_kv):
        raise ArithmeticError(f"{kp} and {kv} units are not the largest gains")
    return for_kp, for_kv


def obstacle(gain_range: GainRange, joint: int, limits: Limits, targets: Targets) -> str:
    """Why a joint with positive limits still has no gains; empty where it has."""
    name, unit = limits.joints[joint], gain_range.unit
    if min(gain_range.most_kv, gain_range.most_sum - 1) < 1:
        return f"{name}: {targets.digits} decimal places are too few for gains this small; raise --digits"
    if gain_range.least_kv >= gain_range.most_sum:
        torque, friction, less = limits.torque[joint], limits.viscous_min, "lower --kv-share"
        if torque is not None and friction is not None:
            share = round_down((torque - limits.gravity[joint]) / friction, 2)
            less += f" below {decimal_text(share)}" if share > 0 else ""
        return (
            f"{name}: k_v ≥ {decimal_text(gain_range.least_kv * unit)} leaves no room for k_p, "
            f"as (10p) admits k_p + k_v ≤ {decimal_text(gain_range.most_sum * unit)}; "
            f"{less}"
        )
    if gain_range.most_kp(gain_range.kv_range[1]) < 1:
        return (
            f"{name}: the damping ratio needs k_p below one unit of the last digit; lower --damping or "
            "raise --digits"
        )
    return ""
