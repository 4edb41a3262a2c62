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
    parser.add_argument(
        "--record", type=Path, help="a file of counts: a run goes on where the last one ended"
    )
    options = parser.parse_args(arguments)
    started = time.monotonic()
    tally, printed = _recorded(options), Counter[tuple[str, ...]]()
    options.first, options.statements = (
        options.first + tally.statements,
        options.statements - tally.statements,
    )
    for part in _parts(options):
        tally += part
        _print_faults(part, printed, options.shown)
        print(f"… {tally.statements}: {len(tally.faults)} faults", file=sys.stderr)
        if options.report is not None:  # after every part: an interrupted run leaves what it did
            options.report.parent.mkdir(parents=True, exist_ok=True)
            options.report.write_text(markdown(tally, options.seed), encoding="utf-8")
        if options.record is not None:
            counts = {"seed": options.seed} | tally.data()
            options.record.write_text(json.dumps(counts, ensure_ascii=False, indent=1) + "\n")
    seconds = time.monotonic() - started
    for sort, count in Counter(judged.signature for _, judged in tally.faults).most_common():
        print(f"{count} × {' | '.join(sort)}")
    print(summary(tally))
    print(
        f"{seconds:.0f} s, {seconds / max(options.statements, 1) * 10_000:.0f} s for 10 000", file=sys.stderr
    )
    return int(bool(tally.faults))


def _recorded(options: argparse.Namespace) -> Tally:
    """What earlier runs of the same seed counted."""
    if options.record is None or not options.record.exists():
        return Tally()
    counts = json.loads(options.record.read_text(encoding="utf-8"))
    if counts.pop("seed") != options.seed:
        raise SystemExit(f"{options.record} is of another seed")
    return Tally.of(counts)


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
    """Print the first faults of each sort, made short."""
    for index, judged in part.faults:
        printed[judged.signature] += 1
        if printed[judged.signature] <= most:
            print(f"{index}: {shrunk(judged, index).text()}", flush=True)


if __name__ == "__main__":
    sys.exit(main())
