"""A proof result as text, Markdown or JSON."""

from __future__ import annotations

import json
from collections.abc import Callable
from itertools import groupby

from lyapcheck.claims.result import ClaimResult, ProofResult
from lyapcheck.markdown import markdown_table
from lyapcheck.output.escapes import document_text, markdown_text

Renderer = Callable[[ProofResult, bool], str]
SHOWN_COORDINATES = 12


def renderer(name: str) -> Renderer:
    """The function that writes a proof result in a format."""
    return {"text": text, "json": as_json, "markdown": markdown}[name]


def as_json(result: ProofResult, timings: bool = False) -> str:
    """JSON of the schema ``lyapcheck/check/2``."""
    return document_text(json.dumps(result.to_json(timings), indent=2, ensure_ascii=False) + "\n")


def text(result: ProofResult, timings: bool = False) -> str:
    """Plain text: grouped by section, the verdict first, then what supports it."""
    lines = [headline(result), ""]
    for section, rows in groupby(result.claims, key=lambda row: row.section):
        lines += [section or "Claims", ""]
        for row in rows:
            lines += [_line(row, timings), *(f"             {detail}" for detail in details(row))]
        lines.append("")
    return document_text("\n".join([*lines, *assumed(result), tally(result)]) + "\n")


def markdown(result: ProofResult, timings: bool = False) -> str:
    """Markdown: one table a section."""
    lines = [f"# {_shown(result.title)}", "", _shown(headline(result)), ""]
    for section, rows in groupby(result.claims, key=lambda row: row.section):
        cells = [[" ".join(cell.split()) for cell in _cells(row, timings)] for row in rows]
        lines += [f"## {_shown(section or 'Claims')}", "", *markdown_table(_HEADS, cells, words=5), ""]
    return "\n".join([*lines, *map(markdown_text, assumed(result)), tally(result)]) + "\n"


_HEADS = ("claim", "m", "verdict", "grade", "statement", "evidence")


def _cells(row: ClaimResult, timings: bool) -> list[str]:
    evidence = "; ".join([row.decision.method, *details(row)])
    seconds = f" ({row.seconds:.2f} s)" if timings else ""
    member = "" if row.m is None else str(row.m)
    cells = [row.id, member, row.verdict.value, row.decision.grade.label, row.statement]
    return [*cells, evidence + seconds]


def _shown(text: str) -> str:
    """Text on one line, as Markdown."""
    return markdown_text(" ".join(text.split()))


def headline(result: ProofResult) -> str:
    """What was run: the proof, m, n and the robot."""
    arm = f", robot {result.robot}" if result.robot else ""
    return f"{result.title}: m = {', '.join(map(str, result.ms))}, n = {result.n}{arm}"


def assumed(result: ProofResult) -> list[str]:
    """What is taken for granted about the robot, if anything."""
    if not result.assumptions:
        return []
    return [f"Assumed about {result.robot}:", "", *(f"- {line}" for line in result.assumptions), ""]


def tally(result: ProofResult) -> str:
    """How many rows have each verdict."""
    return ", ".join(f"{count} {verdict}" for verdict, count in result.counts().items() if count)


def details(row: ClaimResult) -> list[str]:
    """What supports the verdict: the witness, the reason, the claims that broke it."""
    found = [f"the author's words: “{row.comment}”"]
    witness = row.decision.witness
    if witness is not None:
        found.append(_witness(witness))
    if row.decision.reason:
        found.append(row.decision.reason)
    if row.broken and "rests on" not in row.decision.reason:
        found.append(f"rests on {', '.join(row.broken)}, not proved")
    return found


def _witness(witness: dict[str, object]) -> str:
    point = witness["point"]
    assert isinstance(point, dict)
    shown = [f"{name} = {value}" for name, value in list(point.items())[:SHOWN_COORDINATES]]
    more = [f"and {len(point) - SHOWN_COORDINATES} more"] if len(point) > SHOWN_COORDINATES else []
    sides = f"left {_span(witness['left'])}, not {witness['operator']} right {_span(witness['right'])}"
    extra = [
        f"{name}: {_span(value) if isinstance(value, list) else value}"
        for name, value in witness.items()
        if name not in SIDES
    ]
    return "; ".join(([f"at {', '.join([*shown, *more])}"] if shown else []) + [sides, *extra])


SIDES = ("point", "left", "operator", "right")


def _span(bounds: object) -> str:
    assert isinstance(bounds, list)
    low, high = bounds
    return str(low) if low == high else f"[{low}, {high}]"


def _line(row: ClaimResult, timings: bool) -> str:
    member = f" (m = {row.m})" if row.m is not None else ""
    seconds = f"  {row.seconds:.2f} s" if timings else ""
    grade = f" [{row.decision.grade.label}]" if row.verdict.value != "undecided" else ""
    return f"  {row.verdict.value:<9}  {row.id}{member}{grade}{seconds}  {row.statement}"
