"""Gain files: of tuned gains, and of the gains that a file of another program has for an arm."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from fractions import Fraction
from functools import partial
from pathlib import Path

from lyapcheck.control.conditions import Conditions
from lyapcheck.control.foreign import Pid, read_foreign
from lyapcheck.control.gains import Bounds, GainSet
from lyapcheck.control.limits import Limits, arm_limits
from lyapcheck.family.base import named
from lyapcheck.files.decimals import decimal_text, round_down, significant_down
from lyapcheck.files.loop import NOTHING, LoopEntry
from lyapcheck.files.toml import key_of, quoted
from lyapcheck.robots.choice import placed

BROUGHT = ("10p", "lasalle")
"""Of gains from elsewhere: torque limits, and stability with or without friction."""
_PLACES = 6


def gain_file_text(
    head: Sequence[str],
    robot: str,
    sets: Sequence[str],
    bounds: Bounds,
    loop: LoopEntry,
    folder: Path | None = None,
) -> str:
    """Gain sets as TOML that ``lyapcheck gate`` accepts; empty without any.

    Args:
        head: comments on all of them.
        robot: the name or path of the arm.
        sets: texts of `set_text`.
        bounds: what the user said of the arm.
        loop: what the user said of the loop.
        folder: where the file will stand, as a path of an arm file is meant relative to the gain file.
    """
    if not sets:
        return ""
    blocks = ["\n".join([*head, f"robot = {quoted(beside(robot, folder))}"]), *sets]
    lines = []
    if bounds.viscous_min is not None:
        lines.append(f"viscous_min = {decimal_text(bounds.viscous_min)}  # N·m·s/rad")
    for key in ("torque", "gravity"):
        values = getattr(bounds, key)
        if values is not None:
            lines.append(f"{key} = {list_text(values, 0)}  # N·m")
    blocks += ["\n".join(["[bounds]", *lines])] if lines else []
    blocks += [] if loop == NOTHING else [loop.toml]
    return "\n\n".join(blocks) + "\n"


def set_text(gains: GainSet, shown: Callable[[Sequence[Fraction]], str], notes: Sequence[str] = ()) -> str:
    """The table of a gain set, with notes on its k_p and its k_v, or without.

    Args:
        gains: the set, with the conditions that decide where there are any.
        shown: its k_p, or its k_v, as TOML.
        notes: what the comment of each goes on with.
    """
    lines = [f"{key} = {shown(getattr(gains, key))}" for key in ("kp", "kv")]
    width = max(map(len, lines)) if notes else 0
    rows = zip(lines, notes or ("", ""), strict=True)
    lines = [f"{line.ljust(width)}  # N·m{note}" for line, note in rows]
    if gains.condition:
        lines.append(f"condition = [{', '.join(map(quoted, gains.condition))}]")
    return "\n".join(["[[gains]]", f"name = {quoted(gains.name)}", f"m = {gains.m}", *lines])


def list_text(values: Sequence[Fraction], digits: int) -> str:
    """Numbers as a TOML array."""
    return f"[{', '.join(decimal_text(value, digits) for value in values)}]"


def beside(robot: str, folder: Path | None) -> str:
    """The path of an arm file from the folder of a gain file; the name of a built-in arm as it is."""
    if folder is None:
        return robot
    return placed(robot, lambda path: Path(os.path.relpath(path, folder)).as_posix())


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
    kp, kv, words = zip(*kept, strict=True)
    gains = GainSet("brought", 1, kp, kv, condition=BROUGHT)
    lines = [
        f"# From {Path(os.path.relpath(source, folder)).as_posix()}, by joint. Judged is",
        "#   τ = K_p tanh(e) − K_v tanh(q̇) + g(q),",
        "# of the same slope as p e − d q̇ near the goal, and bounded. Your controller has to add g(q):",
        "# a joint trajectory controller does not do that by itself.",
    ]
    for one in pids:
        lines.append(f"# {one.joint}: p = {decimal_text(one.p)}, d = {decimal_text(one.d)} (line {one.line})")
    lines += [f"robot = {quoted(beside(robot, folder))}", "", set_text(gains, partial(_table, pids))]
    lines += [f"# {word}" for word in words if word]
    return "\n".join(lines) + "\n"


def _bounded(i: int, pid: Pid, limits: Limits) -> tuple[Fraction, Fraction, str]:
    """k_p and k_v of a joint, and what was done to them."""
    torque = limits.torque[i]
    if torque is None:
        return pid.p, pid.d, f"{pid.joint}: no torque limit is known, so that nothing was cut"
    n = limits.n
    gains = GainSet("", 1, (pid.p,) * n, (pid.d,) * n)
    check = Conditions(limits, named("hyperbolic", 1).gamma).checks("10p", gains)[i]
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
