"""Where the paper is not confirmed, by weight, computed from the results; notes add what the paper argues."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from lyapcheck.answers.gate.words import advice
from lyapcheck.control.conditions import REJECTED
from lyapcheck.report.claim_row import ClaimRow
from lyapcheck.report.experiment import (
    answer_words,
    beside_words,
    hangs_words,
    quantity_words,
    together_words,
)
from lyapcheck.report.model import Finding, WitnessRow, applies, behind
from lyapcheck.report.notes import Note
from lyapcheck.report.text import witness_words

if TYPE_CHECKING:
    from lyapcheck.answers.gate.judge import GateResult
    from lyapcheck.claims.smallest import RefutedBelow
    from lyapcheck.report.experiment import NumberRow, StudyRow
    from lyapcheck.report.model import EpsilonRow
    from lyapcheck.report.notes import Notes

SAME = 0.02
"""An index of the nominal arm this close to the printed one, relatively, counts as confirmed."""
LIGHTER = {"Section 4": "C", "Section 5": "D"}
"""What a refuted claim weighs in parts of the paper on which the proof does not rest; elsewhere ``B``.

One that no sentence of the paper makes weighs ``E``.
"""
Small = Mapping[str, WitnessRow]


def findings(
    notes: Notes,
    claims: Sequence[ClaimRow],
    small: Small,
    epsilon: Sequence[EpsilonRow] = (),
    sensitivity: StudyRow | None = None,
) -> tuple[Finding, ...]:
    """About the paper: refuted claims by weight, ε₀ that (18) allows and a state refutes, the experiment.

    A refuted claim breaks the proof if the proposition rests on it.
    """
    result = [*_refuted(notes, claims, small), *_contradicted(epsilon)]
    if sensitivity is not None:
        result += _experiment(sensitivity)
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


def _refuted(notes: Notes, claims: Sequence[ClaimRow], small: Small) -> Iterator[Finding]:
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
        if not seen and not (note.ask and any(name in small for name in note.claims)):
            continue
        done.update(names)
        weight = "A" if carrying & set(names) else _lighter(seen)
        yield _finding(weight, names or note.claims, seen, note, small)
    for name, rows in refuted.items():
        if name not in done:
            weight = "A" if name in carrying else _lighter(rows)
            yield _finding(weight, (name,), rows, Note((name,), rows[0].comment), small)


def _finding(
    weight: str, names: tuple[str, ...], rows: Sequence[ClaimRow], note: Note, small: Small
) -> Finding:
    own = next((small[name] for name in names if name in small), None)
    witness = own or _ordinary(min(rows, key=_length))
    return Finding(
        weight=weight,
        subject=f"claim {names[0]}",
        claims=names,
        ms=_ms(rows) if rows else (note.ask["m"],),
        title=note.title,
        text=witness_words(rows[0]) if rows else "",
        printed=note.printed,
        argument=note.argument,
        fails=note.fails,
        consequence=note.consequence,
        repair=note.repair,
        mended=note.mended,
        witness=witness,
        figure=(own.figure if own else "") or note.figure,
    )


def _lighter(rows: Sequence[ClaimRow]) -> str:
    if rows and all(row.stands == "ours" for row in rows):
        return "E"
    parts = (weight for part, weight in LIGHTER.items() if rows and rows[0].section.startswith(part))
    return next(parts, "B")


def _ms(rows: Sequence[ClaimRow]) -> tuple[int, ...]:
    return tuple(sorted({row.m for row in rows if row.m is not None}))


def light(own: RefutedBelow) -> WitnessRow:
    """A small witness as findings show it."""
    data = own.data
    sides = tuple(data["left"]), data["operator"], tuple(data["right"])
    return WitnessRow(own.m, own.n, data["point"], *sides, small_path(own.id), True, sides_name(own))


def sides_name(own: RefutedBelow) -> str:
    """The drawing of both sides; empty where no letter is worth moving."""
    return f"sides_{own.id.replace('.', '_')}" if own.moved else ""


def _length(row: ClaimRow) -> int:
    """Of the numbers of a witness, written out: the roundest is the shortest."""
    return sum(map(len, (row.decision.witness or {}).get("point", {}).values()))


def small_path(claim: str) -> str:
    """Where the certificate of a small witness stands in a report."""
    return f"certificates/small/{claim}.json"


def _ordinary(row: ClaimRow) -> WitnessRow | None:
    data = row.decision.witness
    if data is None or "point" not in data:
        return None
    sides = tuple(data["left"]), data["operator"], tuple(data["right"])
    return WitnessRow(row.m, row.n, data["point"], *sides, row.certificate, False, "")


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


def _experiment(study: StudyRow) -> Iterator[Finding]:
    """What the bench does with the nominal arm, and whether any assumed arm does what is printed."""
    for one in study.sets:
        for number in one.numbers:
            text = _apart(number, study)
            if text:
                subject = f"{quantity_words(number)} of {one.name}"
                yield Finding("D", subject, (), _member(one.m), subject, text)
    if study.together and study.together.worst > SAME:
        subject = "indices of all gains"
        yield Finding("D", subject, (), (), subject, together_words(study, study.together))


def _apart(number: NumberRow, study: StudyRow) -> str:
    """Empty where the nominal arm is near what is printed, and for torques: these are claims of the paper."""
    if number.quantity == "L2" and abs((number.nominal or 0.0) / number.printed - 1) > SAME:
        return f"{beside_words(number)}; {hangs_words(number, study)}; {answer_words(number)}"
    if number.quantity in ("settling", "final_error") and number.answer == "no":
        return f"{beside_words(number)}; {answer_words(number)}"
    return ""
