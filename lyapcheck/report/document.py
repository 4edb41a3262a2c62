"""The report as a document, for Markdown, paper and whatever else answers are written in."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import groupby
from typing import Any

from lyapcheck.answers.epsilon import OWN_FRICTION
from lyapcheck.files.fields import file_stem
from lyapcheck.kernel import GRADE
from lyapcheck.output.answer import Answer
from lyapcheck.output.digits import at_most, shown
from lyapcheck.output.document import Block, Bullets, Code, Document, Figure, Paragraph, Section, Table
from lyapcheck.output.fields import Field, table
from lyapcheck.report.findings import and_list, member_words, witness_place, witness_sides
from lyapcheck.report.model import KINDS, SIGNS, WEIGHTS, EpsilonRow, Finding, Report, RunRow
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
            "verdict": [vars(one) for one in badges(report)],
            "sentences": list(sentences(report)),
            "counts": report.counts(),
            "errors": report.errors(),
            "by_n": [row.data() for row in report.by_size],
            "findings": [finding.data() for finding in report.findings],
            "table": report.table.data()["rows"],
            "derive": report.derived.data(),
            "tiles": [
                {"gains": name} | {key: getattr(one, key) for key in ("subject", "number", "text", "tone")}
                for name, known in report.tiles.items()
                for one in known
            ],
            "gate": report.gate.data()["results"],
            "epsilon": [  # a promise is in words, not in data
                {key: value for key, value in vars(one).items() if key != "promise"} for one in report.epsilon
            ],
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
        return [
            {key: getattr(row, key) for key in keys} | {"verdict": row.decision.word}
            for row in self.report.every_claim
        ]


def _robot(model: RobotModel) -> dict[str, Any]:
    numbers = [
        {"name": name, "value": str(one.value), "unit": one.unit, "source": one.source}
        for name, one in model.numbers.items()
    ]
    own = {"name": model.name, "title": model.title, "joints": list(model.joints), "numbers": numbers}
    return own | {"assumptions": list(model.assumptions)}


def _front(report: Report) -> Iterator[Block]:
    if not report.own:
        yield Paragraph(f"{report.notes.paper.citation}.")
    yield Bullets(tuple(f"{badge.subject}: {badge.word}" for badge in badges(report)))
    yield from map(Paragraph, sentences(report))
    for name, some in report.tiles.items():
        rows = tuple((one.subject, f"{SIGNS[one.tone]} {one.number}", one.text) for one in some)
        yield Table(("question", "answer", "who says so"), rows, name, align="lll")
    pictures = {"The printed proof, from left to right": chain(report), "An alternative proof": route(report)}
    for caption, steps in pictures.items():
        if steps and not report.own:
            rows = tuple((step.box.label, step.box.title, step.word) for step in steps)
            yield Table(("step", "statement", "verdict"), rows, caption, align="lll")


def _findings(report: Report) -> Iterator[Section]:
    for weight, words in WEIGHTS.items():
        if result := report.weighing(weight):
            cards = (Section(one.title, tuple(_card(report, one))) for one in result)
            blocks = tuple(cards) if weight in "ABE" else (Bullets(tuple(map(_line, result))),)
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
                *(f"{one.verdict.sign} {one.word}" for one in row.decisions.values()),
            )
            for row in report.by_size
        )
        words = (
            f"Verdicts that change with the number of joints, asked for n = {ns[0]} to {ns[-1]}. "
            "All other claims between norms have one verdict for these n."
        )
        table = Table(heads, rows, align="l" * len(heads))
        yield Section("With the number of joints", (Paragraph(words), table))


def _line(finding: Finding) -> str:
    said = f"“{finding.title}”: " if finding.claims else ""
    ms = f" ({member_words(finding.ms)})" if finding.ms else ""
    return f"{finding.subject}{ms}: {said}{finding.text}"


def _card(report: Report, finding: Finding) -> Iterator[Block]:
    """One finding."""
    if finding.claims:
        row = next((r for r in report.claims if r.id == finding.claims[0]), None)
        says = f": “{row.comment}”" if row else ""
        yield Paragraph(
            f"{and_list([f'claim {name}' for name in finding.claims])}, {member_words(finding.ms)}{says}"
        )
    items = [f"{term}: {text}" for term, text in finding.about.items()]
    witness = finding.witness
    place = f"Counterexample: {witness_place(witness)}" if witness and witness_place(witness) else "Printed"
    shown = f"{place}: {witness_sides(witness)}" if witness else finding.text
    yield Bullets((*items, shown))


def _claims(report: Report) -> Iterator[Section]:
    for name, group in groupby(report.every_claim, key=lambda row: row.heading):
        lines = []
        for claim, rows in groupby(group, key=lambda row: row.id):
            result = list(rows)
            words = [f"{row.verdict.sign} {row.decision.word}" for row in result]
            about = [row.about for row in result]
            if len({row.verdict for row in result}) == 1:  # once for all members
                ms = ", ".join(str(row.m) for row in result if row.m is not None)
                letters = (
                    f"{letter} = {value}" for letter, value in (("m", ms), ("n", result[0].n)) if value
                )
                words, about = words[:1], [", ".join(letters)]
            shown = [f"{word} ({what})" if what else word for word, what in zip(words, about, strict=True)]
            grades = ", ".join(sorted({row.grade for row in result}))
            lines.append((claim, ", ".join(shown), grades, result[0].comment))
        yield Section(name, (Table(("claim", "verdict", "grade", "statement"), tuple(lines), align="llll"),))


# --- What supports a report: ε₀, constants, gate, runs, and what all of it rests on.


FOUR = ("published (18)", "scalar", "certified", "falsified")
DIGITS = 12
"""Of constants: more than anybody compares by eye; report.json has all."""


def figure(report: Report, name: str, caption: str) -> Iterator[Figure]:
    """A drawing by its name, where the report has it."""
    if f"{name}.svg" in report.figures:
        yield Figure(f"figures/{name}.svg", caption)


def four_epsilons(report: Report) -> Iterator[Block]:
    """The four ε₀ of each gain set, why one is missing, and their drawing."""
    yield table(
        EPSILON,
        [(row,) for row in report.epsilon],
        "Each ε₀ gives a V of (12). The first is the upper end of (18), the second comes from norm bounds. "
        "The third has a certificate that V decreases on this arm. For the fourth a state is known at which "
        "V increases. ε₀Λ has a certificate too, with one weight per joint. All are for nominal numbers, "
        "rounded to the safe side.",
    )
    missing = [(row.name, kind, text) for row in report.epsilon for kind, text in row.reasons.items()]
    if missing:
        what = {"weighted": "larger ε₀Λ"}
        said = (f"{name}, no {what.get(kind, f'{kind} ε₀')}: {text}" for name, kind, text in missing)
        yield Bullets(tuple(said))
    if any(result.file.bounds.viscous_min is not None for result in report.gate):
        yield Bullets((OWN_FRICTION,))
    yield from figure(report, "epsilon", "The four ε₀ of each gain set")


def _weighted(row: EpsilonRow) -> str:
    """ε₀Λ of a gain set in a cell; a dash where no weights were sought."""
    weights = f"diag({', '.join(row.weighted)})" if "weighted" in row.certificates else "Λ = I"
    return weights if row.weighted else "–"


EPSILON = (
    Field("", "name", "gains", align="l"),
    *(Field("", kind, head, lambda x: x or "–") for kind, head in zip(KINDS, FOUR, strict=True)),
    Field("", "ratio", "certified/falsified", lambda x: x or "–"),
    Field("", _weighted, "ε₀Λ"),
)
"""What is said of the ε₀ of a gain set."""


def evidence(report: Report) -> Iterator[Section]:
    """Constants, gate and runs."""
    constants = _told(replace(report.table, digits=DIGITS).document())
    drawn = figure(report, "family", "The bounded functions and their derivatives")
    yield Section("The family and its constants", (*constants, *drawn))
    yield Section("The gate", tuple(_told(report.gate.document())))
    caption = "Reference simulation of (11), in floating point"
    errors = (
        one
        for row in report.runs
        for one in figure(report, f"{file_stem(row.name)}_errors", f"{row.name}: position errors")
    )
    yield Section("The closed loop", (table(RUN, [(row,) for row in report.runs], caption), *errors))
    # what m does in these runs, where each member has one gain set
    members = {row.m: row for row in report.runs if row.m is not None and row.complete}
    if len(members) > 1 and len(members) == sum(row.m is not None and row.complete for row in report.runs):
        ordered = [members[m] for m in sorted(members)]
        goal, seconds = ", ".join(f"{x:g}" for x in ordered[0].target), f"{ordered[0].time:g}"
        says = Paragraph(MEMBERS.format(seconds=seconds, goal=goal))
        yield Section("Simulated: what m does", (table(MEMBER, [(row,) for row in ordered]), says))


def _told(document: Document) -> Iterator[Block]:
    """An answer in its own words."""
    yield from (*document.blocks, *document.details)
    if document.notes:
        yield Bullets(document.notes)


def fixed(value: Any, places: int = 2) -> str:
    """A number to some decimal places; a dash where there is none."""
    return "–" if value is None or math.isnan(float(value)) else shown(float(value), f".{places}f")


def joined(values: Sequence[Any], places: int = 2) -> str:
    """A list of numbers in one cell."""
    return ", ".join(fixed(value, places) for value in values)


RUN = (
    Field("", "name", "gains", align="l"),
    Field("", "L2", "L2 [°]", lambda x: fixed(x, 3)),
    Field("", lambda row: (row.printed or {}).get("L2"), "measured L2 [°]", lambda x: fixed(x, 3)),
    Field("", "settling", "settling [s]", joined),
    Field("", "overshoot", "overshoot [%]", lambda x: joined(x, 1)),
    Field("", "peak_torque", "peak torque [N·m]", lambda x: joined(x, 1)),
    Field("", "V_decreases", "V", lambda falls: "never rose" if falls else "rose"),
)
"""What is said of a run."""


MEMBERS = (
    "Simulated by (11), without dry friction: in {seconds} s from rest to ({goal})°, one motion in floating "
    "point. Each m has the gains of its own gain set. For m ≥ 2 h is flat at the goal."
)


def _most_share(row: RunRow) -> float:
    known = [peak / most for peak, most in zip(row.peak_torque, row.torque_limit, strict=True) if most]
    return max(known, default=math.nan)


def _leaves(error: float | None) -> str:
    return "anywhere" if error is None else at_most(error) if error > 0 else "—"


MEMBER = (
    Field("", "m", "m", align="l"),
    Field("", lambda row: math.nan if row.L2 is None else row.L2, "L2 [°]", ".2f"),
    Field("", lambda row: max(abs(e) for e in row.final_error if e is not None), "last error [°]", ".2f"),
    Field("", _most_share, "torque / limit", ".2f"),
    Field("", "top_speed", "top speed [rad/s]", ".2f"),
    Field("", "rest", "friction error [°]", _leaves),
)
"""What is said of a member's run."""


def rests(report: Report) -> Iterator[Section]:
    """What is assumed, certificates, versions and seed."""
    versions = ", ".join(f"{name} {version}" for name, version in report.versions.items())
    assumed = tuple(report.robot.assumptions)
    blocks: list[Block] = [Bullets(assumed)] if assumed else [Paragraph("Nothing is assumed about the arm.")]
    if report.certificates:
        words = f"{len(report.certificates)} certificates; the small checker judges them again with"
        blocks += [Paragraph(words), Code("lyapcheck recheck certificates")]
        decided = [row for row in report.every_claim if row.decided]
        kernel = [row for row in decided if row.grade == GRADE]
        if kernel:
            words = (
                "Grade kernel: a theorem of Coq's kernel too, printed from the claim's own data, "
                "on golden axioms; what its words mean stands on one page, formal/Definitions.v. "
                f"So it is for {len(kernel)} of {len(decided)} verdicts. "
                "With Coq installed, it judges them anew by"
            )
            blocks += [Paragraph(words), Code("lyapcheck recheck --kernel certificates")]
    boxes = {row.boxes for row in report.epsilon}
    budget = f" Budget for ε₀: {max(boxes)} boxes a gain set." if boxes else ""
    blocks.append(Paragraph(f"Computed with {versions}. Seed {report.seed}.{budget}"))
    yield Section(f"What this rests on: {report.robot.title}", tuple(blocks))


def known(report: Report) -> Iterator[Section]:
    """What was known before the paper, and what is new."""
    if not report.own:
        yield Section("What was known, and what is new", (Bullets(report.notes.known[1:]),))
