"""The range that an arm's limits leave to the gains of one joint, exactly, in units of the last digit."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import ceil, floor

from lyapcheck.answers.tune.damping import Damping
from lyapcheck.answers.tune.targets import Targets
from lyapcheck.check.expressions.expression import Tree
from lyapcheck.check.numbers.enclosure import Enclosure
from lyapcheck.control.limits import Limits
from lyapcheck.control.threshold import Threshold, scaled


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


def gain_range_of(
    joint: int, limits: Limits, gamma: Tree | None, targets: Targets, damping: Damping | None = None
) -> GainRange:
    """The range of a joint, counted from 0, on an arm whose torque limits and friction are known.

    Soundness: every largest decimal is proved to pass (10p) or (19) as the gate's checks are.
    """
    torque, friction = limits.torque[joint], limits.viscous_min
    if torque is None or friction is None or gamma is None:
        raise ValueError("a range needs a torque limit, a friction and a bounded function")
    torques = scaled(torque - limits.gravity[joint], limits.n, gamma)
    dampings = scaled(friction, limits.n, gamma)
    kept = scaled(targets.share_of_kv(joint) * friction, limits.n, gamma).most_units(targets.digits)
    least = ceil(targets.kv_min[joint] / targets.unit) if targets.kv_min else 0
    return GainRange(
        unit=targets.unit,
        sum_limit=_enclosed(torques),
        kv_limit=_enclosed(dampings),
        most_sum=torques.most_units(targets.digits),
        most_kv=dampings.most_units(targets.digits),
        least_kv=max(kept, least, 1),
        damping=damping,
    )


def _enclosed(threshold: Threshold) -> Enclosure:
    near = threshold.near()
    return Enclosure(near.lower, near.upper)
