"""``python -m tests.statement_fuzz``: decide and judge many statements; exit code 1 if one is a fault."""

import argparse
import sys
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field
from functools import partial

from tests.statement_fuzz.generators import draw
from tests.statement_fuzz.judge import judge

CHUNK = 2_000


@dataclass
class Run:
    """How often each kind got each verdict, and the faults with their index."""

    verdicts: Counter = field(default_factory=Counter)
    faults: list = field(default_factory=list)


def judged(indices, seed, only=None):
    """The statements of a seed with these indices."""
    run = Run()
    for index in indices:
        one = judge(draw(seed, index, only), index)
        run.verdicts[one.kind, one.verdict] += 1
        run.faults += [f"{index}: {one.text()}"] if one.fault else []
    return run


def main():
    parser = argparse.ArgumentParser(prog="python -m tests.statement_fuzz", description=__doc__)
    parser.add_argument("--statements", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", help="one kind of statement, by name")
    parser.add_argument("--jobs", type=int, default=1)
    options = parser.parse_args()
    chunks = [range(k, min(k + CHUNK, options.statements)) for k in range(0, options.statements, CHUNK)]
    whole = Run()
    with ProcessPoolExecutor(options.jobs) as pool:
        for part in pool.map(partial(judged, seed=options.seed, only=options.only), chunks):
            whole.verdicts += part.verdicts
            whole.faults += part.faults
            print(
                *part.faults, f"… {whole.verdicts.total()}: {len(whole.faults)} faults", sep="\n", flush=True
            )
    for (kind, verdict), count in sorted(whole.verdicts.items()):
        print(f"{kind}: {count} {verdict}")
    return int(bool(whole.faults))


if __name__ == "__main__":
    sys.exit(main())
