"""simulate beside SciPy's solve_ivp."""

from __future__ import annotations

import json

from .measure import PROOFS, Disagreement, by_hand, lyapcheck
from .results import CommandResult

TOLERANCE = 1e-6


def benchmark(runs: int = 3) -> CommandResult:
    """The closed loop under the gains of Table 2; both ways must give the same L2 index."""
    gains = str(PROOFS / "table2.toml")
    ours = lyapcheck("simulate", gains, runs=runs)
    theirs = by_hand("simulate_scipy.py", gains, runs=runs)
    exact = lyapcheck("simulate", gains, "--format", "json", runs=1)
    worst = compare(exact.output, theirs.output)
    return CommandResult(
        command="lyapcheck simulate proofs/table2.toml",
        seconds=ours.seconds,
        runs=ours.runs,
        by_hand="SciPy `solve_ivp` on NumPy matrices, each run once; lyapcheck runs each twice",
        by_hand_seconds=theirs.seconds,
        agreement=f"L2 indices agree to {worst:.0e}; by hand no V, no settling, no error estimate",
    )


def compare(ours: str, theirs: str) -> float:
    """The largest relative difference of the L2 indices.

    Raises:
        Disagreement: it is more than the tolerance.
    """
    index = {row["name"]: float(row["L2"]) for row in json.loads(ours)["results"]}
    by_name = {name: float(value) for name, value in (line.split() for line in theirs.splitlines())}
    if set(index) != set(by_name):
        raise Disagreement(f"lyapcheck ran {sorted(index)}, SciPy ran {sorted(by_name)}")
    worst = max(abs(index[name] / by_name[name] - 1) for name in index)
    if worst > TOLERANCE:
        raise Disagreement(f"L2: lyapcheck has {index}, SciPy has {by_name}")
    return worst
