"""``lyapcheck report``."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

from lyapcheck.cli.arm import require_joints, robot_name
from lyapcheck.cli.progress import progress
from lyapcheck.errors import argument_error
from lyapcheck.output.escapes import document_text
from lyapcheck.verdicts import Exit

if TYPE_CHECKING:
    from lyapcheck.cli.parser import Parser
    from lyapcheck.report.build import Subject
    from lyapcheck.report.model import Report

_MOST_MEMBERS = 20
_PRINT = (
    "write html and print it, its pages are made for paper: "
    "chromium --headless --print-to-pdf=report.pdf reports/index.html, or print from any browser"
)


def arguments(parser: Parser) -> None:
    """What the command takes."""
    about = "Members of the family: 1 2 3, 1,2,5 or 1:12."
    parser.add_argument("--m", metavar="M", nargs="+", default=["1:3"], help=f"{about} [1:3]")
    parser.add_argument("--robot", metavar="ROBOT", help="A built-in arm or an arm file.")
    about = "A gain file; the paper's Table 2 and its PD baseline if missing."
    parser.add_argument("--gains", metavar="FILE", type=Path, help=about)
    about = "The folder to write to."
    parser.add_argument("--out", metavar="DIR", type=Path, default=Path("reports"), help=about)
    about = "Which of html, md and json, separated by commas."
    parser.add_argument("--format", metavar="FORMATS", default="html,md,json", help=about)


def run(
    m: list[str],
    robot: str | None,
    gains: Path | None,
    out: Path,
    format: str,  # noqa: A002
) -> Exit:
    """Check proof, gains and closed loop for each m and write it all up in a folder.

    Without arguments: the paper's arm and gains for m = 1, 2, 3, into reports/. Exit code 0 when the report
    is written, whatever it says; 2: unusable input.

    Examples:
      lyapcheck report
      lyapcheck report --m 1 2 --robot arm.urdf --gains gains.toml --out reports/arm
    """
    from lyapcheck.report.write import render, require_folder, write

    formats = _formats(format)
    require_folder("--out", out)
    subject = _subject(",".join(m), robot, gains)
    from lyapcheck.report.build import build

    with progress("report") as advance:
        report = build(subject, advance)
    write(render(report, formats), out)
    sys.stdout.write(document_text(_summary(report, out, formats)))
    return Exit.PROVED


def _formats(text: str) -> tuple[str, ...]:
    from lyapcheck.report.write import FORMATS

    wanted = tuple(dict.fromkeys(part.strip() for part in text.split(",")))
    unknown = [part for part in wanted if part not in FORMATS]
    if "pdf" in unknown:
        raise argument_error("--format", text, "PDF is not written", _PRINT)
    if unknown:
        known = ", ".join(FORMATS)
        raise argument_error("--format", text, f"{unknown[0]!r} is not a format", f"choose from {known}")
    return wanted


def _subject(m: str, robot: str | None, gains: Path | None) -> Subject:
    """What the arguments ask for, or every problem with it."""
    from lyapcheck.cli.m_range import parse_m
    from lyapcheck.control.gains import read_gain_file
    from lyapcheck.control.paper import paper_gain_file
    from lyapcheck.report.build import Subject
    from lyapcheck.robots import load

    members = tuple(parse_m(",".join(m.replace(",", " ").split())))
    if len(members) > _MOST_MEMBERS:
        rule = f"a report covers at most {_MOST_MEMBERS} members"
        raise argument_error("--m", m, rule, "ask for fewer, or run it several times with --out")
    chosen = [gains] if gains else [paper_gain_file("table2"), paper_gain_file("table2_pd")]
    files = tuple(read_gain_file(path) for path in chosen)
    arm = robot_name(robot, files)
    require_joints(files, load(arm))
    return Subject(arm, members, files)


def _summary(report: Report, out: Path, formats: tuple[str, ...]) -> str:
    """What was found, in a few lines, and where to read it."""
    first = {"html": "index.html", "md": "report.md", "json": "report.json"}
    counts = ", ".join(f"{count} {verdict}" for verdict, count in report.counts().items() if count)
    lines = [f"claims: {counts}"]
    lines += [f"gains {row['name']}: {row['verdict']}" for row in report.gate]
    lines += [f"findings: {len(report.findings)} places where the paper is not confirmed"]
    lines += [f"written: {out / first[name]}" for name in formats]
    return "\n".join(lines) + "\n"
