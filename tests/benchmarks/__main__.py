"""Run all benchmarks and write reports/benchmarks.md."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

from . import alone, certificates, epsilon, gate, simulate, table, throughput
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
    measured, proofs, many, rates = [], [], [], []
    for result in commands():
        progress(f"{result.command}: {result.seconds:.2f} s")
        measured.append(result)
    for proof in certificates.benchmark():
        progress(f"certificates on {proof.arm}, m = {proof.m}: {proof.costs[-1].boxes} boxes")
        proofs.append(proof)
    for proof in certificates.many_joints():
        progress(
            f"bounds in ‖e‖ on {proof.arm}, m = {proof.m}: {proof.costs[-1].share:.1%} of the falsified ε₀"
        )
        many.append(proof)
    for rate in throughput.benchmark():
        progress(f"{rate.function} on {rate.arm}: {next(iter(rate.rates.values())):.2e} states/s")
        rates.append(rate)
    OUT.parent.mkdir(exist_ok=True)
    OUT.write_text(markdown(description(), measured, rates, proofs, many), encoding="utf-8")
    progress(f"written: {OUT.relative_to(Path.cwd()) if OUT.is_relative_to(Path.cwd()) else OUT.name}")


if __name__ == "__main__":
    main()
