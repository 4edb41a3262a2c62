"""epsilon beside random sampling."""

from __future__ import annotations

import json

from .measure import PROOFS, Disagreement, by_hand, lyapcheck
from .results import CommandResult


def benchmark(states: int = 1_000_000, runs: int = 1) -> CommandResult:
    """ε₀ of one gain set; sampling may refute only what lyapcheck has not proved."""
    gains = str(PROOFS / "table2.toml")
    ours = lyapcheck("epsilon", gains, "--m", "1", "--format", "json", runs=runs)
    theirs = by_hand("epsilon_sampling.py", gains, "1", str(states), runs=runs)
    certified, falsified, sampled = compare(ours.output, theirs.output)
    return CommandResult(
        command="lyapcheck epsilon proofs/table2.toml --m 1",
        seconds=ours.seconds,
        runs=ours.runs,
        by_hand=f"NumPy, {states} random states",
        by_hand_seconds=theirs.seconds,
        agreement=f"proved up to {certified:.6f}, refuted from {falsified:.6f}; "
        f"sampling proves nothing and refutes from {sampled:.4f}",
    )


def compare(ours: str, theirs: str) -> tuple[float, float, float]:
    """The certified and the falsified ε₀, and the smallest that sampling refutes.

    Raises:
        Disagreement: sampling refutes what was proved.
    """
    (row,) = json.loads(ours)["results"]
    certified, falsified, sampled = float(row["certified"]), float(row["falsified"]), float(theirs)
    if not certified < falsified or sampled < certified:
        raise Disagreement(f"certified {certified}, falsified {falsified}, refuted by sampling {sampled}")
    return certified, falsified, sampled
