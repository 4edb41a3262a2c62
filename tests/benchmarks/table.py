"""table beside mpmath's findroot."""

from __future__ import annotations

import json

from .measure import Disagreement, by_hand, lyapcheck
from .results import CommandResult


def benchmark(first: int = 1, last: int = 1000, digits: int = 50, runs: int = 3) -> CommandResult:
    """The table of γ, ρ and L; both ways must agree in every digit that mpmath prints but the last."""
    line = ("table", "--m", f"{first}:{last}", "--digits", str(digits))
    ours = lyapcheck(*line, runs=runs)
    theirs = by_hand("table_mpmath.py", str(first), str(last), str(digits), runs=runs)
    exact = lyapcheck(*line, "--format", "json", runs=1)
    compared = compare(exact.output, theirs.output, digits)
    return CommandResult(
        command=f"lyapcheck {' '.join(line)}",
        seconds=ours.seconds,
        runs=ours.runs,
        by_hand="mpmath `findroot`, not certified",
        by_hand_seconds=theirs.seconds,
        agreement=f"{compared} constants agree to {digits - 1} digits",
    )


def compare(ours: str, theirs: str, digits: int) -> int:
    """How many constants were compared.

    Raises:
        Disagreement: one is outside its enclosure by more than the last digit.
    """
    from mpmath import mpf, workdps

    rows = {row["m"]: row for row in json.loads(ours)["rows"]}
    count = 0
    with workdps(digits + 10):
        for line in theirs.splitlines():
            m, *values = line.split()
            for name, value in zip(("gamma", "rho", "L"), values, strict=True):
                low, high = (mpf(rows[int(m)][name][end]) for end in ("lower", "upper"))
                slack = abs(high) * mpf(10) ** (1 - digits)
                if not low - slack <= mpf(value) <= high + slack:
                    raise Disagreement(f"{name}_{m}: {value} is outside [{low}, {high}]")
                count += 1
    return count
