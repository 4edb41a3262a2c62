"""Gains for targets as a gain file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from lyapcheck.answers.tune.gain_file import beside, bounds_text, condition_text, list_text, quoted
from lyapcheck.control.gains import Bounds

if TYPE_CHECKING:
    from lyapcheck.answers.tune.response.answer import BenchTuning, Candidate


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
    blocks = ["\n".join(lines), *(_set(one, tuning) for one in sets)]
    if tuning.bounds != Bounds():
        blocks.append(bounds_text(tuning.bounds))
    return "\n\n".join(blocks) + "\n"


def _set(one: Candidate, tuning: BenchTuning) -> str:
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
