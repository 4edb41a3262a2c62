"""Hold a checker against the arena: certificates good and bad, each with what must come of it.

    python tests/arena/run.py [--checker "COMMAND"] [--jobs N]

COMMAND reads one file or one folder of certificates, named as its last argument, and ends with exit
code 0 if it accepts all, 3 if it lacks something to decide, 1 or 2 if it refuses. Any other end is a
fault. Without ``--checker`` it is ``python -P -m lyapcheck.check``. Standard library only, so that any
checker can be held against it.
"""

from __future__ import annotations

import argparse
import json
import shlex
import subprocess
import sys
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ARENA = Path(__file__).parent
ENDS = {0: "accepted", 1: "refused", 2: "refused", 3: "undecided"}
SECONDS = 120


def outcome(checker: Sequence[str], path: Path) -> str:
    """What a checker says of one file or folder: accepted, refused, undecided, or how it broke."""
    try:
        ended = subprocess.run([*checker, str(path)], capture_output=True, timeout=SECONDS, check=False)
    except subprocess.TimeoutExpired:
        return f"no end within {SECONDS} s"
    if b"Traceback (most recent call last)" in ended.stderr:
        return "traceback"
    return ENDS.get(ended.returncode, f"exit code {ended.returncode}")


def faults(checker: Sequence[str], jobs: int = 2, one_in: int = 1) -> list[str]:
    """One line for each entry, or one in so many, of which the checker says something else than expected."""
    entries = json.loads((ARENA / "expected.json").read_text())[::one_in]
    with ThreadPoolExecutor(jobs) as pool:
        outcomes = pool.map(lambda entry: outcome(checker, ARENA / entry["path"]), entries)
        return [
            f"{entry['path']}: {got}, expected {' or '.join(entry['expected'])}; {entry['why']}"
            for entry, got in zip(entries, outcomes, strict=True)
            if got not in entry["expected"]
        ]


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--checker", default=f"{shlex.quote(sys.executable)} -P -m lyapcheck.check")
    parser.add_argument("--jobs", type=int, default=2)
    options = parser.parse_args()
    result = faults(shlex.split(options.checker), options.jobs)
    print(*result, sep="\n", end="\n" if result else "")
    print(f"{len(json.loads((ARENA / 'expected.json').read_text()))} entries, {len(result)} faults")
    return 1 if result else 0


if __name__ == "__main__":
    sys.exit(main())
