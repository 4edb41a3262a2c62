"""Measurements as Markdown."""

from __future__ import annotations

from collections.abc import Sequence

from .results import CommandResult, RateResult

HEAD = """# Benchmarks

Written by `make bench`; all numbers are of one run on one machine:

{machine}

## Commands

Wall time of the whole process, start of the interpreter included, median of the runs. By hand means a script
in `tests/benchmarks/by_hand`, timed in the same way; the ratio is by hand ÷ lyapcheck, so more than 1 means
that lyapcheck is faster. No by-hand way comes with a proof.
"""

RATES = """
## V and dV/dt

States per second, median of the runs after one that warms up (lyapcheck's loops are compiled once a
computer). States are random, gains are those of Table 2, m = 2; CasADi's states are CasADi matrices before
the clock starts. The ratio is to lyapcheck.
"""


def markdown(machine: Sequence[str], commands: Sequence[CommandResult], rates: Sequence[RateResult]) -> str:
    """The whole document."""
    parts = [HEAD.format(machine="\n".join(f"- {line}" for line in machine))]
    parts += _commands(commands)
    parts += [RATES, *_rates(rates)]
    return "\n".join(parts) + "\n"


def _commands(results: Sequence[CommandResult]) -> list[str]:
    rows = [
        [
            f"`{result.command}`" if "," not in result.command else result.command,
            f"{result.seconds:.2f} s",
            str(result.runs),
            "—" if result.by_hand_seconds is None else f"{result.by_hand_seconds:.2f} s",
            "—" if result.by_hand_seconds is None else f"{result.by_hand_seconds / result.seconds:.2f}",
            result.by_hand or "nothing compares",
            result.agreement or "—",
        ]
        for result in results
    ]
    return _table(
        ["command", "wall time", "runs", "by hand", "ratio", "what is done by hand", "agreement"], rows
    )


def _rates(results: Sequence[RateResult]) -> list[str]:
    rows = []
    for result in results:
        best = next(iter(result.rates.values()))
        for way, rate in result.rates.items():
            subject = [result.function, f"{result.arm} (n = {result.joints})"]
            rows.append([*subject, way, f"{rate:.2e}", f"{rate / best:.4f}", f"{result.difference:.0e}"])
    return _table(["function", "arm", "way", "states/s", "ratio", "largest difference"], rows)


def _table(head: list[str], rows: list[list[str]]) -> list[str]:
    lines = [head, ["---"] * len(head), *rows]
    return [f"| {' | '.join(cells)} |" for cells in lines]
