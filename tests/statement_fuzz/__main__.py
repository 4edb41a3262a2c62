"""``python -m tests.statement_fuzz``: decide and judge many statements; exit code 1 if one is a fault."""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

from tests.statement_fuzz.report import markdown, summary
from tests.statement_fuzz.run import Run, Tally, run

CHUNK = 2_000


def main(arguments: list[str] | None = None) -> int:
    """Run, print the first faults of each sort and how long 10⁴ statements took."""
    parser = argparse.ArgumentParser(prog="python -m tests.statement_fuzz", description=__doc__)
    parser.add_argument("--statements", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0, help="the index of the first statement")
    parser.add_argument("--only", help="one kind of statement, by name")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--shown", type=int, default=2, help="faults of each sort to print")
    parser.add_argument("--report", type=Path, help="where to write the page of figures")
    parser.add_argument(
        "--record", type=Path, help="a file of runs: one with this seed and kind goes on where it ended"
    )
    options = parser.parse_args(arguments)
    started = time.monotonic()
    runs = _recorded(options.record)
    own = next((one for one in runs if (one.seed, one.only) == (options.seed, options.only)), None)
    if own is None:
        runs.append(own := Run(options.seed, options.only))
    printed = Counter[tuple[str, ...]]()
    options.first += own.tally.statements
    options.statements -= own.tally.statements
    for part in _parts(options):
        own.tally += part
        _print_faults(part, printed, options.shown)
        print(f"… {own.tally.statements}: {len(own.tally.faults)} faults", file=sys.stderr)
        if options.report is not None:  # after every part: an interrupted run leaves what it did
            options.report.parent.mkdir(parents=True, exist_ok=True)
            options.report.write_text(markdown(runs), encoding="utf-8")
        if options.record is not None:
            rows = [one.data() for one in runs]
            options.record.write_text(json.dumps(rows, ensure_ascii=False, indent=1) + "\n")
    tally = own.tally
    seconds = time.monotonic() - started
    for sort, count in Counter(judged.signature for _, judged in tally.faults).most_common():
        print(f"{count} × {' | '.join(sort)}")
    print(summary(tally))
    print(
        f"{seconds:.0f} s, {seconds / max(options.statements, 1) * 10_000:.0f} s for 10 000", file=sys.stderr
    )
    return int(bool(tally.faults))


def _recorded(record: Path | None) -> list[Run]:
    """The runs of a file, if there is one."""
    if record is None or not record.exists():
        return []
    return [Run.of(row) for row in json.loads(record.read_text(encoding="utf-8"))]


def _parts(options: argparse.Namespace) -> Iterator[Tally]:
    """The tallies of one chunk of indices after the other."""
    first, end = options.first, options.first + options.statements
    chunks = [range(k, min(k + CHUNK, end)) for k in range(first, end, CHUNK)]
    if options.jobs < 2:
        yield from (run(options.seed, chunk, options.only) for chunk in chunks)
        return
    with ProcessPoolExecutor(options.jobs) as pool:
        count = len(chunks)
        yield from pool.map(run, [options.seed] * count, chunks, [options.only] * count)


def _print_faults(part: Tally, printed: Counter[tuple[str, ...]], most: int) -> None:
    """Print the first faults of each sort."""
    for index, judged in part.faults:
        printed[judged.signature] += 1
        if printed[judged.signature] <= most:
            print(f"{index}: {judged.text()}", flush=True)


if __name__ == "__main__":
    sys.exit(main())
