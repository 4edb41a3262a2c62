"""Run all benchmarks and write reports/benchmarks.md."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

from . import alone, batches, certificates, constants, epsilon, gate, simulate, table, throughput
from .machine import description
from .render import markdown
from .results import CommandResult

OUT = Path(__file__).parents[2] / "reports" / "benchmarks.md"


def commands() -> Iterator[CommandResult]:
    """The commands beside their by-hand counterparts, then those without one."""
    yield table.benchmark()
    yield from gate.benchmarks()
    for module in (simulate, epsilon):
        yield module.benchmark()
    yield from alone.benchmark()


def progress(line: str) -> None:
    """Progress."""
    print(f"bench: {line}", file=sys.stderr, flush=True)


def main() -> None:
    """Measure, then write the document in one piece."""
    measured, proofs, many, arms, rates, runs = [], [], [], [], [], []
    for result in commands():
        progress(f"{result.command}: {result.seconds:.2f} s")
        measured.append(result)
    for proof in certificates.benchmark():
        progress(f"certificates on {proof.arm}, m = {proof.m}: {proof.costs[-1].boxes} boxes")
        proofs.append(proof)
    for row in certificates.many_joints():
        progress(
            f"epsilon on {row.arm}, m = {row.m}: {row.certified / row.falsified:.1%} in {row.seconds:.0f} s"
        )
        many.append(row)
    for arm in constants.benchmark():
        progress(f"robot on {arm.arm}: {arm.seconds:.1f} s")
        arms.append(arm)
    for rate in throughput.benchmark():
        progress(f"{rate.function} on {rate.arm}: {next(iter(rate.rates.values())):.2e} states/s")
        rates.append(rate)
    for way in batches.benchmark():
        progress(f"{way.way}: {way.rate:.0f} runs/s")
        runs.append(way)
    OUT.parent.mkdir(exist_ok=True)
    OUT.write_text(markdown(description(), measured, rates, proofs, many, arms, runs), encoding="utf-8")
    progress(f"written: {OUT.relative_to(Path.cwd()) if OUT.is_relative_to(Path.cwd()) else OUT.name}")


if __name__ == "__main__":
    main()
