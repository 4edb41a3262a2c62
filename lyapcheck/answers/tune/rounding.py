"""From a proposal in floating point to the best exact decimals, and the proof that they are the best."""

from __future__ import annotations

from lyapcheck.answers.tune.gain_range import GainRange


def best_units(gain_range: GainRange, proposal: float | None = None) -> tuple[int, int]:
    """The largest k_p, and beside it the largest k_v, in units of the last digit.

    As k_v grows, the k_p that the damping ratio allows does not fall, and the one that (10p) allows does: the
    best is at the first k_v where the former is at least the latter, or just before.

    Args:
        gain_range: what the joint must keep to; its ``kv_range`` is not empty.
        proposal: k_v of the convex program, N·m, where the search begins.

    Soundness: the answer does not depend on the proposal, which only says where to look first.
    """
    low, high = gain_range.kv_range
    guess = low if proposal is None else max(low, min(high, int(proposal / float(gain_range.unit))))
    first = _first_undamped(gain_range, guess)
    candidates = [kv for kv in (first - 1, first) if low <= kv <= high]
    kp = max(gain_range.most_kp(kv) for kv in candidates)
    return kp, min(gain_range.most_kv, gain_range.most_sum - kp)


def _undamped(gain_range: GainRange, kv: int) -> bool:
    """Whether (10p) limits k_p, and not the damping ratio."""
    damped = gain_range.damped_kp(kv)
    return damped is None or damped >= gain_range.most_sum - kv


def _first_undamped(gain_range: GainRange, guess: int) -> int:
    """The smallest k_v of the range where (10p) is the limit of k_p; one past the range where none is."""
    low, last = gain_range.kv_range
    high = last + 1
    for step in (guess - 1, guess, guess + 1):
        if low <= step < high:
            low, high = (low, step) if _undamped(gain_range, step) else (step + 1, high)
    while low < high:
        middle = (low + high) // 2
        low, high = (low, middle) if _undamped(gain_range, middle) else (middle + 1, high)
    return low


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
