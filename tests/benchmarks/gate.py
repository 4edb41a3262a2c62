"""gate beside a NumPy script."""

from __future__ import annotations

import json

from .measure import PROOFS, Disagreement, by_hand, lyapcheck
from .results import CommandResult


def benchmark(runs: int = 5) -> CommandResult:
    """Table 2 through the gate; both ways must give the same verdicts."""
    gains = str(PROOFS / "table2.toml")
    ours = lyapcheck("gate", gains, runs=runs)
    theirs = by_hand("gate_numpy.py", gains, runs=runs)
    exact = lyapcheck("gate", gains, "--format", "json", runs=1)
    count = compare(exact.output, theirs.output)
    return CommandResult(
        command="lyapcheck gate proofs/table2.toml",
        seconds=ours.seconds,
        runs=ours.runs,
        by_hand="NumPy: γ from a grid, so from below",
        by_hand_seconds=theirs.seconds,
        agreement=f"the same {count} verdicts; by hand no margins and no largest values",
    )


def compare(ours: str, theirs: str) -> int:
    """How many verdicts were compared.

    Raises:
        Disagreement: a verdict differs.
    """
    verdicts = {row["name"]: row["verdict"] for row in json.loads(ours)["results"]}
    by_name = dict(line.split() for line in theirs.splitlines())
    if verdicts != by_name:
        raise Disagreement(f"lyapcheck says {verdicts}, NumPy says {by_name}")
    return len(verdicts)
