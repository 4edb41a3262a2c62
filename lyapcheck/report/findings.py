"""Where the paper is not confirmed, by weight, computed from the results; notes add what the paper argues."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from typing import TYPE_CHECKING

from lyapcheck.answers.gate.words import advice
from lyapcheck.control.conditions import REJECTED
from lyapcheck.report.model import ClaimRow, Finding, Note, applies, behind
from lyapcheck.report.text import witness_words

if TYPE_CHECKING:
    from lyapcheck.answers.gate.judge import GateResult
    from lyapcheck.report.model import EpsilonRow, Notes

LIGHTER = {"Section 4": "C", "Section 5": "D"}
"""What a refuted claim weighs in parts of the paper on which the proof does not rest; elsewhere ``B``.

One that no sentence of the paper makes weighs ``E``.
"""


def findings(
    notes: Notes, claims: Sequence[ClaimRow], epsilon: Sequence[EpsilonRow] = ()
) -> tuple[Finding, ...]:
    """About the paper: refuted claims by weight, and ε₀ that (18) allows and a state refutes.

    A refuted claim breaks the proof if the proposition rests on it.
    """
    result = [*_refuted(notes, claims), *_contradicted(epsilon)]
    return tuple(sorted(result, key=lambda finding: finding.weight))


def own_findings(
    gate: Sequence[GateResult], epsilon: Sequence[EpsilonRow], claims: Sequence[ClaimRow]
) -> tuple[Finding, ...]:
    """About an arm and gains: conditions that are not met, and Properties that the arm lacks."""
    stable = {row.name for row in epsilon if row.certified is not None}
    result = [*_rejected(gate, stable), *_contradicted(epsilon)]
    for row in claims:
        if row.verdict == "refuted" and row.section.startswith("Section 2"):
            text = witness_words(row)
            result.append(Finding("A", f"claim {row.id}", (row.id,), _ms([row]), row.comment, text))
    return tuple(sorted(result, key=lambda finding: finding.weight))


def _refuted(notes: Notes, claims: Sequence[ClaimRow]) -> Iterator[Finding]:
    """One finding a note with refuted claims, and one a refuted claim without a note."""
    refuted: dict[str, list[ClaimRow]] = {}
    for row in claims:
        if row.verdict == "refuted":
            refuted.setdefault(row.id, []).append(row)
    carrying = behind(notes.paper.theorem, claims)
    done: set[str] = set()
    for note in notes.findings:
        names = tuple(name for name in note.claims if name in refuted)
        seen = [row for name in names for row in refuted[name]]
        if not seen:
            continue
        done.update(names)
        weight = "A" if carrying & set(names) else _lighter(seen)
        yield _finding(weight, names, seen, note)
    for name, rows in refuted.items():
        if name not in done:
            weight = "A" if name in carrying else _lighter(rows)
            yield _finding(weight, (name,), rows, Note((name,), rows[0].comment))


def _finding(weight: str, names: tuple[str, ...], rows: Sequence[ClaimRow], note: Note) -> Finding:
    # the roundest numbers are the shortest
    shortest = min(
        rows, key=lambda row: sum(map(len, (row.decision.witness or {}).get("point", {}).values()))
    )
    return Finding(
        weight=weight,
        subject=f"claim {names[0]}",
        claims=names,
        ms=_ms(rows),
        title=note.title,
        text=witness_words(rows[0]),
        note=note,
        witness=shortest if "point" in (shortest.decision.witness or {}) else None,
    )


def _lighter(rows: Sequence[ClaimRow]) -> str:
    if rows and all(row.stands == "ours" for row in rows):
        return "E"
    parts = (weight for part, weight in LIGHTER.items() if rows[0].section.startswith(part))
    return next(parts, "B")


def _ms(rows: Sequence[ClaimRow]) -> tuple[int, ...]:
    return tuple(sorted({row.m for row in rows if row.m is not None}))


def _rejected(gate: Sequence[GateResult], stable: Collection[str]) -> Iterator[Finding]:
    """What breaks; where that is (19) alone and stability is proved, the gate that asks for the proof."""
    for result in gate:
        broken = result.failures
        if result.verdict == REJECTED and applies(result):
            first, rest = advice(result, broken[0]), len(broken) - 1
            more = f" (and {rest} more)" if rest else ""
            title = f"{result.name} breaks ({broken[0].id})"
            if result.name in stable and {check.id for check in broken} == {"19"}:
                more += (
                    ". (19) is only sufficient, and dV/dt < 0 has a proof for these gains: "
                    "lyapcheck gate --condition 10p --condition global asks for that proof instead"
                )
            yield Finding("B", f"gains {result.name}", (), _member(result.m), title, first + more)


def _contradicted(epsilon: Sequence[EpsilonRow]) -> Iterator[Finding]:
    for row in epsilon:
        published, falsified = row.published, row.falsified
        if published is not None and falsified is not None and float(published) > float(falsified):
            text = (
                f"(18) allows ε₀ up to {float(published):.4g}, but dV/dt > 0 at a state found for "
                f"ε₀ = {float(falsified):.4g}"
            )
            title = f"(18) allows an ε₀ for {row.name} that a state refutes"
            yield Finding("A", f"ε₀ of {row.name}", (), _member(row.m), title, text)


def _member(m: int | None) -> tuple[int, ...]:
    return () if m is None else (m,)
