"""What a user asks of tuned gains beyond the arm's limits."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from lyapcheck.errors import InputError, Problem

MOST_DIGITS = 12
ONE = (Fraction(1),)


@dataclass(frozen=True)
class Targets:
    """The trade between stiffness, damping and torque; a tuple of one number counts for every joint.

    Args:
        digits: decimal places of the gains, 0 to 12.
        peak_share: the share of each torque limit that may be used, in (0, 1].
        kv_share: the share that k_v takes, at least, of the largest k_v that (19) admits, in (0, 1]; ``None``
            is 1 where no ``kv_min`` is given, and otherwise leaves the matter to ``kv_min``.
        kv_min: a lower bound of k_v, N·m.
        damping: a lower bound of the damping ratio ζ_i of each joint; see ``lyapcheck.tune.damping``.
    """

    digits: int = 3
    peak_share: tuple[Fraction, ...] = ONE
    kv_share: tuple[Fraction, ...] | None = None
    kv_min: tuple[Fraction, ...] | None = None
    damping: tuple[Fraction, ...] | None = None

    @property
    def unit(self) -> Fraction:
        """One unit in the last decimal place of a gain."""
        return Fraction(1, 10**self.digits)

    def share_of_kv(self, joint: int) -> Fraction:
        """The share that k_v of a joint takes; 0 where ``kv_min`` alone says how large it is."""
        if self.kv_share is None:
            return Fraction(1 if self.kv_min is None else 0)
        return self.kv_share[joint]


def joint_values(values: Sequence[Fraction], n: int) -> tuple[Fraction, ...]:
    """One value a joint."""
    return tuple(values) * n if len(values) == 1 else tuple(values)


def require_usable(targets: Targets, n: int) -> None:
    """Refuse targets that no gains could mean.

    Raises:
        InputError: one problem for every target that cannot be used.
    """
    problems = [] if 0 <= targets.digits <= MOST_DIGITS else [_digits(targets.digits)]
    for option, values, top in (
        ("--peak-share", targets.peak_share, Fraction(1)),
        ("--kv-share", targets.kv_share, Fraction(1)),
        ("--kv-min", targets.kv_min, None),
        ("--damping", targets.damping, None),
    ):
        problems += [] if values is None else _complaints(option, values, top, n)
    if problems:
        raise InputError(problems)


def _digits(digits: int) -> Problem:
    rule = f"must be from 0 to {MOST_DIGITS}"
    return Problem("argument", None, "--digits", str(digits), rule, "write --digits 3")


def _complaints(option: str, values: Sequence[Fraction], top: Fraction | None, n: int) -> list[Problem]:
    shown = ",".join(str(float(value)) for value in values)
    if len(values) not in (1, n):
        rule = f"has {len(values)} values for {n} joints"
        return [Problem("argument", None, option, shown, rule, f"give one value, or {n}, one a joint")]
    if min(values) <= 0:
        return [Problem("argument", None, option, shown, "must be positive", "correct the value")]
    if top is not None and max(values) > top:
        return [Problem("argument", None, option, shown, "is a share, at most 1", "write for instance 0.8")]
    return []
