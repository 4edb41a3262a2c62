"""``lyapcheck report``."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

from lyapcheck.cli.show import open_folder, progress
from lyapcheck.cli.values import parse_m, require_joints, robot_name
from lyapcheck.errors import argument_error
from lyapcheck.output.document import Bullets, Document, Table, command
from lyapcheck.output.escapes import document_text
from lyapcheck.verdicts import Exit

if TYPE_CHECKING:
    from lyapcheck.cli.parser import Parser
    from lyapcheck.report.model import Report, Subject

COMPARED = {"md": "markdown", "json": "json"}
"""The files of a comparison beside its page, by the formats they are in."""
FIRST = {"html": "index.html", "md": "report.md", "json": "report.json", "pdf": "report.pdf"}
"""The file of each format that is read first."""
ORDER = ("good", "warn", "open", "bad")
MOST_ROWS = 12
_MEMBERS = "1:3"
_MOST_MEMBERS = 20


def arguments(parser: Parser) -> None:
    """What the command takes."""
    parser.add_argument("members", metavar="M", nargs="*", help="Orders of h_m, as for --m.")
    about = "Orders of h_m, for example 1 2 3 or 1,2,5 or 1:12. Default: 1:3, or the orders in the gain file."
    parser.add_argument("--m", metavar="M", nargs="+", action="extend", default=[], help=about)
    parser.add_robot("Arm by name or file.")
    about = "Gain file. Default: Table 2 of the paper and its PD baseline."
    parser.add_argument("--gains", metavar="FILE", type=Path, help=about)
    about = "Folder for the report."
    parser.add_argument("--out", metavar="DIR", type=Path, default=Path("reports"), help=about)
    about = "Any of html, md, json and pdf, separated by commas."
    parser.add_argument("--format", metavar="FORMATS", default="html,md,json", help=about)
    about = "Add all claims, gate checks and runs to the PDF."
    parser.add_argument("--appendix", action="store_true", help=about)
    about = "Folder or report.json of an older report. The changes go to compare.html, .md and .json."
    parser.add_argument("--compare", metavar="OLD", type=Path, help=about)
    parser.add_no_store()


def run(
    members: list[str],
    m: list[str],
    robot: str | None,
    gains: Path | None,
    out: Path,
    format: str,  # noqa: A002
    appendix: bool,
    compare: Path | None,
) -> Exit:
    """Check the proof, the gains and the closed loop for each m, and write a report into a folder.

    Without arguments the report is about the paper's arm and gains for m = 1, 2, 3, in reports/. With --robot
    or --gains it is about that arm and those gains only.

    Exit code 0: the report is written, for any verdict, 1: with --compare, a verdict is worse than before, 2:
    unusable input.

    Examples:
      lyapcheck report
      lyapcheck report 1
      lyapcheck report --format html,pdf --compare reports/before
      lyapcheck report --m 1 2 --robot arm.urdf --gains gains.toml --out reports/arm
    """
    from lyapcheck.report.build import FORMATS, build, render, write
    from lyapcheck.report.compare import compare as compared
    from lyapcheck.report.compare import read_report
    from lyapcheck.report.document import ReportAnswer
    from lyapcheck.report.page import compared_page
    from lyapcheck.report.pdf import require_typst
    from lyapcheck.report.tiles import with_before

    formats = tuple(dict.fromkeys(part.strip() for part in format.split(",")))
    for part in formats:
        if part not in FORMATS:
            known = ", ".join(FORMATS)
            raise argument_error("--format", format, f"{part!r} is not a format", f"choose from {known}")
    if "pdf" in formats:
        require_typst()
    old = None if compare is None else read_report(compare)
    subject = _subject(",".join([*m, *members]), robot, gains)
    open_folder("--out", out)
    with progress("report") as advance:
        report = build(subject, advance)
    if old is not None:
        report = with_before(report, old)
    files = render(report, formats, appendix)
    changed = None if old is None else compared(old, ReportAnswer(report).data(), str(compare))
    if changed is not None:
        files |= {f"compare.{end}": changed.written(name) for end, name in COMPARED.items()}
        files["compare.html"] = compared_page(changed.document())
    write(files, out)
    from lyapcheck.output.text import render as text

    sys.stdout.write(document_text(text(_summary(report, subject.robot, out, formats))))
    if changed is None:
        return Exit.PROVED
    sys.stdout.write(f"\n{changed}\n")
    return changed.exit_code


def _subject(m: str, robot: str | None, gains: Path | None) -> Subject:
    """What the arguments ask for, or every problem with it."""
    from lyapcheck.control.gains import arm_named_in, paper_gain_file, read_gain_file
    from lyapcheck.report.model import Subject
    from lyapcheck.robots import load

    chosen = [gains] if gains else [paper_gain_file("table2"), paper_gain_file("table2_pd")]
    files = tuple(read_gain_file(path) for path in chosen)
    own = sorted({item.m for file in files for item in file.gains if gains and item.m is not None})
    asked = m or ",".join(map(str, own)) or _MEMBERS
    members = tuple(parse_m(",".join(asked.replace(",", " ").split())))
    if len(members) > _MOST_MEMBERS:
        rule = f"a report covers at most {_MOST_MEMBERS} members"
        raise argument_error("--m", m, rule, "ask for fewer, or run it several times with --out")
    arm = robot_name(robot, files)
    with arm_named_in(next((file for file in files if file.robot), files[0]), robot):
        model = load(arm)
    require_joints(files, model)
    return Subject(arm, members, files, gains is not None or arm != robot_name(None, files))


def _summary(report: Report, robot: str, out: Path, formats: tuple[str, ...]) -> Document:
    """What was found, the worst first, and where to read it."""
    from lyapcheck.answers import assumed_line
    from lyapcheck.report.model import SIGNS
    from lyapcheck.report.verdict import badges, sentences

    first, *others = badges(report)
    title, left = f"{SIGNS[first.tone]} {first.subject}: {first.word}", others
    if report.own and others:
        worst = max((first, *others), key=lambda badge: ORDER.index(badge.tone))
        title, left = (
            f"{SIGNS[worst.tone]} {len(others) + 1} gain sets on {report.robot.name}",
            [first, *others],
        )
    rows = [(SIGNS[badge.tone], badge.subject, badge.word) for badge in left]
    rows += [
        (SIGNS[tile.tone], tile.subject if len(report.tiles) == 1 else f"{name}: {tile.subject}", tile.number)
        for name, tiles in report.tiles.items()
        for tile in tiles
        if len(report.tiles) == 1 or tile.todo[0]
    ]
    written = [str(out / FIRST[name]) for name in formats]
    remarks = sentences(report) if report.own else ()
    return Document(
        title,
        (
            Table(("", "subject", "result"), tuple(rows[:MOST_ROWS]), align="lll", keys=3),
            Bullets(remarks),
        ),
        lead=(f"open: {', '.join(written)}",),
        assumed=assumed_line(report.robot, robot) if report.own else "",
        next=f"{command('recheck', out)}/certificates" if report.certificates else command("explain"),
    )
