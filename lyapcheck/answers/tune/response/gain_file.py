"""Gains for targets as a gain file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from lyapcheck.answers.tune.gain_file import beside, list_text, quoted

if TYPE_CHECKING:
    from lyapcheck.answers.tune.response.answer import BenchTuning, Candidate


def bench_file_text(tuning: BenchTuning, folder: Path | None = None) -> str:
    """The sets that were found as TOML that ``lyapcheck gate`` reads.

    Args:
        tuning: what ``tune_for`` returned.
        folder: where the file will stand, as a path of an arm file is meant relative to the gain file.
    """
    head = f"# Asked: {tuning.bench.wishes.text()}.\nrobot = {quoted(beside(tuning.robot, folder))}"
    return "\n\n".join([head, *(_set(one, tuning) for one in tuning.own)]) + "\n"


def _set(one: Candidate, tuning: BenchTuning) -> str:
    digits, worst = tuning.bench.digits, one.trial.worst(tuning.bench.wishes)
    met = "all that was asked is met" if tuning.met(one) else f"{worst:.2f} times what was asked"
    return "\n".join(
        [
            f"# {met}; stable by {one.stable or 'nothing that was found'}",
            "[[gains]]",
            f"name = {quoted(one.gains.name)}",
            f"m = {one.gains.m}",
            f"kp = {list_text(one.gains.kp, digits)}  # N·m",
            f"kv = {list_text(one.gains.kv, digits)}  # N·m",
        ]
    )
