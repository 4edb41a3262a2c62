"""The paper's conditions on gains, decided exactly: (10), its rule for each joint (10p), and (19).

With N = √n γ the three read

    (10)   λmax(K_p) + λmax(K_v) ≤ (‖τmax‖ − k_g) / N
    (10p)  k_pi + k_vi < (τmax_i − k_gi) / N          for each joint i
    (19)   k_vi < λmin(B) / N                         for each joint i, which is λmax(K_v) < λmin(B)/N

(10p) and (19) compare a rational with a positive number over √n γ; both sides squared, that is the question
whether γ² is below a rational, which is decided exactly. (10) holds more square roots: see ``norms``.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from math import floor, isqrt

from flint import arb

from lyapcheck.check.balls import precision, to_arb
from lyapcheck.check.enclosure import Enclosure
from lyapcheck.control.bound import GammaBound
from lyapcheck.control.gains import GainSet
from lyapcheck.control.limits import Limits
from lyapcheck.control.norms import NormLimit
from lyapcheck.files.decimals import places_of

CONDITIONS = ("10", "10p", "19")
ACCEPTED, REJECTED, UNDECIDED = "accepted", "rejected", "undecided"


@dataclass(frozen=True)
class Check:
    """One condition on one joint (or, for (10), on all): its value, its limit and what would still pass.

    Args:
        id: ``10``, ``10p`` or ``19``.
        joint: counted from 0; ``None`` where the condition is on all joints.
        verdict: ``accepted``, ``rejected`` or ``undecided``.
        value: what is compared, N·m (N·m·s/rad for 19), exact.
        limit: what it must stay below; ``None`` where there is none (an unbounded function, no torque limit).
        largest_admissible: the largest decimal of ``places`` places that passes; ``None`` where no positive
            value does.
        reason: one sentence where ``limit`` is ``None`` or nothing was decided.
        places: decimal places that the user wrote, or more where only smaller values pass.
    """

    id: str
    joint: int | None
    verdict: str
    value: Fraction
    limit: Enclosure | None
    largest_admissible: Fraction | None
    reason: str = ""
    places: int = 0

    @property
    def margin(self) -> Fraction | None:
        """limit − value, from below; negative where the condition is broken."""
        return None if self.limit is None else self.limit.lower - self.value


def check_10p(gains: GainSet, limits: Limits, gamma: GammaBound) -> list[Check]:
    """k_pi + k_vi < (τmax_i − k_gi)/(√n γ) for each joint.

    References: the tuning rule of Section 4, reyes2019family.
    """
    checks = []
    for i, (kp, kv) in enumerate(zip(gains.kp, gains.kv, strict=True)):
        torque = limits.torque[i]
        if torque is None:
            checks.append(Check("10p", i, UNDECIDED, kp + kv, None, None, _NO_TORQUE))
        else:
            places = max(places_of(kp), places_of(kv))
            checks.append(_scaled("10p", i, kp + kv, torque - limits.gravity[i], limits.n, gamma, places))
    return checks


def check_19(gains: GainSet, limits: Limits, gamma: GammaBound) -> list[Check]:
    """k_vi < λmin(B)/(√n γ) for each joint.

    References: (19) of reyes2019family.
    """
    friction = limits.viscous_min
    if friction is None:
        return [Check("19", i, UNDECIDED, kv, None, None, _NO_FRICTION) for i, kv in enumerate(gains.kv)]
    return [_scaled("19", i, kv, friction, limits.n, gamma, places_of(kv)) for i, kv in enumerate(gains.kv)]


def check_10(gains: GainSet, limits: Limits, gamma: GammaBound) -> list[Check]:
    """λmax(K_p) + λmax(K_v) ≤ (‖τmax‖ − k_g)/(√n γ), with k_g = ‖(k_gi)‖.

    References: (10) of reyes2019family.
    """
    value = max(gains.kp) + max(gains.kv)
    torques = [torque for torque in limits.torque if torque is not None]
    if len(torques) < limits.n:
        return [Check("10", None, UNDECIDED, value, None, None, _NO_TORQUE)]
    if gamma.enclosure is None:
        return [Check("10", None, REJECTED, value, None, None, _UNBOUNDED)]

    bound = NormLimit.of(torques, limits.gravity, gamma)
    places = max(places_of(k) for k in (*gains.kp, *gains.kv))
    verdict = ACCEPTED if bound.admits(value) else REJECTED
    limit = _apart(value, bound.enclosure(_bits(places)), bound.enclosure, lambda: bound.equals(value))
    return [Check("10", None, verdict, value, limit, *_largest(bound.admits, limit, places))]


CHECKS: dict[str, Callable[[GainSet, Limits, GammaBound], list[Check]]] = {
    "10": check_10,
    "10p": check_10p,
    "19": check_19,
}

_UNBOUNDED = "the function is unbounded (γ = ∞): no gain keeps the torque within a limit for every state"
_NO_TORQUE = "the arm has no torque limit for this joint; give [bounds] torque"
_NO_FRICTION = "the arm has no viscous friction; give [bounds] viscous_min"


def _scaled(
    name: str, joint: int, value: Fraction, budget: Fraction, n: int, gamma: GammaBound, places: int
) -> Check:
    """value < budget / (√n γ), exactly."""
    if gamma.enclosure is None:
        return Check(name, joint, REJECTED, value, None, None, _UNBOUNDED)

    def enclosed(bits: int) -> Enclosure:
        return scaled_limit(budget, n, gamma.within(bits // 3), bits)

    near = enclosed(_bits(places))

    def passes(k: Fraction) -> bool:
        if near.lower <= k < near.upper:
            return below(k, budget, n, gamma)
        return k < near.lower

    verdict = ACCEPTED if passes(value) else REJECTED
    limit = _apart(value, near, enclosed, lambda: _is_scaled_limit(value, budget, n, gamma))
    return Check(name, joint, verdict, value, limit, *_largest(passes, limit, places))


def below(value: Fraction, budget: Fraction, n: int, gamma: GammaBound) -> bool:
    """Decide value < budget/(√n γ) for value > 0: γ² < budget²/(n value²), for a positive budget."""
    return budget > 0 and gamma.squared_less(budget**2 / (n * value**2))


def scaled_limit(budget: Fraction, n: int, gamma: Enclosure, bits: int = 160) -> Enclosure:
    """budget/(√n γ), enclosed; exactly where √n and γ are rational."""
    if gamma.width == 0 and isqrt(n) ** 2 == n:
        return Enclosure.exact(budget / (isqrt(n) * gamma.lower))
    with precision(bits):
        return Enclosure.from_arb(to_arb(budget) / (arb(n).sqrt() * gamma.to_arb()))


def largest_passing(passes: Callable[[Fraction], bool], limit: Enclosure, places: int) -> Fraction | None:
    """The largest decimal of so many places that passes; ``None`` if no positive one does.

    Args:
        passes: whether a positive value passes: true below the limit, false above it.
        limit: the limit, enclosed; a tight one saves steps.
        places: decimal places.
    """
    scale = 10**places
    low, high = max(0, floor(limit.lower * scale) - 1), floor(limit.upper * scale)
    while low < high:
        middle = (low + high + 1) // 2
        low, high = (middle, high) if passes(Fraction(middle, scale)) else (low, middle - 1)
    return Fraction(low, scale) if low > 0 else None


def _largest(
    passes: Callable[[Fraction], bool], limit: Enclosure, places: int
) -> tuple[Fraction | None, str, int]:
    """The largest value that passes, no reason, and its places: more than asked for where it takes more."""
    largest = largest_passing(passes, limit, places)
    if largest is None and limit.lower > 0:
        while limit.lower * 10**places < 10:
            places += 1
        largest = largest_passing(passes, limit, places)
    return largest, "", places


def _bits(places: int) -> int:
    """Bits that tell decimals of so many places apart."""
    return 160 + 4 * places


def _is_scaled_limit(value: Fraction, budget: Fraction, n: int, gamma: GammaBound) -> bool:
    """Decide value = budget/(√n γ) for value > 0: whether γ² is the root of n value² x = budget²."""
    return budget > 0 and gamma.squared_is_root(-(budget**2), n * value**2, Fraction(0))


def _apart(
    value: Fraction, limit: Enclosure, enclosed: Callable[[int], Enclosure], tied: Callable[[], bool]
) -> Enclosure:
    """A limit that is tight enough to be on one side of a value, or is that value exactly."""
    bits = 2 * _bits(0)
    while limit.lower <= value <= limit.upper:
        if tied():
            return Enclosure.exact(value)
        bits *= 2
        limit = enclosed(bits)
    return limit
