"""The report as a document, for Markdown, paper and whatever else answers are written in."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import groupby
from typing import Any

from lyapcheck.answers.tune.effect import Effect, effect_section
from lyapcheck.kernel.record import GRADE
from lyapcheck.output.answer import Answer
from lyapcheck.output.document import Block, Bullets, Code, Document, Figure, Paragraph, Section, Table
from lyapcheck.report.drawings import file_stem
from lyapcheck.report.model import WEIGHTS, Data, Finding, Report, Witness, applies
from lyapcheck.report.text import (
    SYMBOLS,
    and_list,
    bracket,
    fixed,
    joined,
    letter,
    member_words,
    number,
    short_number,
    span_words,
)
from lyapcheck.report.verdict import badges, chain, route, sentences
from lyapcheck.report.words import (
    answer_cell,
    at_once_words,
    figure_gains_words,
    printed_words,
    quantity_words,
    span,
    tally_words,
    together_words,
    value_words,
)


class ReportAnswer(Answer):
    """A report in every format that answers have.

    Args:
        report: what it says.
        appendix: whether claims, gate, runs and the experiment are listed one by one.
    """

    schema = "lyapcheck/report/2"

    def __init__(self, report: Report, appendix: bool = True) -> None:
        self.report = report
        self.appendix = appendix

    def document(self) -> Document:
        """The verdict, findings by weight, ε₀; then, as an appendix, everything else."""
        report = self.report
        subject = f"gains on {report.robot['name']}" if report.own else report.notes.paper.title
        blocks = (
            *_front(report),
            *_findings(report),
            Section("ε₀ from both sides", tuple(four_epsilons(report))),
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
            "robot": report.robot,
            "verdict": [{"subject": b.subject, "word": b.word, "tone": b.tone} for b in badges(report)],
            "sentences": list(sentences(report)),
            "counts": report.counts(),
            "findings": [_finding_data(finding) for finding in report.findings],
            "table": list(report.table),
            "gate": list(report.gate),
            "epsilon": list(report.epsilon),
            "claims": list(report.claims),
            "others": list(report.others),
            "runs": list(report.runs),
            "sensitivity": report.sensitivity,
            "figures": sorted(report.figures),
            "certificates": sorted(report.certificates),
            "software": dict(report.versions),
            "seed": report.seed,
        }

    def records(self) -> Sequence[Data]:
        """A row a claim."""
        keys = ("proof", "id", "m", "n", "verdict", "grade", "comment")
        return [{key: row[key] for key in keys} for row in self.report.every_claim]


def _finding_data(finding: Finding) -> dict[str, Any]:
    result = {**vars(finding), "claims": list(finding.claims), "ms": list(finding.ms)}
    return result | {"witness": vars(finding.witness) if finding.witness else None}


def _front(report: Report) -> Iterator[Block]:
    if not report.own:
        yield Paragraph(f"{report.notes.paper.citation}.")
    yield Bullets(tuple(f"{badge.subject}: {badge.word}" for badge in badges(report)))
    yield from map(Paragraph, sentences(report))
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
        if weight in "AB":
            blocks: tuple[Block, ...] = tuple(
                Section(one.title, tuple(_card(report, one, drawn))) for one in result
            )
        else:
            blocks = (Bullets(tuple(_line(one) for one in result)),)
        title = "What to mend" if report.own else f"{weight}: {words} ({len(result)})"
        yield Section(title, blocks)


def _line(finding: Finding) -> str:
    said = f"“{finding.title}”: " if finding.claims else ""
    ms = f" ({member_words(finding.ms)})" if finding.ms else ""
    return f"{finding.subject}{ms}: {said}{finding.text}"


def _card(report: Report, finding: Finding, drawn: set[str]) -> Iterator[Block]:
    """One finding; a drawing that two of them share stands at the first."""
    if finding.claims:
        row = next((r for r in report.claims if r["id"] == finding.claims[0]), None)
        says = f": “{row['comment']}”" if row else ""
        yield Paragraph(
            f"{and_list([f'claim {name}' for name in finding.claims])}, {member_words(finding.ms)}{says}"
        )
    about = {
        "The paper argues": finding.argument,
        "Why it fails": finding.fails,
        "Consequence": finding.consequence,
        "Repair": finding.repair,
    }
    items = [f"{term}: {text}" for term, text in about.items() if text]
    items.append(f"Witness: {witness_sentence(finding.witness)}" if finding.witness else finding.text)
    yield Bullets(tuple(items))
    if finding.figure not in drawn:
        yield from _figure(report, finding.figure, finding.title)
        drawn.add(finding.figure)


def witness_sentence(witness: Witness) -> str:
    """Where it fails, and both sides there."""
    where = [f"n = {witness.n}"] if witness.n else []
    where += [f"m = {witness.m}"] if witness.m else []
    where += [
        f"{letter(name)} = {short_number(value)}" for name, value in witness.point.items() if value != "0"
    ]
    sides = (
        f"{span_words(witness.left)} is not {witness.operator.replace('<=', '≤')} {span_words(witness.right)}"
    )
    return f"{', '.join(where)}: {sides}"


def _figure(report: Report, name: str, caption: str) -> Iterator[Figure]:
    if f"{name}.svg" in report.figures:
        yield Figure(f"figures/{name}.svg", caption)


def four_epsilons(report: Report) -> Iterator[Block]:
    """The four ε₀ of each gain set, why one is missing, and their drawing."""
    kinds = ("published", "scalar", "certified", "falsified", "ratio")
    rows = tuple((row["name"], *(row[kind] or "–" for kind in kinds)) for row in report.epsilon)
    heads = ("gains", "published (18)", "scalar", "certified", "falsified", "certified/falsified")
    yield Table(
        heads,
        rows,
        "Published: the end of (18). Scalar: from two norms. Certified: proved on this arm at every state. "
        "Falsified: a state with dV/dt > 0 is known. Certified ≤ true ≤ falsified; rounded to the safe side.",
    )
    missing = [(row["name"], kind, text) for row in report.epsilon for kind, text in row["reasons"].items()]
    if missing:
        yield Bullets(tuple(f"{name}, no {kind} ε₀: {text}" for name, kind, text in missing))
    yield from _figure(report, "epsilon", "The four ε₀ of each gain set")


def evidence(report: Report) -> Iterator[Section]:
    """Constants, gate, runs and the printed experiment."""
    yield Section("The family and its constants", tuple(_constants(report)))
    yield Section("The gate", tuple(_gate(report)))
    yield Section("The closed loop", tuple(_runs(report)))
    yield from _members(report)
    if report.sensitivity:
        yield Section("The printed experiment and what is assumed", tuple(_study(report, report.sensitivity)))


def _claims(report: Report) -> Iterator[Section]:
    def title(row: Data) -> str:
        section = row["section"] or "Claims"
        return section if row["proof"] == "published" else f"{row['proof']}.py: {section}"

    for name, group in groupby(report.every_claim, key=title):
        lines = []
        for claim, rows in groupby(group, key=lambda row: row["id"]):
            result = list(rows)
            shown = ", ".join(
                f"{SYMBOLS[row['verdict']]} {row['verdict']}" + (f" (m = {row['m']})" if row["m"] else "")
                for row in result
            )
            if len({row["verdict"] for row in result}) == 1:
                ms = [str(row["m"]) for row in result if row["m"] is not None]
                shown = f"{SYMBOLS[result[0]['verdict']]} {result[0]['verdict']}" + (
                    f" (m = {', '.join(ms)})" if ms else ""
                )
            grades = ", ".join(sorted({row["grade"] for row in result}))
            lines.append((claim, shown, grades, result[0]["comment"]))
        yield Section(name, (Table(("claim", "verdict", "grade", "statement"), tuple(lines), align="llll"),))


def _constants(report: Report) -> Iterator[Block]:
    rows = tuple(
        (
            str(row["m"]),
            bracket(row["gamma"]),
            bracket(row["rho"]),
            bracket(row["L"]),
            bracket(row["gamma_at"], 8) if row["gamma_at"] else "∞",
        )
        for row in report.table
    )
    caption = "γ = sup h, ρ = sup |h′|, L = sup h(x)/x: certified, digits cut off, all correct."
    yield Table(("m", "γ", "ρ", "L", "x of γ"), rows, caption)
    yield from _figure(report, "family", "The bounded functions and their derivatives")


def _gate(report: Report) -> Iterator[Block]:
    for result in report.gate:
        if not applies(result):
            yield Paragraph(f"{result['name']}: without a bound γ of h the conditions do not apply.")
            continue
        rows = tuple(
            (
                f"({check['id']}){'' if check['id'] in result['deciding'] else ' does not decide'}",
                check["joint"] or "all",
                f"{SYMBOLS[check['verdict']]} {check['verdict']}",
                check["value"],
                bracket(check["limit"], 7),
                number(check["margin"], 4),
                check["largest_admissible"] or "none",
            )
            for check in result["checks"]
        )
        heads = ("condition", "joint", "verdict", "value", "limit", "margin", "largest admissible")
        yield Table(heads, rows, f"{result['name']}: {result['verdict']}", align="lllrrrr", keys=2)


def _runs(report: Report) -> Iterator[Block]:
    rows = tuple(
        (
            row["name"],
            fixed(row["L2"], 3),
            fixed(row["printed"]["L2"], 3) if row["printed"] else "–",
            joined(row["settling"]),
            joined(row["overshoot"], 1),
            joined(row["peak_torque"], 1),
            "never rose" if row["V_decreases"] else "rose",
        )
        for row in report.runs
    )
    heads = ("gains", "L2 [°]", "measured L2 [°]", "settling [s]", "overshoot [%]", "peak torque [N·m]", "V")
    yield Table(heads, rows, "Reference simulation of (11), in floating point")
    yield from _figure(report, "indices", "The L2 index (20), simulated and measured")
    for row in report.runs:
        yield from _figure(report, f"{file_stem(row['name'])}_errors", f"{row['name']}: position errors")


def _members(report: Report) -> Iterator[Section]:
    """What m does in these runs, where each member has one gain set."""
    members = sorted(
        (row for row in report.runs if row["m"] is not None and row["complete"]), key=lambda row: row["m"]
    )
    if len(members) > 1 and len({row["m"] for row in members}) == len(members):
        first = members[0]
        section = effect_section([_effect(row) for row in members], first["target"], first["time"])
        yield replace(section, blocks=(*section.blocks, Paragraph(OWN_GAINS)))


OWN_GAINS = (
    "Each m has the gains of its own gain set. Floating point, one motion; lyapcheck tune --m compares "
    "members at the largest gains of each."
)


def _effect(row: Data) -> Effect:
    known = [peak / most for peak, most in zip(row["peak_torque"], row["torque_limit"], strict=True) if most]
    return Effect(
        row["m"],
        row["L2"],
        max(map(abs, row["final_error"])),
        max(known, default=math.nan),
        row["top_speed"],
        math.inf if row["rest"] is None else row["rest"],
    )


def _study(report: Report, study: Data) -> Iterator[Block]:
    said = [tally_words(study), *([together_words(study)] if study["together"] else [])]
    said += [text for one in study["sets"] for text in (at_once_words(one), figure_gains_words(one))]
    yield Bullets(tuple(said))
    yield from _figure(report, "spread", "What is printed against what the assumed arms do")
    rows = tuple(
        (
            f"{one['name']}: {quantity_words(entry)}",
            printed_words(entry),
            value_words(entry["nominal"], entry["unit"]),
            span(entry["typical"]),
            answer_cell(entry),
        )
        for one in study["sets"]
        for entry in one["numbers"]
    )
    heads = ("number", "printed", "nominal arm", "middle 90 %", "does an arm do it?")
    yield Table(heads, rows, align="lrrll")
    yield from _figure(report, "assumptions", "The L2 index when one assumption alone runs over its range")


def rests(report: Report) -> Iterator[Section]:
    """What is assumed, certificates, versions and seed."""
    versions = ", ".join(f"{name} {version}" for name, version in report.versions.items())
    assumed = tuple(report.robot["assumptions"])
    blocks: list[Block] = [Bullets(assumed)] if assumed else [Paragraph("Nothing is assumed about the arm.")]
    if report.certificates:
        words = f"{len(report.certificates)} certificates; the small checker judges them again with"
        blocks += [Paragraph(words), Code("lyapcheck recheck certificates/"), *_kernel(report)]
    boxes = {row["boxes"] for row in report.epsilon}
    budget = f" Budget for ε₀: {max(boxes)} boxes a gain set." if boxes else ""
    blocks.append(Paragraph(f"{versions}. Seed {report.seed}.{budget}"))
    yield Section(f"What this rests on: {report.robot['title']}", tuple(blocks))


def known(report: Report) -> Iterator[Section]:
    """What was known before the paper, and what is new."""
    if not report.own:
        yield Section("What was known, and what is new", (Bullets(report.notes.known[1:]),))


def _kernel(report: Report) -> Iterator[Block]:
    """What the grade ``kernel`` means, and which verdicts have it."""
    rows = [row for row in report.every_claim if row["verdict"] in ("proved", "refuted")]
    kernel = [row for row in rows if row["grade"] == GRADE]
    if kernel:
        yield Paragraph(
            "Grade kernel: Coq's kernel has accepted it too, as a theorem printed from the claim's own data, "
            "on golden axioms; what its words mean stands on one page, formal/Definitions.v. So it is for "
            f"{len(kernel)} of {len(rows)} verdicts. With Coq installed, it judges them anew by"
        )
        yield Code("lyapcheck recheck --kernel certificates/")
