"""The report as a document, for Markdown, paper and whatever else answers are written in."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict, replace
from itertools import groupby
from pathlib import Path
from typing import Any

from lyapcheck.errors import argument_error
from lyapcheck.output.answer import Answer
from lyapcheck.output.document import Block, Bullets, Document, Paragraph, Section, Table
from lyapcheck.output.typst import markup
from lyapcheck.process_tree import temporary_folder
from lyapcheck.report.evidence import evidence, figure, four_epsilons, known, rests
from lyapcheck.report.model import SIGNS, WEIGHTS, Finding, Report
from lyapcheck.report.text import SYMBOLS, and_list, member_words, witness_place, witness_sides
from lyapcheck.report.verdict import badges, chain, route, sampled_section, sentences
from lyapcheck.robots import RobotModel


class ReportAnswer(Answer):
    """A report in every format that answers have.

    Args:
        report: what it says.
        appendix: whether claims, gate and runs are listed one by one.
    """

    schema = "lyapcheck/report/2"

    def __init__(self, report: Report, appendix: bool = True) -> None:
        self.report = report
        self.appendix = appendix

    def document(self) -> Document:
        """The verdict, findings by weight, ε₀; then, as an appendix, everything else."""
        report = self.report
        subject = f"gains on {report.robot.name}" if report.own else report.notes.paper.title
        blocks = (
            *_front(report),
            *_findings(report),
            *by_size(report),
            *sampled_section(report),
            Section("ε₀ from both sides", tuple(four_epsilons(report))),
            report.derived.section(),
            *((Section("Claims", tuple(_claims(report))), *evidence(report)) if self.appendix else ()),
            *known(report),
            *rests(report),
        )
        return Document(f"Proof check: {subject}", blocks)

    def data(self) -> dict[str, Any]:
        """Everything but the drawings, and the certificates by their paths alone."""
        report = self.report
        return {
            "m": list(report.ms),
            "own": report.own,
            "paper": None if report.own else report.notes.paper.citation,
            "robot": _robot(report.robot),
            "verdict": [{"subject": b.subject, "word": b.word, "tone": b.tone} for b in badges(report)],
            "sentences": list(sentences(report)),
            "counts": report.counts(),
            "errors": report.errors(),
            "by_n": [row.data() for row in report.by_size],
            "findings": [_found(finding) for finding in report.findings],
            "table": report.table.data()["rows"],
            "derive": report.derived.data(),
            "tiles": [
                {
                    "gains": name,
                    "subject": one.subject,
                    "number": one.number,
                    "text": one.text,
                    "tone": one.tone,
                }
                for name, known in report.tiles.items()
                for one in known
            ],
            "gate": report.gate.data()["results"],
            "epsilon": [plain(row) for row in report.epsilon],
            "claims": [row.data() for row in report.claims],
            "others": [row.data() for row in report.others],
            "runs": [vars(row) for row in report.runs],
            "sensitivity": None,  # of the printed experiment, whose study left with 0.1.0: keys stay
            "figures": sorted(report.figures),
            "certificates": sorted(report.certificates),
            "software": dict(report.versions),
            "seed": report.seed,
        }

    def records(self) -> Sequence[dict[str, Any]]:
        """A row a claim."""
        keys = ("proof", "id", "m", "n", "stands", "verdict", "grade", "comment")
        rows = [{key: getattr(row, key) for key in keys} for row in self.report.every_claim]
        return [
            data | {"verdict": row.decision.word}
            for data, row in zip(rows, self.report.every_claim, strict=True)
        ]


def plain(row: Any) -> dict[str, Any]:
    """The fields of a row by their names; a promise is in words, not in data."""
    if not hasattr(row, "promise"):
        return asdict(row)
    data = asdict(replace(row, promise=None))
    del data["promise"]
    return data


def _found(finding: Finding) -> dict[str, Any]:
    """A finding with the keys that it had when witnesses were searched for as small as they are."""
    data = plain(finding)
    witness = data["witness"] and data["witness"] | {"small": False, "figure": ""}
    return data | {"witness": witness}


def _robot(model: RobotModel) -> dict[str, Any]:
    return {
        "name": model.name,
        "title": model.title,
        "joints": list(model.joints),
        "numbers": [
            {"name": name, "value": str(number.value), "unit": number.unit, "source": number.source}
            for name, number in model.numbers.items()
        ],
        "assumptions": list(model.assumptions),
    }


def _front(report: Report) -> Iterator[Block]:
    if not report.own:
        yield Paragraph(f"{report.notes.paper.citation}.")
    yield Bullets(tuple(f"{badge.subject}: {badge.word}" for badge in badges(report)))
    yield from map(Paragraph, sentences(report))
    for name, some in report.tiles.items():
        rows = tuple((one.subject, f"{SIGNS[one.tone]} {one.number}", one.text) for one in some)
        yield Table(("question", "answer", "who says so"), rows, name, align="lll")
    if not report.own:
        yield Table(
            ("step", "what it says", "became"),
            tuple((step.box.label, step.box.title, step.word) for step in chain(report)),
            "The printed proof, from left to right",
            align="lll",
        )
        if around := route(report):
            rows = tuple((step.box.label, step.box.title, step.word) for step in around)
            yield Table(("step", "what it says", "became"), rows, "The way round", align="lll")


def _findings(report: Report) -> Iterator[Section]:
    drawn: set[str] = set()
    for weight, words in WEIGHTS.items():
        result = report.weighing(weight)
        if not result:
            continue
        if weight in "ABE":
            blocks: tuple[Block, ...] = tuple(
                Section(one.title, tuple(_card(report, one, drawn))) for one in result
            )
        else:
            blocks = (Bullets(tuple(_line(one) for one in result)),)
        title = "What to mend" if report.own else f"{weight}: {words} ({len(result)})"
        yield Section(title, blocks)


def by_size(report: Report) -> Iterator[Section]:
    """The claims whose verdict changes with the number of joints."""
    if report.by_size:
        ns = list(report.by_size[0].decisions)
        heads = ("claim", "statement", *(f"n = {n}" for n in ns))
        rows = tuple(
            (
                row.id if row.m is None else f"{row.id}, m = {row.m}",
                row.comment,
                *(f"{SYMBOLS[one.verdict]} {one.word}" for one in row.decisions.values()),
            )
            for row in report.by_size
        )
        words = f"Verdicts that change with the number of joints, asked for n = {ns[0]} to {ns[-1]}. "
        words += "All other claims between norms have one verdict for these n."
        yield Section(
            "With the number of joints", (Paragraph(words), Table(heads, rows, align="l" * len(heads)))
        )


def _line(finding: Finding) -> str:
    said = f"“{finding.title}”: " if finding.claims else ""
    ms = f" ({member_words(finding.ms)})" if finding.ms else ""
    return f"{finding.subject}{ms}: {said}{finding.text}"


def _card(report: Report, finding: Finding, drawn: set[str]) -> Iterator[Block]:
    """One finding; a drawing that two of them share stands at the first."""
    if finding.claims:
        row = next((r for r in report.claims if r.id == finding.claims[0]), None)
        says = f": “{row.comment}”" if row else ""
        yield Paragraph(
            f"{and_list([f'claim {name}' for name in finding.claims])}, {member_words(finding.ms)}{says}"
        )
    items = [f"{term}: {text}" for term, text in finding.about.items()]
    if witness := finding.witness:
        items.append(f"Witness: {', '.join(witness_place(witness))}: {witness_sides(witness)}")
    else:
        items.append(finding.text)
    yield Bullets(tuple(items))
    if finding.figure not in drawn:
        yield from figure(report, finding.figure, finding.title)
        drawn.add(finding.figure)


def _claims(report: Report) -> Iterator[Section]:
    for name, group in groupby(report.every_claim, key=lambda row: row.heading):
        lines = []
        for claim, rows in groupby(group, key=lambda row: row.id):
            result = list(rows)
            shown = ", ".join(
                f"{SYMBOLS[row.verdict]} {row.decision.word}" + (f" ({row.about})" if row.about else "")
                for row in result
            )
            if len({row.verdict for row in result}) == 1:
                ms = [str(row.m) for row in result if row.m is not None]
                about = [f"m = {', '.join(ms)}"] if ms else []
                about += [f"n = {result[0].n}"] if result[0].n is not None else []
                shown = f"{SYMBOLS[result[0].verdict]} {result[0].decision.word}"
                shown += f" ({', '.join(about)})" if about else ""
            grades = ", ".join(sorted({row.grade for row in result}))
            lines.append((claim, shown, grades, result[0].comment))
        yield Section(name, (Table(("claim", "verdict", "grade", "statement"), tuple(lines), align="llll"),))


# --- The report on paper: typeset by Typst, which needs no browser.


def require_typst() -> None:
    """Refuse before any work what could not be written at its end.

    Raises:
        InputError: the typesetter is not installed.
    """
    try:
        import typst  # noqa: F401
    except ImportError as error:
        repair = "install it with: pip install lyapcheck[pdf]"
        raise argument_error("--format", "pdf", "needs the package typst", repair) from error


def render(report: Report, appendix: bool = False) -> bytes:
    """A PDF of a few pages; the same report gives the same bytes.

    Args:
        appendix: whether claims, gate and runs follow one by one.
    """
    import typst

    document = ReportAnswer(report, appendix).document()
    running = document.title if report.own else f"{document.title} · {report.notes.paper.source}"
    with temporary_folder() as folder:
        source = Path(folder, "report.typ")
        source.write_text(markup(document, running), encoding="utf-8")
        for name, drawing in report.figures.items():
            if isinstance(drawing, str) and name.endswith(".svg"):
                path = Path(folder, "figures", name)
                path.parent.mkdir(exist_ok=True)
                path.write_text(drawing, encoding="utf-8")
        pages = typst.compile(str(source), root=folder, ignore_system_fonts=True)
    assert isinstance(pages, bytes)
    return pages
