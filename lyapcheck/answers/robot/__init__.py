"""What is known of an arm: properties 2.1–2.8, certified constants, and the numbers all of it rests on."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from lyapcheck._types import Progress
from lyapcheck.answers import arm_words, assumed_line
from lyapcheck.answers.check.run import proposed_proof
from lyapcheck.answers.robot.numbers import (
    JOINT,
    NONE,
    SHORT,
    Constant,
    constants_section,
    inertia_sections,
    number_data,
    numbers_table,
)
from lyapcheck.answers.robot.properties import (
    IDS,
    CertifiedBounds,
    PropertyResult,
    answered,
    bound_questions,
    certificates,
    certified,
    print_questions,
    properties,
)
from lyapcheck.check.verify import each_once
from lyapcheck.claims.decision import file_name, judge_afresh
from lyapcheck.constants import MAX_BOXES, SEED, arm_constants
from lyapcheck.output.answer import Annotation, Answer, Level
from lyapcheck.output.document import Bullets, Document, Paragraph, Section, Table, command
from lyapcheck.output.fields import records, table
from lyapcheck.promise import Promise, all_say, told
from lyapcheck.verdicts import Exit, Verdict, exit_code

if TYPE_CHECKING:
    from lyapcheck.certificate import Certificate
    from lyapcheck.constants import ConstantResult
    from lyapcheck.robots import RobotModel

RANGES, NOMINAL = "all values of the ranges", "nominal numbers"
LEVELS = {Verdict.PROVED: Level.PASSED, Verdict.REFUTED: Level.FAILED}
MARKS = {Verdict.ERROR: "!", Verdict.REFUTED: "✗", Verdict.UNDECIDED: "?"}
"""From what matters most."""
ROW_KEYS = ("id", "verdict", "grade", "statement", "method", "reason")
MOST_REMARKS = 3


def build(
    model: RobotModel, max_boxes: int | None = None, on_progress: Progress | None = None
) -> RobotReport:
    """Bound the constants of an arm and decide its properties.

    Args:
        model: the arm.
        max_boxes: how many boxes a bound may take. Default: 2000.
        on_progress: receives the share of the work done.

    Soundness: what is called proved, refuted or certified is what a fresh process of the checker accepts.
    """
    # searches ask the rules about what they find, property 2.6 about the bound of k_c; no verdict comes of it
    with each_once():
        constants = arm_constants(model, max_boxes or MAX_BOXES, on_progress)
        if on_progress is not None:
            on_progress(1.0, "properties 2.1–2.8")
        proposed, result = proposed_proof("published.py", [1], model, only=IDS)
    prints, bounds = list(print_questions(model)), list(bound_questions(model, constants))
    made = certificates(model, [*prints, *bounds])
    # one process for all, in which what several rest on is judged once
    judged = judge_afresh({**proposed, **made})
    decided, of_properties = properties(model, result(judged))
    positive = decided[0].verdict is Verdict.PROVED
    about_prints, about_bounds = answered(model, prints, made, judged), answered(model, bounds, made, judged)
    own = {
        file_name(row.id, None): row.certificate
        for row in [*about_prints, *about_bounds]
        if row.certificate is not None
    }
    shown = (replace(row, id=row.id.removeprefix("printed ")) for row in about_prints)
    return RobotReport(
        model,
        decided,
        constants,
        tuple(shown),
        certified(about_bounds, positive),
        {**of_properties, **own},
    )


@dataclass(frozen=True)
class RobotReport(Answer):
    """An arm with what was decided and certified about it; ``extent`` says for which of its values.

    Args:
        model: the arm.
        properties: 2.1 to 2.8.
        constants: from both sides, as a search found them.
        prints: claims about C and g as the source prints them; they do not touch the arm, whose C and g
            follow from M and the potential.
        certified: by the name of a constant its ends that a certificate shows.
        certificates: of all that is decided, by file name.
        path: of the file that describes the arm; empty for a built-in one.
    """

    schema = "lyapcheck/robot/1"

    model: RobotModel
    properties: tuple[PropertyResult, ...]
    constants: tuple[ConstantResult, ...]
    prints: tuple[PropertyResult, ...] = ()
    certified: Mapping[str, CertifiedBounds] = field(default_factory=dict)
    certificates: Mapping[str, Certificate] = field(default_factory=dict)
    path: str = ""

    @property
    def rows(self) -> list[Constant]:
        """The constants, each with its certified ends."""
        known = self.certified
        return [Constant(one, known.get(one.name, CertifiedBounds()), self.model) for one in self.constants]

    @property
    def exit_code(self) -> Exit:
        """0 all properties proved, 1 one refuted, 3 one undecided."""
        return exit_code(row.verdict for row in self.properties)

    def document(self) -> Document:
        """The verdicts first, then the constants and what was not proved; in detail all there is."""
        model = self.model
        judged = [(f"property {row.id}", row) for row in self.properties]
        judged += [(row.statement, row) for row in self.prints]
        wrong = tuple(
            f"{what}: {row.word}; {evidence(row)}"
            for what, row in judged
            if row.verdict is not Verdict.PROVED
        )
        wide = (text for row in self.rows for text in row.wide())
        remarks = (*wrong, *wide, *model.doubts, *model.remarks)
        left = len(remarks) - MOST_REMARKS
        said = remarks if left <= 0 else (*remarks[: MOST_REMARKS - 1], f"{left + 1} more remarks: add -v")
        ends = table(SHORT, [(row,) for row in self.rows], drop=(1, 4))
        arm = self.path or model.name
        limits = all(number is not None for number in model.torque_limit)
        then = ("tune", *arm_words(arm), "--m", "1") if limits else ("robot", *arm_words(arm), "-v")
        loads = {row.of.name: row.known.lower or 0 for row in self.rows}
        limited = enumerate(model.torque_limit, start=1)
        if any(number is not None and loads.get(f"k_g{i}", 0) >= number.bounds[0] for i, number in limited):
            then = ("robot", *arm_words(arm), "-v")  # gravity alone needs the motor
        elif limits and not all(number.bounds[0] for number in model.viscous):
            then += ("--overshoot", "5", "--settle", "2")  # (19) admits no gains there
        return Document(
            _title(self),
            (ends, *([Bullets(said)] if said else [])),
            lead=_lead(self),
            details=tuple(_sections(self)),
            assumed=assumed_line(model, arm),
            next=command(*then),
        )

    def data(self) -> dict[str, Any]:
        """``properties: [{id, verdict, …}], constants: [{name, lower, upper, …}], joints, numbers, …``."""
        model = self.model
        return {
            "robot": model.name,
            "title": model.title,
            "n": model.n,
            "seed": SEED,
            "properties": [property_data(row, extent(row, model)) for row in self.properties],
            "prints": [property_data(row, extent(row, model)) for row in self.prints],
            "constants": [row.data() for row in self.rows],
            "joints": records(JOINT, model, model.n),
            "numbers": {name: number_data(number) for name, number in model.numbers.items()},
            "parameters": list(model.parameters),
            "assumptions": list(model.assumptions),
        }

    def records(self) -> list[dict[str, Any]]:
        """A row a property, a claim about the print, and a constant; ``kind`` says which."""
        judged = [("property", row) for row in self.properties] + [("print", row) for row in self.prints]
        entries = [(kind, property_data(row)) for kind, row in judged]
        rows = [{"kind": kind, **{key: row[key] for key in ROW_KEYS}} for kind, row in entries]
        for result in (row.data() for row in self.rows):
            kept = {key: result[key] for key in ("unit", "certified", "numeric", "gap", "q")}
            rows.append({"kind": "constant", "id": result["name"], **kept, "x": result["x"] or []})
        return rows

    def annotations(self) -> list[Annotation]:
        """A case a property; a refuted claim about the print is a remark."""
        result = [self._annotation(row, LEVELS.get(row.verdict, Level.UNDECIDED)) for row in self.properties]
        wrong = [row for row in self.prints if row.verdict is not Verdict.PROVED]
        return [*result, *(self._annotation(row, Level.REMARK) for row in wrong)]

    def _annotation(self, row: PropertyResult, level: Level) -> Annotation:
        said = "" if level is Level.PASSED else f"{row.word}: {row.statement}; {evidence(row)}"
        rule = row.id.replace(" ", "-") if level is not Level.REMARK else f"print-{row.id.replace(' ', '-')}"
        return Annotation(level, rule, row.finding.says(row.statement), self.model.name, "", said, self.path)


def uncertain(model: RobotModel) -> bool:
    """Whether the file gives a range to a number that the properties are about."""
    return any(number.ranged for number in (*model.parameters.values(), *model.viscous))


def extent(row: PropertyResult, model: RobotModel) -> str:
    """For which arms a decided row holds; empty where nothing is decided, and for an arm without ranges."""
    if row.finding.certificate is None or not uncertain(model):
        return ""
    return NOMINAL if row.over is None else RANGES


def together(ids: Sequence[str], every: Sequence[str]) -> str:
    """Some ids of a list, neighbours as a span: ``2.1, 2.3–2.5``."""
    spans: list[list[str]] = []
    for before, name in zip(["", *every], every, strict=False):
        if name in ids:
            if before in ids:
                spans[-1].append(name)
            else:
                spans.append([name])
    return ", ".join(f"{one[0]}–{one[-1]}" if len(one) > 2 else ", ".join(one) for one in spans)


def property_data(row: PropertyResult, about: str = "") -> dict[str, Any]:
    """One property, or a claim about the print, and for which arms it holds where the arm has ranges."""
    finding = row.finding
    return {
        "id": row.id,
        "statement": finding.says(row.statement),
        "verdict": row.word,
        "for": about or None,
        "grade": finding.grade.label,
        "method": finding.says(finding.method),
        "reason": finding.reason,
        "witness": finding.witness,
        "evidence": told(finding.promise, finding.evidence),
    }


def evidence(row: PropertyResult) -> str:
    """What supports the verdict."""
    finding = row.finding
    parts = [finding.says(finding.method), finding.reason]
    if finding.witness is not None:
        point = ", ".join(f"{name} = {value}" for name, value in finding.witness["point"].items())
        left, right = (finding.witness[side][0] for side in ("left", "right"))
        at = f"at {point}: " if point else ""
        parts.append(f"{at}not {left} {finding.witness['operator']} {right}")
    return "; ".join(part for part in parts if part)


def _title(report: RobotReport) -> str:
    name = report.model.name
    for verdict, mark in MARKS.items():
        result = [row.id for row in report.properties if row.verdict is verdict]
        if result:
            ending = "y" if len(result) == 1 else "ies"
            return f"{mark} {name}: propert{ending} {', '.join(result)} {verdict.value}"
    every = [row.id for row in report.properties]
    if not uncertain(report.model):
        said = all_say(_promises(report), "proved")
        return f"✓ {name}: properties {together(every, every)} {said}"
    extents = {row.id: extent(row, report.model) for row in report.properties}
    ranged, nominal = ([key for key in every if extents[key] == kind] for kind in (RANGES, NOMINAL))
    said = all_say(_promises(report), "proved")
    if not nominal:
        return f"✓ {name}: properties {together(ranged, every)} {said} for {RANGES}"
    if not ranged:
        return f"! {name}: properties {together(nominal, every)} {said} at {NOMINAL} only"
    return f"! {name}: properties {together(ranged, every)} {said} for its ranges"


def _lead(report: RobotReport) -> tuple[str, ...]:
    """What arm it is, and what is shown at its nominal numbers only."""
    model = report.model
    about = f"{model.title}; {model.n} joint{'s' if model.n > 1 else ''}"
    every = [row.id for row in report.properties]
    nominal = [row.id for row in report.properties if extent(row, model) == NOMINAL]
    if not nominal or len(nominal) == len(every) or report.exit_code is not Exit.PROVED:
        return (about,)
    words = f"{together(nominal, every)} proved at {NOMINAL} only"
    return about, all_say(_promises(report), words)


def _promises(report: RobotReport) -> list[Promise | None]:
    """One a property: about all ranges where that is shown, else about the nominal numbers."""
    return [row.over or row.finding.promise for row in report.properties]


def _sections(report: RobotReport) -> list[Section]:
    model = report.model
    prints = [_judged("As the source prints it", "claim", report.prints, report)] if report.prints else []
    joints = [Section("Joints", (table(JOINT, [(model, i) for i in range(model.n)]),))]
    assumed = [Section("Assumed", (Bullets(model.assumptions),))] if model.assumptions else []
    numbers = [Section("Numbers", (numbers_table(model),))] if model.numbers else []
    properties = _judged("Properties", "property", report.properties, report)
    return [
        properties,
        *prints,
        constants_section(report.rows),
        *joints,
        *numbers,
        *assumed,
        *inertia_sections(model),
    ]


def _judged(title: str, head: str, rows: Sequence[PropertyResult], report: RobotReport) -> Section:
    """Verdicts with the arms that they are about, then what supports them."""
    ranged = int(uncertain(report.model))  # a column of its own
    cells = tuple(
        (
            row.id,
            row.word,
            *([extent(row, report.model) or NONE] * ranged),
            row.finding.grade.label,
            row.finding.says(row.statement),
        )
        for row in rows
    )
    heads = (head, "verdict", *(["for"] * ranged), "grade", "statement")
    shown = tuple(f"{row.id}: {evidence(row)}" for row in rows)
    return Section(
        title, (Table(heads, cells, align="l" * len(heads)), Paragraph("Shown by:"), Bullets(shown))
    )
