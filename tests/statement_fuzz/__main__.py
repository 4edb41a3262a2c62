"""``python -m tests.statement_fuzz``: decide and judge many statements; exit code 1 if one is a fault."""

from __future__ import annotations

import argparse
import sys
import time
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

from tests.statement_fuzz.report import markdown, summary
from tests.statement_fuzz.run import Tally, run
from tests.statement_fuzz.shrink import shrunk

CHUNK = 2_000


def main(arguments: list[str] | None = None) -> int:
    """Run, print the faults (the first of each sort made short) and how long 10⁴ statements took."""
    parser = argparse.ArgumentParser(prog="python -m tests.statement_fuzz", description=__doc__)
    parser.add_argument("--statements", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0, help="the index of the first statement")
    parser.add_argument("--only", help="one kind of statement, by name")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--shown", type=int, default=2, help="faults of each sort to print")
    parser.add_argument("--report", type=Path, help="where to write the page of figures")
    options = parser.parse_args(arguments)
    started = time.monotonic()
    tally = _run(options.seed, options.first, options.statements, options.jobs, options.only)
    seconds = time.monotonic() - started
    _print_faults(tally, options.shown)
    print(summary(tally))
    print(
        f"{seconds:.0f} s, {seconds / max(options.statements, 1) * 10_000:.0f} s for 10 000", file=sys.stderr
    )
    if options.report is not None:
        options.report.parent.mkdir(parents=True, exist_ok=True)
        options.report.write_text(markdown(tally, options.seed), encoding="utf-8")
    return int(bool(tally.faults))


def _run(seed: int, first: int, count: int, jobs: int, only: str | None) -> Tally:
    chunks = [range(k, min(k + CHUNK, first + count)) for k in range(first, first + count, CHUNK)]
    total = Tally()
    if jobs < 2:
        for chunk in chunks:
            total = total + run(seed, chunk, only)
            print(f"… {total.statements}: {len(total.faults)} faults", file=sys.stderr)
        return total
    with ProcessPoolExecutor(jobs) as pool:
        for tally in pool.map(run, [seed] * len(chunks), chunks, [only] * len(chunks)):
            total = total + tally
            print(f"… {total.statements}: {len(total.faults)} faults", file=sys.stderr)
    return total


def _print_faults(tally: Tally, shown: int) -> None:
    sorts: Counter[tuple[str, ...]] = Counter(judged.signature for _, judged in tally.faults)
    printed: Counter[tuple[str, ...]] = Counter()
    for index, judged in tally.faults:
        if printed[judged.signature] < shown:
            printed[judged.signature] += 1
            short = shrunk(judged, index)
            print(f"{index} (one of {sorts[judged.signature]}): {short.text()}")


if __name__ == "__main__":
    sys.exit(main())
