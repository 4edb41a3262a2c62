"""Where the paper is not confirmed, by weight, computed from the results; notes add what the paper argues."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING

from lyapcheck.answers.gate import accepting, proved_otherwise
from lyapcheck.answers.gate.words import Row, advice
from lyapcheck.certificate import Certificate
from lyapcheck.check.certificate import About
from lyapcheck.check.kinds.all_of import AllOf
from lyapcheck.check.statement import Statement
from lyapcheck.claims.decision import decided, judge_afresh
from lyapcheck.claims.procedures import propose
from lyapcheck.claims.search_result import SearchResult
from lyapcheck.claims.statements import Missing
from lyapcheck.control.conditions import REJECTED, Check
from lyapcheck.files.fields import file_stem
from lyapcheck.report.model import ClaimRow, Finding, Note, applies, behind

if TYPE_CHECKING:
    from lyapcheck.answers.gate.judge import GateResult
    from lyapcheck.claims.handover import Key
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
    result = [*_rejected(gate), *_contradicted(epsilon)]
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


def _rejected(gate: Sequence[GateResult]) -> Iterator[Finding]:
    """Each condition that breaks, at its first joint; and with which others the gate accepts these gains."""
    for result in gate:
        if result.verdict == REJECTED and applies(result):
            broken: dict[str, list[Check]] = {}
            for check in result.failures:
                broken.setdefault(check.id, []).append(check)
            said = [
                advice(result, checks[0]) + (f" (and {len(checks) - 1} more)" if checks[1:] else "")
                for checks in broken.values()
            ]
            if accepting(result):
                proved = proved_otherwise(result)
                said.append(f"{proved[:1].upper()}{proved[1:]}")
            title = f"{result.name} breaks {and_list([f'({name})' for name in broken])}"
            yield Finding("B", f"gains {result.name}", (), _member(result.m), title, ". ".join(said))


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


# --- Witnesses and lists in words.


GRADES = {
    "kernel": "a theorem of Coq's kernel",
    "exact": "rational numbers and symbolic normal forms",
    "enclosure": "balls that enclose the exact numbers",
    "numeric": "floating point, which decides nothing",
}
WHOSE = {
    "quoted": "The paper's own.",
    "implied": "Implied: the paper's argument or its tables rely on it.",
    "ours": "Ours: a further question or a repair. It can be no error of the paper.",
}
MOST_COORDINATES = 3
"""A witness with more coordinates than this is given in the table of claims only."""
LETTERS = {
    "gamma": "γ",
    "rho": "ρ",
    "beta": "β_M",
    "kc": "k_c",
    "eps0": "ε₀",
    "kp": "λmin(K_p)",
    "kp_min": "λmin(K_p)",
    "kv": "λmax(K_v)",
    "b": "λmin(B)",
    "more": "λmax(B) − λmin(B)",
    "share": "ε/ε₀",
    "mu": "M",
    "w": "q̇",
    "eps_h": "εh",
}
OF_JOINTS = {
    "kp": "k_p",
    "kv": "k_v",
    "e": "q̃_",
    "q": "q_",
    "w": "q̇_",
    "x": "x_",
    "c": "c_",
    "abs_g": "size of g_",
    "limit": "τmax_",
}


def and_list(names: Sequence[str]) -> str:
    """``a``, ``a and b``, ``a, b and c``."""
    *most, last = names
    return f"{', '.join(most)} and {last}" if most else last


def member_words(ms: Sequence[int]) -> str:
    """``m = 1, 2``; ``all m`` where it concerns all."""
    return f"m = {', '.join(map(str, ms))}" if ms else "all m"


def witness_words(row: ClaimRow) -> str:
    """Both sides of a refuted relation, in as few digits as tell them apart, and where: for an overview."""
    witness = row.decision.witness or {}
    if "point" not in witness:
        return "; ".join(f"{name}: {value}" for name, value in witness.items())
    point = [f"{name} = {value}" for name, value in witness["point"].items()]
    where = f" at {', '.join(point)}" if 0 < len(point) <= MOST_COORDINATES else ""
    sides = witness["left"], witness["right"]
    words = ([span_words(side, digits) for side in sides] for digits in range(6, 17, 2))
    whole = ["–".join(dict.fromkeys(side)) for side in sides]
    left, right = next((pair for pair in words if pair[0] != pair[1]), whole)
    extra = [f"; {name}: {span_words(witness[name])}" for name in witness if name.endswith("gives it")]
    return f"{_relation(left, witness['operator'], right)}{where}{''.join(extra)}"


def witness_sides(row: ClaimRow) -> str:
    """Both sides of the relation that fails."""
    witness = row.decision.witness or {}
    return _relation(span_words(witness["left"]), witness["operator"], span_words(witness["right"]))


def _relation(left: str, operator: str, right: str) -> str:
    return f"{left} is not {operator.replace('<=', '≤')} {right}"


def span_words(ends: Sequence[str], digits: int = 6) -> str:
    """An enclosure in a few digits; a range where its ends differ by more."""
    short = (f"{float(end):.{digits}g}" for end in ends)
    low, high = (f"−{one[1:]}" if one.startswith("-") else one for one in short)
    return low if low == high else f"{low} to {high}"


def witness_place(row: ClaimRow) -> str:
    """For how many joints, which member and where a claim fails: letters that are 0 are left out."""
    point = (row.decision.witness or {})["point"]
    where = [f"{name} = {value}" for name, value in (("n", row.n), ("m", row.m)) if value]
    where += [f"{_letter(name)} = {_short(value)}" for name, value in point.items() if value != "0"]
    return ", ".join(where)


def _letter(name: str) -> str:
    """A letter of the paper's script as the paper writes it, with the number of its joint."""
    stem = name.rstrip("0123456789")
    if name in LETTERS or stem == name or stem not in OF_JOINTS:
        return LETTERS.get(name, name)
    return f"{OF_JOINTS[stem]}{name[len(stem) :]}"


def _short(value: str) -> str:
    """A rational as a decimal where that is exact and short, else as it is."""
    number = Fraction(value)
    decimal = f"{float(number):.6g}"
    return decimal if "e" not in decimal and Fraction(decimal) == number else value


# --- Claims about the gains at hand: one a gain set, by its name, and of what the gate has judged of it.


CONDITIONS = {"10p.gains": "10p", "19.gains": "19"}
"""Claims that are conditions of the gate."""


def as_the_gate_judges(
    rows: Sequence[ClaimRow], gate: Sequence[GateResult]
) -> tuple[list[ClaimRow], dict[str, str]]:
    """The claims, those of ``CONDITIONS`` once for each gain set of their m, and the certificates of these.

    A script knows one gain set for each m, and the arm at its nominal numbers. The gate knows all sets and
    the limits that count. No page says two things of one set, as its statements are those of the claims.

    Args:
        rows: of the paper's proof.
        gate: what the gate says of each set.
    """
    asked: dict[Key, tuple[ClaimRow, str, Statement | Missing, SearchResult]] = {}
    made: dict[Key, Certificate] = {}
    for row in rows:
        for result in gate:
            if row.id not in CONDITIONS or result.m != row.m or row.m is None:
                continue
            key: Key = f"{row.id}.{file_stem(result.name)}", row.m
            stated = _stated(result, CONDITIONS[row.id])
            finding = propose(stated)
            asked[key] = row, result.name, stated, finding
            if finding.proof is not None and isinstance(stated, Statement):
                about = About(row.id, f"{result.name}: {row.comment}", row.m, row.n, row.proof)
                verdict, grade = finding.verdict.value, finding.grade.label
                made[key] = Certificate(about, stated, verdict, grade, finding.proof)
    judged = judge_afresh(made)
    fresh: dict[tuple[str, int | None], list[ClaimRow]] = {}
    for key, (row, name, stated, finding) in asked.items():
        one = replace(
            row,
            kind=type(stated).__name__,
            broken=(),
            decision=decided(finding, judged.get(key), stated),
            stated=stated,
            seconds=0.0,
            certificate=_path(key) if key in made else None,
            digest=made[key].digest if key in made else None,
            gains=name,
        )
        fresh.setdefault((row.id, row.m), []).append(one)
    every: list[ClaimRow] = []
    for row in rows:
        some = fresh.get((row.id, row.m))
        if some is None or some[0] not in every:
            every += some or [row]
    return every, {_path(key): one.text() for key, one in made.items()}


def _stated(result: GateResult, condition: str) -> Statement | Missing:
    """What the gate judged, all joints together."""
    checks = [check for check in result.checks if check.id == condition]
    parts = [(Row(result, one).joint, one.judgement.statement) for one in checks if one.judgement is not None]
    if len(parts) < len(checks) or not parts:
        reasons = [one.reason for one in checks if one.judgement is None]
        return Missing(reasons[0] if reasons else "the gate has not looked at it")
    return AllOf(tuple(parts))


def _path(key: Key) -> str:
    return f"certificates/published/{key[0]}.json"
