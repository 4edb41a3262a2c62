"""``python -m tests.fuzz_readers``: fails when an input ends in another error, hangs or hoards memory."""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from pathlib import Path

from .run import run


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--inputs", type=int, default=100_000)
    parser.add_argument("--seed", type=int, default=20190301)
    parser.add_argument("--keep", type=Path, help="a folder for the inputs that fail")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        folder = options.keep or Path(scratch)
        folder.mkdir(parents=True, exist_ok=True)
        begin = time.monotonic()
        outcome = run(options.inputs, folder, options.seed)
    for failure in outcome.failures:
        print(failure, file=sys.stderr)
    print(f"{outcome.sentence}; {time.monotonic() - begin:.0f} s in all")
    return int(bool(outcome.failures))


if __name__ == "__main__":
    sys.exit(main())
