"""The report of the refutation suite: one table by kind of fault, one by proof, and what stayed undecided."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable
from pathlib import Path

from lyapcheck.verdicts import Verdict
from tests.refutations.mutations import RULES
from tests.refutations.statements import MEMBER
from tests.refutations.suite import SEED, Outcome, Planted

REPORT = Path(__file__).parents[2] / "reports" / "refutations.md"
AT_RANDOM = REPORT.with_name("statement_fuzz.md")
COLUMNS = (Verdict.REFUTED, Verdict.UNDECIDED, Verdict.PROVED, Verdict.ERROR)
INTRODUCTION = f"""\
A program changes the statements of the proofs in `proofs/` in one place each (m = {MEMBER}, the arm and
gains of the paper). A change counts as a planted fault if an independent evaluation to 60 digits finds
a point at which the changed statement clearly fails (seed {SEED}); changes that leave a statement true, or
not known to be false, are not counted. `proved` must be 0. Written by `python -m tests.refutations`.
"""


def summary(result: list[Outcome]) -> str:
    """One line with the figures."""
    counts = Counter(outcome.verdict for outcome in result)
    verdicts = ", ".join(f"{counts[verdict]} {verdict.value}" for verdict in COLUMNS)
    return f"{len(result)} planted faults that are false: {verdicts}"


def markdown(plan: Planted, result: list[Outcome]) -> str:
    """The whole report."""
    lines = [
        "# Refutation suite",
        "",
        summary(result) + ".",
        "",
        *INTRODUCTION.splitlines(),
        "",
        f"Beside them, [statements at random]({AT_RANDOM.name}) and not near any shipped one: {_at_random()}",
        "",
        "## By kind of fault",
        "",
        *_table("fault", RULES, result, lambda o: o.fault.kind, plan.others),
        "",
        "## By proof",
        "",
        *_table("proof", _proofs(result), result, lambda o: o.fault.part.proof, None),
        "",
        "## By kind of statement",
        "",
        *_table("statement", _kinds(result), result, _kind, None),
        "",
        *_listed("Undecided", [o.fault.name for o in result if o.verdict is Verdict.UNDECIDED]),
        *_listed("False as they stand in the proofs, so not changed", plan.broken),
        *_listed("No numbers to judge them by, so not changed", plan.unjudged),
    ]
    return "\n".join(lines).rstrip("\n") + "\n"


def _at_random() -> str:
    """The counts of the last run of the fuzzer, as its own page has them."""
    return AT_RANDOM.read_text(encoding="utf-8").splitlines()[2]


def _table(
    title: str,
    rows: Iterable[str],
    result: list[Outcome],
    key: Callable[[Outcome], str],
    others: Counter[str] | None,
) -> list[str]:
    counts = Counter((key(outcome), outcome.verdict) for outcome in result)
    more = ["not known to be false"] if others is not None else []
    heads = [title, "false", *(verdict.value for verdict in COLUMNS), *more]
    lines = [_row(heads), _row(["---"] + ["---:"] * (len(heads) - 1))]
    for row in rows:
        cells = [counts[row, verdict] for verdict in COLUMNS]
        tail = [others[row]] if others is not None else []
        lines.append(_row([row, sum(cells), *cells, *tail]))
    return lines


def _row(cells: list[object] | list[str]) -> str:
    return "| " + " | ".join(map(str, cells)) + " |"


def _kind(outcome: Outcome) -> str:
    return type(outcome.fault.statement).__name__


def _kinds(result: list[Outcome]) -> list[str]:
    return sorted({_kind(outcome) for outcome in result})


def _proofs(result: list[Outcome]) -> list[str]:
    return sorted({outcome.fault.part.proof for outcome in result})


def _listed(title: str, names: Iterable[str]) -> list[str]:
    items = [f"- {name}" for name in names]
    return [f"## {title}", "", *items, ""] if items else []
