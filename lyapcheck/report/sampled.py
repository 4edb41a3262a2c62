"""The loop on a computer in a report: a tile, and a card with what its claims suppose."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from lyapcheck.check.kinds.sampled import SampledStable
from lyapcheck.files.decimals import decimal_text
from lyapcheck.output.document import Bullets, Paragraph, Section, Table
from lyapcheck.promise import all_say
from lyapcheck.report.claim_row import ClaimRow
from lyapcheck.report.jobs import SAMPLED
from lyapcheck.report.model import Report
from lyapcheck.report.text import and_list
from lyapcheck.verdicts import Verdict


def sampled_rows(report: Report, *, members: bool = False) -> list[ClaimRow]:
    """The claims, or only those about a member as the paper ran it."""
    names = {f"sampled.m{m}" for m in report.ms}
    rows = [row for row in report.others if row.proof == Path(SAMPLED).stem]
    return [row for row in rows if row.id in names] if members else rows


def sampled_word(report: Report) -> tuple[str, bool] | None:
    """For which m it is proved as it was run, and whether for all; ``None`` without such claims."""
    rows = sampled_rows(report, members=True)
    shown = [row for row in rows if row.verdict is Verdict.PROVED]
    left = [row for row in rows if row not in shown]
    asked = [row.promise.asked for row in shown if row.promise is not None]
    periods = {f" at {decimal_text(1000 * one.period)} ms" for one in asked if isinstance(one, SampledStable)}
    promises, end = [row.promise for row in shown], f"{' and'.join(sorted(periods))} under suppositions"
    parts = [all_say(promises, f"{_members(shown)}: stable{end}")] if shown else []
    parts += [f"{_members(left)}: open"] if left else []
    return ("; ".join(parts), not left) if rows else None


def _members(rows: list[ClaimRow]) -> str:
    return f"m = {and_list([row.id.removeprefix('sampled.m') for row in rows])}"


def sampled_section(report: Report) -> Iterator[Section]:
    """Each claim and what became of it, and what all of them suppose."""
    rows = sampled_rows(report)
    if not rows:
        return
    first = next((row for row in rows if row.granted), rows[0])
    became = ("; ".join(filter(None, (row.word, row.reason))) for row in rows)
    table = tuple((row.id, f"“{row.comment}”", word) for row, word in zip(rows, became, strict=True))
    words = (
        "The theorem is about a torque that changes all the time; a computer holds it between readings. "
        "These claims are about gains of Table 2, with the friction and gravity that are printed, and any "
        f"inertia. They suppose, here {first.id}:"
    )
    blocks = (
        Paragraph(words),
        Bullets(first.granted),
        Table(("claim", "the author's words", "became"), table, align="lll"),
    )
    yield Section("On the computer that runs it", blocks)
