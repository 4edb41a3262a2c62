"""Gain files: of tuned gains, and of the gains that a file of another program has for an arm."""

from __future__ import annotations

import os
from collections.abc import Sequence
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING

from lyapcheck.answers.tune.answer import TUNED, TunedSet
from lyapcheck.control.conditions import Conditions
from lyapcheck.control.foreign import Pid, read_foreign
from lyapcheck.control.gains import DECIDING, Bounds, GainSet
from lyapcheck.control.limits import Limits, arm_limits
from lyapcheck.family.base import named
from lyapcheck.files.decimals import decimal_text, round_down, significant_down
from lyapcheck.files.loop import NOTHING
from lyapcheck.files.toml import key_of, quoted
from lyapcheck.robots.choice import placed

if TYPE_CHECKING:
    from lyapcheck.answers.tune.answer import Tuning
    from lyapcheck.answers.tune.bench import BenchTuning, Candidate

HEAD = """\
# The largest gains that meet (10p) and (19), with {targets}.
# One unit more in the last place of any gain breaks what its comment names.
"""
NAMES = {"10p": "(10p)", "19": "(19)", "damping": "the damping ratio"}
BROUGHT = ("10p", "lasalle")
"""Of gains from elsewhere: torque limits, and stability with or without friction."""
_PLACES = 6


def gain_file_text(tuning: Tuning, folder: Path | None = None) -> str:
    """The tuned sets as TOML that ``lyapcheck gate`` accepts.

    Args:
        tuning: what ``tune`` returned.
        folder: where the file will stand, as a path of an arm file is meant relative to the gain file.
    """
    blocks = [HEAD.format(targets=tuning.targets.text()) + f"robot = {quoted(beside(tuning.robot, folder))}"]
    blocks += [_set(item, tuning.targets.digits) for item in tuning.sets if item.status == TUNED]
    blocks += _tables(tuning)
    return "\n\n".join(blocks) + "\n"


def _tables(tuning: Tuning | BenchTuning) -> list[str]:
    """What the user said of the arm and of the loop."""
    bounds = [] if tuning.bounds == Bounds() else [_bounds(tuning.bounds)]
    return [*bounds, *([] if tuning.loop == NOTHING else [tuning.loop.toml])]


def _set(item: TunedSet, digits: int) -> str:
    lines = []
    for key in ("kp", "kv"):
        bounds = ", ".join(NAMES[getattr(joint, f"{key}_bound")] for joint in item.joints)
        values = list_text([getattr(joint, key) for joint in item.joints], digits)
        lines.append((f"{key} = {values}", f"# N·m; {bounds}"))
    width = max(len(line) for line, _ in lines) + 2
    gains = [line.ljust(width) + comment for line, comment in lines]
    return _set_text(item.name, item.m, gains, DECIDING)


def _set_text(name: str, m: int | None, gains: Sequence[str], condition: Sequence[str]) -> str:
    """The table of a gain set, with the conditions that decide where there are any."""
    deciding = [f"condition = [{', '.join(map(quoted, condition))}]"] if condition else []
    return "\n".join(["[[gains]]", f"name = {quoted(name)}", f"m = {m}", *gains, *deciding])


def _bounds(bounds: Bounds) -> str:
    """The table of limits that the arm alone does not have."""
    lines = ["[bounds]"]
    if bounds.viscous_min is not None:
        lines.append(f"viscous_min = {decimal_text(bounds.viscous_min)}  # N·m·s/rad")
    for key in ("torque", "gravity"):
        values = getattr(bounds, key)
        if values is not None:
            lines.append(f"{key} = {list_text(values, 0)}  # N·m")
    return "\n".join(lines)


def list_text(values: Sequence[Fraction], digits: int) -> str:
    """Gains as a TOML array."""
    return f"[{', '.join(decimal_text(value, digits) for value in values)}]"


def beside(robot: str, folder: Path | None) -> str:
    """The path of an arm file from the folder of a gain file; the name of a built-in arm as it is."""
    if folder is None:
        return robot
    return placed(robot, lambda path: Path(os.path.relpath(path, folder)).as_posix())


def bench_file_text(tuning: BenchTuning, folder: Path | None = None, *, best: bool = False) -> str:
    """The sets that meet the targets as TOML that ``lyapcheck gate`` accepts; empty where none does.

    Args:
        tuning: what ``tune_for`` returned.
        best: where no set meets the targets, the best one, marked.
        folder: where the file will stand, as a path of an arm file is meant relative to the gain file.
    """
    sets = tuning.good or ([tuning.best] if best and tuning.best is not None else [])
    if not sets:
        return ""
    lines = [f"# Asked: {tuning.bench.wishes.text()}.", f"# Simulated: {tuning.scope}."]
    if tuning.varies:
        options = " ".join(f"--vary {one.text}" for one in tuning.varies)
        lines.append(f"# Gains for ranges of the arm: lyapcheck gate FILE {options}")
    lines.append(f"robot = {quoted(beside(tuning.robot, folder))}")
    blocks = ["\n".join(lines), *(_bench_set(one, tuning) for one in sets)]
    blocks += _tables(tuning)
    return "\n\n".join(blocks) + "\n"


def _bench_set(one: Candidate, tuning: BenchTuning) -> str:
    met = "simulated: meets all targets"
    if not tuning.met(one):
        met = f"BEST FOUND, MISSES THE TARGETS: {'; '.join(tuning.missed(one))}"
    gains = one.gains
    lines = [
        f"{key} = {list_text(values, tuning.bench.digits)}  # N·m"
        for key, values in (("kp", gains.kp), ("kv", gains.kv))
    ]
    return f"# {met}; {one.shown}\n" + _set_text(gains.name, gains.m, lines, gains.condition)


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
    gains = [f"{key} = {_table(pids, values)}  # N·m" for key, values in (("kp", kp), ("kv", kv))]
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
        _set_text("brought", 1, gains, BROUGHT),
    ]
    lines += [f"# {word}" for word in words if word]
    return "\n".join(lines) + "\n"


def _bounded(i: int, pid: Pid, limits: Limits) -> tuple[Fraction, Fraction, str]:
    """k_p and k_v of a joint, and what was done to them."""
    torque = limits.torque[i]
    if torque is None:
        return pid.p, pid.d, f"{pid.joint}: no torque limit is known, so that nothing was cut"
    n = limits.n
    gains = GainSet("", 1, (pid.p,) * n, (pid.d,) * n)
    check = Conditions(limits, named("hyperbolic", 1).gamma).check_10p(gains)[i]
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
