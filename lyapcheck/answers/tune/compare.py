"""Tuned gains beside others: what the others left on the table, and what they break."""

from __future__ import annotations

from fractions import Fraction
from math import floor

from lyapcheck.answers.tune.results import ComparedJoint, GainComparison, TunedSet
from lyapcheck.control.conditions import REJECTED, check_10p, check_19, gamma_of
from lyapcheck.control.gains import GainFile, GainSet
from lyapcheck.control.limits import Limits


def compare(tuned: TunedSet, limits: Limits, against: GainFile | None) -> GainComparison | None:
    """The gains of the same member in another file, judged by the same limits; ``None`` where it has none."""
    if against is None or tuned.gains is None:
        return None
    for item in against.gains:
        if item.m == tuned.m and item.family == "hyperbolic" and item.n == limits.n:
            return GainComparison(item.name, against.path, _joints(tuned, item, limits))
    return None


def _joints(tuned: TunedSet, other: GainSet, limits: Limits) -> tuple[ComparedJoint, ...]:
    gamma = gamma_of(other)
    torques, dampings = check_10p(other, limits, gamma), check_19(other, limits, gamma)
    result = []
    for i, joint in enumerate(tuned.joints):
        kp, kv = other.kp[i], other.kv[i]
        broken = tuple(check.id for check in (torques[i], dampings[i]) if check.verdict == REJECTED)
        left = joint.kp - kp
        shares = _millionths(left / joint.kp), _millionths((kp + kv) / joint.sum_limit.upper)
        result.append(ComparedJoint(joint.name, kp, kv, left, *shares, broken))
    return tuple(result)


def _millionths(share: Fraction) -> Fraction:
    """A share to six decimal places, from below."""
    return Fraction(floor(share * 10**6), 10**6)
