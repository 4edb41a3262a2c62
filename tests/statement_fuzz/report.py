"""The figures of a run as a page."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from lyapcheck.check.codec import members
from lyapcheck.check.statement import Statement
from tests.statement_fuzz.generators import names
from tests.statement_fuzz.judge import VERDICTS, Judged
from tests.statement_fuzz.proposed import Proposed
from tests.statement_fuzz.run import Recorded, Run, Tally

INTRODUCTION = """\
A program writes statements of the kinds that users write, many of them false or undefined somewhere,
and decides them. An oracle that shares no code with lyapcheck looks for a point at which a proved
statement fails or a term of it is undefined, and replays every counterexample. A fault is: proved with
such a point, or though false by construction; refuted by a point that is none, or though true by
construction; an exception. Where a row counts what is undecided and not true, the oracle was also asked of
statements that stay undecided. Kinds that begin with `By`, and `Altered`, are proofs put to statements that
they were not made for. Written by `python -m tests.statement_fuzz`.
"""


def markdown(runs: Sequence[Run]) -> str:
    """The whole page."""
    tally = sum((one.tally for one in runs), Tally())
    lines = [
        "# Statements at random",
        "",
        summary(tally),
        "",
        *INTRODUCTION.splitlines(),
        "",
        "## Runs",
        "",
        *_runs(runs),
        "",
        *_gone(tally),
    ]
    lines += ["## By kind of statement", "", *_table(tally), "", "## By family", "", *_families(tally), ""]
    if tally.faults:
        lines += ["## Faults", "", *(_fault(*one) for one in tally.faults[:200]), ""]
    return "\n".join(lines).rstrip("\n") + "\n"


def _fault(index: int, fault: Judged | Recorded) -> str:
    """What was wrong; of a fault of an earlier run also what has become of its statement."""
    return f"- {index}: {fault.text()}" + (f"\n  {fault.now()}" if isinstance(fault, Recorded) else "")


def _runs(runs: Sequence[Run]) -> list[str]:
    """What each run judged, and by which checkers, as the SHA-256 of their sources begins."""
    lines = [
        _row(["seed", "statements of", *VERDICTS, "faults", "checker"]),
        _row(["---:", "---", *["---:"] * (len(VERDICTS) + 1), "---"]),
    ]
    for one in runs:
        counts = _by_verdict(one.tally)
        checkers = ", ".join(f"{count} by {digest}" for digest, count in one.tally.checkers.items())
        cells = [counts[verdict] for verdict in VERDICTS]
        lines.append(_row([one.seed, one.only or "all kinds", *cells, len(one.tally.faults), checkers]))
    return lines


def _gone(tally: Tally) -> list[str]:
    """Which kinds were deleted since, and which statements were judged by none but earlier checkers."""
    kinds = {kind for kind, _ in tally.verdicts}
    today = {*members(Statement), *(cls.__name__ for cls in Proposed.__subclasses__())}
    parts = []
    if kinds - today:
        parts.append(f"No kinds of today, counted by earlier checkers: {', '.join(sorted(kinds - today))}.")
    if len(tally.checkers) > 1 and (missing := sorted({*names()} - kinds)):
        parts.append(f"Written today, and not at all in this run: {', '.join(missing)}.")
    return [*parts, ""] if parts else []


def summary(tally: Tally) -> str:
    """One line with the figures."""
    counts = _by_verdict(tally)
    verdicts = ", ".join(f"{counts[verdict]} {verdict}" for verdict in VERDICTS if counts[verdict])
    return f"{tally.statements} statements: {verdicts}; {len(tally.faults)} faults."


def _by_verdict(tally: Tally) -> Counter[str]:
    counts: Counter[str] = Counter()
    for (_, verdict), count in tally.verdicts.items():
        counts[verdict] += count
    return counts


def _table(tally: Tally) -> list[str]:
    faults = Counter(judged.kind for _, judged in tally.faults)
    kinds = sorted({kind for kind, _ in tally.verdicts})
    lines = [
        _row(["statement", "decided", *VERDICTS, "faults"]),
        _row(["---", *["---:"] * (len(VERDICTS) + 2)]),
    ]
    for kind in kinds:
        cells = [tally.verdicts[kind, verdict] for verdict in VERDICTS]
        lines.append(_row([kind, sum(cells), *cells, faults[kind]]))
    return lines


def _families(tally: Tally) -> list[str]:
    rows = sorted({(kind, family) for kind, family, _ in tally.families})
    lines = [_row(["statement", "family", *VERDICTS]), _row(["---", "---", *["---:"] * len(VERDICTS)])]
    for kind, family in rows:
        lines.append(_row([kind, family, *(tally.families[kind, family, verdict] for verdict in VERDICTS)]))
    return lines


def _row(cells: list[object]) -> str:
    return "| " + " | ".join(map(str, cells)) + " |"
