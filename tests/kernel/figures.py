"""Both checkers on every committed certificate; ``make kernel-slow`` writes reports/kernel.md."""

import argparse
from collections import Counter
from dataclasses import replace
from pathlib import Path

from lyapcheck.check.certificate import certificate_of
from lyapcheck.check.recheck import content, gather, recheck
from lyapcheck.kernel import FILE, judged, written
from lyapcheck.kernel.statements import shown
from lyapcheck.kernel.terms import NotPrinted

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "reports" / "kernel.md"
SLOW = 5.0
"""Seconds of computing time from which a certificate has a line of its own."""
LARGE = 8
"""How many of the largest come last, when the rest is written down."""
HEAD = """# Both checkers on every committed certificate

Written by `make kernel-slow`. A certificate has a kernel verdict if the small checker accepts it, and Coq's
kernel a theorem printed from its data, on golden axioms; [what that means](../docs/kernel.md). Seconds are
computing time of Coq.

"""


def one_each(outcome):
    """A certificate for each proposition that is printed; for what is not printed one a file."""
    found = {}
    for one in outcome.checked:
        certificate, _ = certificate_of(content(one.document.path))
        try:
            found.setdefault(shown(certificate.statement, certificate.proof, certificate.verdict), one)
        except NotPrinted:
            found[str(one.document.path)] = one
    return found


def page(results, files, left):
    """The page, line by line."""
    accepted = [one for one in results if one.accepted]
    by_list = Counter(one.axioms for one in accepted)
    lists = ", ".join(f"{count} on the list {name}" for name, count in sorted(by_list.items()))
    yield f"{files} certificates, all accepted by the small checker. "
    yield f"Coq was asked about {len(results)} statements, "
    yield f"all but {left} of the largest certificates (`--small`); " if left else "all that they have; "
    yield f"its kernel accepts {len(accepted)} of these ({lists}).\n"
    slow = sorted((one for one in accepted if one.seconds > SLOW), key=lambda one: -one.seconds)
    if slow:
        yield f"\n| certificate | over {SLOW:g} s |\n|---|---:|\n"
        yield from (f"| {Path(one.file).name} | {one.seconds:.0f} s |\n" for one in slow)
    yield "\n## What Coq does not take\n\n| why | statements | for instance |\n|---|---:|---|\n"
    reasons = Counter(one.reason for one in results if not one.accepted)
    for reason, count in reasons.most_common():
        first = next(one.file for one in results if one.reason == reason)
        yield f"| {reason.replace('|', '∣')} | {count} | {Path(first).name} |\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--folder", type=Path, required=True, help="where the files for Coq go")
    parser.add_argument("--seconds", type=int, default=1800, help="the most that one theorem may take")
    parser.add_argument(
        "--small", action="store_true", help=f"leave out the {LARGE} largest, which take long"
    )
    asked = parser.parse_args()
    folders = [*sorted((ROOT / "reports" / "certificates").iterdir()), ROOT / "tests/kernel/certificates"]
    outcome = recheck(gather(folders))
    refused = [f"{one.file}: {one.reason}" for one in outcome.checked if not one.accepted]
    if refused:
        print("\n".join(refused))
        return 1
    chosen = sorted(one_each(outcome).values(), key=lambda one: one.document.path.stat().st_size)
    results = []
    parts = [slice(0, -LARGE)] if asked.small else [slice(0, -LARGE), slice(-LARGE, None)]
    for part in parts:
        results += judged(
            replace(outcome, checked=tuple(chosen[part])), asked.folder.absolute(), asked.seconds, print
        )
        PAGE.write_text(
            HEAD + "".join(page(results, len(outcome.checked), len(chosen) - len(results))), encoding="utf-8"
        )
        FILE.write_text(written(results), encoding="utf-8")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
