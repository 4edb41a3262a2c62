"""``python -m tests.promises.record [FILE…]``: tests of promises with 200 draws each, and what they ask.

With files or names of tests, only their rows are written anew; rows of tests that are gone go.
"""

from __future__ import annotations

import re
import sys
from collections import Counter
from pathlib import Path

import pytest

FOLDER = Path(__file__).parent
RECORD = FOLDER.parents[1] / "reports" / "promises.md"
HEAD = """# Promises, asked again at members of their ranges

`make promises` wrote this. It runs `tests/promises` with 200 draws a test: arms with ranges, gains near the
border of what is accepted, advice that is followed. Each row counts the commands that a test has run by their
exit codes: 0 is accepted, 1 rejected, 2 refused, 3 undecided.

"""


class Outcomes:
    """The outcome of each test."""

    def __init__(self):
        self.failed: Counter[str] = Counter()

    def pytest_runtest_logreport(self, report):
        """Note a failure."""
        self.failed[report.nodeid.partition("::")[2].partition("[")[0]] += report.failed


def main():
    """Run the tests; write the record where all have passed."""
    outcomes = Outcomes()
    chosen = sys.argv[1:] or [str(FOLDER)]
    words = [*chosen, "-q", "-p", "no:randomly", "--hypothesis-profile", "promises"]
    code = int(pytest.main(words, plugins=[outcomes]))
    if code == 0:
        RECORD.write_text(record(outcomes.failed), encoding="utf-8")
    return code


def tests():
    """The names of the tests that there are."""
    texts = (path.read_text(encoding="utf-8") for path in FOLDER.glob("test_*.py"))
    return {name for text in texts for name in re.findall(r"^def (test_\w+)", text, re.MULTILINE)}


def record(failed):
    """The table."""
    from lyapcheck.verdicts import Exit  # pytest has to import both first
    from tests.promises.draws import ASKED

    codes = (Exit.PROVED, Exit.REFUTED, Exit.USAGE, Exit.UNDECIDED)
    rows: dict[str, list[str]] = {}
    if len(sys.argv) > 1 and RECORD.exists():
        present = tests()
        for line in RECORD.read_text(encoding="utf-8").splitlines():
            name = line.split(" | ")[0].removeprefix("| ")
            if name in present:
                rows.setdefault(name, []).append(line)
    for test in {test for test, _, _ in ASKED}:
        rows[test] = []
    for test, command in sorted({(test, command) for test, command, _ in ASKED}):
        counts = [ASKED[test, command, int(code)] for code in codes]
        rows[test].append(f"| {test} | {command} | {sum(counts)} | {' | '.join(map(str, counts))} |")
    lines = ["| test | command | runs | 0 | 1 | 2 | 3 |", "|---|---|---|---|---|---|---|"]
    lines += [line for test in sorted(rows) for line in rows[test]]
    return HEAD + "\n".join([*lines, "", f"{len(rows)} tests, {sum(failed.values())} failed."]) + "\n"


if __name__ == "__main__":
    raise SystemExit(main())
