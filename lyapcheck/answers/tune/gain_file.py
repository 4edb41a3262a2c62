"""Tuned gains as a gain file."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING

from lyapcheck.answers.tune.answer import TUNED, TunedSet
from lyapcheck.control.gains import DECIDING, Bounds
from lyapcheck.files.decimals import decimal_text
from lyapcheck.files.loop import NOTHING
from lyapcheck.files.toml import quoted
from lyapcheck.robots.choice import placed

if TYPE_CHECKING:
    from lyapcheck.answers.tune.answer import Tuning
    from lyapcheck.answers.tune.response.answer import BenchTuning, Candidate

HEAD = """\
# The largest gains that meet (10p) and (19), with {targets}.
# One unit more in the last place of any gain breaks what its comment names.
"""


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
    bounds = [] if tuning.bounds == Bounds() else [bounds_text(tuning.bounds)]
    return [*bounds, *([] if tuning.loop == NOTHING else [tuning.loop.toml])]


def _set(item: TunedSet, digits: int) -> str:
    kp_bounds, kv_bounds = ((j.kp_bound for j in item.joints), (j.kv_bound for j in item.joints))
    kp = list_text([joint.kp for joint in item.joints], digits)
    kv = list_text([joint.kv for joint in item.joints], digits)
    width = max(len(kp), len(kv)) + len("kp = ") + 2
    return "\n".join(
        [
            "[[gains]]",
            f"name = {quoted(item.name)}",
            f"m = {item.m}",
            f"kp = {kp}".ljust(width) + f"# N·m; {_bound_words(kp_bounds)}",
            f"kv = {kv}".ljust(width) + f"# N·m; {_bound_words(kv_bounds)}",
            condition_text(DECIDING),
        ]
    )


def condition_text(condition: Sequence[str]) -> str:
    """The line that names the conditions of a gain set."""
    return f"condition = [{', '.join(map(quoted, condition))}]"


def bounds_text(bounds: Bounds) -> str:
    """The table of limits that the arm alone does not have."""
    lines = ["[bounds]"]
    if bounds.viscous_min is not None:
        lines.append(f"viscous_min = {decimal_text(bounds.viscous_min)}  # N·m·s/rad")
    for key in ("torque", "gravity"):
        values = getattr(bounds, key)
        if values is not None:
            lines.append(f"{key} = {list_text(values, 0)}  # N·m")
    return "\n".join(lines)


def _bound_words(bounds: Iterable[str]) -> str:
    names = {"10p": "(10p)", "19": "(19)", "damping": "the damping ratio"}
    return ", ".join(names[bound] for bound in bounds)


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
    digits = tuning.bench.digits
    met = "simulated: meets all targets"
    if not tuning.met(one):
        met = f"BEST FOUND, MISSES THE TARGETS: {'; '.join(tuning.missed(one))}"
    return "\n".join(
        [
            f"# {met}; {one.shown}",
            "[[gains]]",
            f"name = {quoted(one.gains.name)}",
            f"m = {one.gains.m}",
            f"kp = {list_text(one.gains.kp, digits)}  # N·m",
            f"kv = {list_text(one.gains.kv, digits)}  # N·m",
            *([condition_text(one.gains.condition)] if one.gains.condition else []),
        ]
    )
