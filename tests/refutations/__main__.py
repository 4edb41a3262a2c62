"""Plants the faults, decides them, writes reports/refutations.md; exit code 1 if a false one is proved."""

from __future__ import annotations

import sys

from tests.refutations.report import REPORT, markdown, summary
from tests.refutations.suite import LEAST, outcomes, planted, wrongly_proved


def main() -> int:
    """Run the whole suite."""
    plan = planted()
    result = outcomes(plan.false)
    REPORT.parent.mkdir(exist_ok=True)
    REPORT.write_text(markdown(plan, result), encoding="utf-8")
    print(summary(result))
    wrong = wrongly_proved(result)
    for name in wrong:
        print(f"false, yet proved: {name}")
    return int(bool(wrong) or len(result) < LEAST)


if __name__ == "__main__":
    sys.exit(main())
