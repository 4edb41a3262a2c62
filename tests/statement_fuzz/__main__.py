"""``python -m tests.statement_fuzz``: decide and judge many statements; exit code 1 if one is a fault."""

import argparse
import hashlib
import json
import sys
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from functools import cache, partial
from pathlib import Path

import lyapcheck.check
from tests.statement_fuzz.generators import draw
from tests.statement_fuzz.judge import VERDICTS, judge

CHUNK = 2_000
INTRODUCTION = """\
A program writes statements of the kinds that users write, many of them false or undefined somewhere,
and decides them. An oracle that shares no code with lyapcheck looks for a point at which a proved
statement fails or a term of it is undefined, and replays every counterexample. A fault is: proved with
such a point, or though false by construction; refuted by a point that is none, or though true by
construction; an exception. Where a row counts what is undecided and not true, the oracle was also asked of
statements that stay undecided. `Altered` are certificates of the arena in which something was changed, and
the kinds that begin with `By`, of earlier runs, proofs put to statements that they were not made for. Written
by `python -m tests.statement_fuzz`.
"""


class Run:
    """The statements of a seed, of all generators or of ``only`` one, counted as far as they are judged."""

    def __init__(self, seed, only, verdicts=(), faults=(), checkers=(), **_):
        self.seed, self.only = seed, only
        self.verdicts = Counter({(kind, verdict): count for kind, verdict, count in verdicts})
        self.faults, self.checkers = list(faults), Counter(dict(checkers))

    def data(self):
        """The run as plain data; of the faults their index and words."""
        counts = [[*key, count] for key, count in sorted(self.verdicts.items())]
        own = {"verdicts": counts, "faults": self.faults, "checkers": dict(self.checkers)}
        return {"seed": self.seed, "only": self.only, **own}

    def add(self, other):
        """Count another part of the run."""
        self.verdicts += other.verdicts
        self.checkers += other.checkers
        self.faults = sorted([*self.faults, *other.faults])

    @property
    def statements(self):
        """How many were judged."""
        return self.verdicts.total()


def judged(indices, seed, only=None):
    """The statements of a seed with these indices."""
    run = Run(seed, only)
    for index in indices:
        one = judge(draw(seed, index, only), index)
        run.verdicts[one.kind, one.verdict] += 1
        if one.fault:
            run.faults.append([index, one.text()])
    run.checkers[checker()] = run.statements
    return run


@cache
def checker():
    """The first digits of the SHA-256 of the sources of ``lyapcheck/check``."""
    sources = sorted(Path(lyapcheck.check.__file__).parent.rglob("*.py"))
    return hashlib.sha256(b"".join(source.read_bytes() for source in sources)).hexdigest()[:12]


def markdown(runs):
    """The figures of runs as a page."""
    whole = Run(None, None)
    for one in runs:
        whole.add(one)
    by = ", ".join(f"{count} {verdict}" for verdict, count in _counts(whole).items() if count)
    lines = [
        "# Statements at random",
        "",
        f"{whole.statements} statements: {by}; {len(whole.faults)} faults.",
        "",
        INTRODUCTION,
        "## Runs",
        "",
        _row(["seed", "statements of", *VERDICTS, "faults", "checker"]),
        _row(["---:", "---", *["---:"] * (len(VERDICTS) + 1), "---"]),
    ]
    for one in runs:
        checkers = ", ".join(f"{count} by {digest}" for digest, count in one.checkers.items())
        cells = [one.seed, one.only or "all kinds", *_counts(one).values(), len(one.faults), checkers]
        lines.append(_row(cells))
    lines += ["", "## By kind of statement", "", _row(["statement", "decided", *VERDICTS, "faults"])]
    lines.append(_row(["---", *["---:"] * (len(VERDICTS) + 2)]))
    for kind in sorted({kind for kind, _ in whole.verdicts}):
        cells = [whole.verdicts[kind, verdict] for verdict in VERDICTS]
        faults = sum(text.startswith(f"{kind},") for _, text in whole.faults)
        lines.append(_row([kind, sum(cells), *cells, faults]))
    if whole.faults:
        lines += ["", "## Faults", "", *(f"- {index}: {text}" for index, text in whole.faults[:200])]
    return "\n".join(lines) + "\n"


def _counts(run):
    counts = dict.fromkeys(VERDICTS, 0)
    for (_, verdict), count in run.verdicts.items():
        counts[verdict] += count
    return counts


def _row(cells):
    return "| " + " | ".join(map(str, cells)) + " |"


def main(arguments=None):
    """Run, print the faults, and write the page and the record after every part."""
    parser = argparse.ArgumentParser(prog="python -m tests.statement_fuzz", description=__doc__)
    parser.add_argument("--statements", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", help="one kind of statement, by name")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--report", type=Path, help="where to write the page of figures")
    record = "a file of runs: one with this seed and kind goes on where it ended"
    parser.add_argument("--record", type=Path, help=record)
    options = parser.parse_args(arguments)
    runs = []
    if options.record is not None and options.record.exists():
        runs = [Run(**row) for row in json.loads(options.record.read_text(encoding="utf-8"))]
    own = next((one for one in runs if (one.seed, one.only) == (options.seed, options.only)), None)
    if own is None:
        runs.append(own := Run(options.seed, options.only))
    first, end = own.statements, options.statements
    chunks = [range(k, min(k + CHUNK, end)) for k in range(first, end, CHUNK)]
    with ProcessPoolExecutor(options.jobs) as pool:
        parts = (pool.map if options.jobs > 1 else map)(
            partial(judged, seed=options.seed, only=options.only), chunks
        )
        for part in parts:
            own.add(part)
            for index, text in part.faults:
                print(f"{index}: {text}", flush=True)
            print(f"… {own.statements}: {len(own.faults)} faults", file=sys.stderr)
            _write(options, runs)
    _write(options, runs)
    print(markdown([own]).splitlines()[2])
    return int(bool(own.faults))


def _write(options, runs):
    if options.report is not None:
        options.report.write_text(markdown(runs), encoding="utf-8")
    if options.record is not None:
        rows = json.dumps([one.data() for one in runs], ensure_ascii=False, indent=1)
        options.record.write_text(rows + "\n", encoding="utf-8")


if __name__ == "__main__":
    sys.exit(main())
