"""Gains of another program as a gain file: the bounded law of the same slope, cut to (10p)."""

from __future__ import annotations

import os
from collections.abc import Sequence
from fractions import Fraction
from pathlib import Path

from lyapcheck.answers.tune.gain_file import beside, condition_text
from lyapcheck.control.conditions import Conditions, gamma_of
from lyapcheck.control.foreign import Pid, read_foreign
from lyapcheck.control.gains import GainSet
from lyapcheck.control.limits import Limits, arm_limits
from lyapcheck.files.decimals import decimal_text, round_down, significant_down
from lyapcheck.files.toml import key_of, quoted

_PLACES = 6
DECIDING = ("10p", "lasalle")
"""Torque limits, and stability with or without friction."""


def brought_file(source: Path, robot: str, folder: Path) -> str:
    """A gain file with the gains that a file of another program has for an arm.

    With h = tanh, of slope 1, K_p h(e) − K_v h(q̇) is K_p e − K_v q̇ near the goal. Where k_p + k_v breaks
    (10p), both are scaled by the same factor until the checker accepts the sum.

    Args:
        source: YAML, JSON or CSV.
        robot: the arm.
        folder: where the file will stand.

    Raises:
        InputError: the source or the arm cannot be used.
    """
    limits = arm_limits(robot)
    pids = read_foreign(source, limits.joints)
    kept = [_bounded(i, pid, limits) for i, pid in enumerate(pids)]
    lines = [
        f"# From {Path(os.path.relpath(source, folder)).as_posix()}, by joint. Judged is",
        "#   τ = K_p tanh(e) − K_v tanh(q̇) + g(q),",
        "# of the same slope as p e − d q̇ near the goal, and bounded. Your controller has to add g(q):",
        "# a joint trajectory controller does not do that by itself.",
        *(
            f"# {pid.joint}: p = {decimal_text(pid.p)}, d = {decimal_text(pid.d)} (line {pid.line})"
            for pid in pids
        ),
        f"robot = {quoted(beside(robot, folder))}",
        "",
        "[[gains]]",
        'name = "brought"',
        "m = 1",
        f"kp = {_table(pids, [kp for kp, _, _ in kept])}  # N·m",
        f"kv = {_table(pids, [kv for _, kv, _ in kept])}  # N·m",
        condition_text(DECIDING),
    ]
    lines += [f"# {word}" for _, _, word in kept if word]
    return "\n".join(lines) + "\n"


def _bounded(i: int, pid: Pid, limits: Limits) -> tuple[Fraction, Fraction, str]:
    """k_p and k_v of a joint, and what was done to them."""
    torque = limits.torque[i]
    if torque is None:
        return pid.p, pid.d, f"{pid.joint}: no torque limit is known, so that nothing was cut"
    n = limits.n
    gains = GainSet("", 1, (pid.p,) * n, (pid.d,) * n)
    check = Conditions(limits, gamma_of(gains)).check_10p(gains)[i]
    largest = None if check.threshold is None else check.threshold.largest(_PLACES)
    if largest is None:
        return pid.p, pid.d, f"{pid.joint}: gravity takes the whole torque limit, and (10p) leaves no gain"
    if pid.p + pid.d <= largest:
        return pid.p, pid.d, ""
    share = Fraction(largest) / (pid.p + pid.d)
    kp, kv = round_down(share * pid.p, _PLACES), round_down(share * pid.d, _PLACES)
    return kp, kv, f"{pid.joint}: cut to {decimal_text(significant_down(share, 3))} of its slope, for (10p)"


def _table(pids: Sequence[Pid], values: Sequence[Fraction]) -> str:
    pairs = (f"{key_of(pid.joint)} = {decimal_text(value)}" for pid, value in zip(pids, values, strict=True))
    return f"{{ {', '.join(pairs)} }}"
