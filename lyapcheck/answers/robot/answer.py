"""What is known of an arm: decided properties and certified constants, for people and for programs."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from lyapcheck.answers.assumed import arm_words, assumed_line
from lyapcheck.answers.robot.certified import CertifiedBounds
from lyapcheck.answers.robot.properties import PropertyResult
from lyapcheck.check.kinds.inertia import mass_entries, mass_text
from lyapcheck.constants import SEED
from lyapcheck.files.decimals import decimal_text
from lyapcheck.output.answer import Annotation, Answer, Level
from lyapcheck.output.digits import at_least, at_most, decimals
from lyapcheck.output.document import Block, Bullets, Document, Paragraph, Section, Table, command
from lyapcheck.output.fields import Field, data, records, table
from lyapcheck.promise import Promise, all_say, told
from lyapcheck.robots.dynamics import FEW_JOINTS
from lyapcheck.robots.fields import with_unit
from lyapcheck.verdicts import Exit, Verdict, exit_code

if TYPE_CHECKING:
    from lyapcheck.certificate import Certificate
    from lyapcheck.constants import ConstantResult
    from lyapcheck.robots import Number, RobotModel


RANGES, NOMINAL = "all values of the ranges", "nominal numbers"
LEVELS = {Verdict.PROVED: Level.PASSED, Verdict.REFUTED: Level.FAILED}
SYMBOLS = {"lambda_min": "λmin(M)", "lambda_max": "λmax(M) = β_M"}
MARKS = {Verdict.ERROR: "!", Verdict.REFUTED: "✗", Verdict.UNDECIDED: "?"}
"""From what matters most."""
NONE = "–"
DIGITS, DATA_DIGITS = 6, 15
"""Of the ends in floating point, for people and for programs."""
ROW_KEYS = ("id", "verdict", "grade", "statement", "method", "reason")
AT_NOMINAL = "At nominal parameters: ends that certificates show, and those of floating point."
GAPS = "The gap is that of the ends by certificates, relative to the larger one."
NUMERIC = "Marked *: that of the numeric ends, as a certificate is missing."
WIDE = 0.25
"""The gap from which a word is said about it."""
MOST_REMARKS = 3
READABLE = 2000
"""Characters beyond which nobody reads a matrix; certificates have it."""


def _exact(number: Number | None) -> str:
    """A number of the arm for people."""
    if number is None:
        return NONE
    return decimal_text(number.value) + (" (assumed)" if number.assumed else "")


NUMBER = (
    Field("value", "value", to=decimal_text),
    Field("unit", "unit"),
    Field("source", "source"),
    Field("assumed", "assumed"),
    Field("low", lambda number: decimal_text(number.bounds[0])),
    Field("high", lambda number: decimal_text(number.bounds[1])),
    Field("note", "note"),
)
"""What is said of a number of the arm."""


def _data(number: Number | None) -> dict[str, Any] | None:
    return None if number is None else data(NUMBER, number)


def _each(numbers: Iterable[Number | None]) -> list[dict[str, Any] | None]:
    return list(map(_data, numbers))


JOINT = (
    Field("name", "joints", "joint", align="l", each=True),
    Field("viscous", "viscous", "viscous [N·m·s/rad]", _exact, _each, each=True),
    Field("coulomb", "coulomb", "Coulomb [N·m]", _exact, _each, each=True),
    Field("torque_limit", "torque_limit", "torque limit [N·m]", _exact, _each, each=True),
    Field("encoder", "encoder", "encoder [counts/turn]", lambda x: NONE if x is None else str(x), each=True),
    Field("gravity_bound", "gravity_bound", to=_each, each=True),
)
"""What is said of a joint."""


@dataclass(frozen=True)
class RobotReport(Answer):
    """An arm with what was decided and certified about it; ``extent`` says for which of its values.

    Args:
        model: the arm.
        properties: 2.1 to 2.8.
        constants: from both sides, in floating point.
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
        wide = (_wide(self, c) for c in self.constants if _gap(self, c) > WIDE)
        remarks = (*wrong, *model.doubts, *wide, *model.remarks)
        left = len(remarks) - MOST_REMARKS
        said = remarks if left <= 0 else (*remarks[: MOST_REMARKS - 1], f"{left + 1} more remarks: add -v")
        blocks: tuple[Block, ...] = (_ends(self), *([Bullets(said)] if said else []))
        arm = self.path or model.name
        limits = all(number is not None for number in model.torque_limit)
        then = ("tune", *arm_words(arm), "--m", "1") if limits else ("robot", *arm_words(arm), "-v")
        return Document(
            _title(self),
            blocks,
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
            "constants": [constant_data(self, constant) for constant in self.constants],
            "joints": records(JOINT, model, model.n),
            "numbers": {name: _data(number) for name, number in model.numbers.items()},
            "parameters": list(model.parameters),
            "assumptions": list(model.assumptions),
        }

    def records(self) -> list[dict[str, Any]]:
        """A row a property, a claim about the print, and a constant; ``kind`` says which."""
        judged = [("property", row) for row in self.properties] + [("print", row) for row in self.prints]
        entries = [(kind, property_data(row)) for kind, row in judged]
        rows = [{"kind": kind, **{key: row[key] for key in ROW_KEYS}} for kind, row in entries]
        for constant in self.constants:
            result = constant_data(self, constant)
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


def constant_data(report: RobotReport, constant: ConstantResult) -> dict[str, Any]:
    """``lower`` and ``upper`` are the ends in floating point, as in ``numeric``, and ``gap`` is theirs."""
    lower, upper = decimals(constant.enclosure, DATA_DIGITS)
    n, known = report.model.n, report.certified.get(constant.name, CertifiedBounds())
    return {
        "name": constant.name,
        "unit": constant.unit,
        "lower": lower,
        "upper": upper,
        "certified": {
            end: None if (shown := getattr(known, end)) is None else decimal_text(shown)
            for end in ("lower", "upper")
        },
        "numeric": {"lower": lower, "upper": upper},
        "gap": f"{constant.gap:.3e}",
        "q": [repr(x) for x in constant.state[:n]],
        "x": [repr(x) for x in constant.state[n:]] or None,
        "boxes": constant.boxes,
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
    numbers = [Section("Numbers", (_numbers(model),))] if model.numbers else []
    properties = _judged("Properties", "property", report.properties, report)
    return [properties, *prints, _constants(report), *joints, *numbers, *assumed, *inertia_sections(model)]


def _judged(title: str, head: str, rows: Sequence[PropertyResult], report: RobotReport) -> Section:
    """Verdicts with the arms that they are about, then what supports them."""
    ranged = uncertain(report.model)
    cells = tuple(
        (
            row.id,
            row.word,
            *([extent(row, report.model) or NONE] if ranged else []),
            row.finding.grade.label,
            row.finding.says(row.statement),
        )
        for row in rows
    )
    shown = tuple(f"{row.id}: {evidence(row)}" for row in rows)
    heads = (head, "verdict", *(["for"] if ranged else []), "grade", "statement")
    table = Table(heads, cells, align="l" * len(heads))
    return Section(title, (table, Paragraph("Shown by:"), Bullets(shown)))


def _ends(report: RobotReport) -> Table:
    """Both ends of each constant as certificates show them, in four digits."""
    rows = []
    for constant in report.constants:
        shown, gap = report.certified.get(constant.name, CertifiedBounds()), _gap(report, constant)
        low, high = shown.lower, shown.upper
        ends = (NONE if low is None else at_least(low), NONE if high is None else at_most(high))
        rows.append((_symbol(constant), constant.unit, *ends, "0" if gap == 0 else _percent(gap)))
    heads = ("constant", "unit", "proved: above", "proved: at most", "gap [%]")
    return Table(heads, tuple(rows), align="llrrr", keys=1, drop=(1, 4))


def _constants(report: RobotReport) -> Section:
    rows = [_constant_row(report, constant) for constant in report.constants]
    states = [row for constant in report.constants for row in _state_rows(report, constant)]
    heads = ("constant", "unit", "certified: above", "at most", "numeric: at least", "at most", "gap")
    ends = Table(heads, tuple(rows), align="llrrrrr")
    shown = Table(("constant", "shown at q [rad]"), tuple(states), align="ll")
    said = [_wide(report, constant) for constant in report.constants if _gap(report, constant) > WIDE]
    wide = [Bullets(tuple(said))] if said else []
    starred = any(not _by_certificates(report, constant) for constant in report.constants)
    notes = [Paragraph(AT_NOMINAL), Paragraph(f"{GAPS} {NUMERIC}" if starred else GAPS)]
    return Section("Constants", (*notes, ends, *wide, shown))


def _wide(report: RobotReport, constant: ConstantResult) -> str:
    """How wide the ends are, and what might narrow them."""
    advice, model = "try a larger --max-boxes", report.model
    if model.n > FEW_JOINTS and model.fixed().chain is not None:
        advice = "bounded by the best forms along the links, which more boxes do not change"
    elif constant.gap <= WIDE:
        advice = "the numeric ends are nearer, and no certificate was found for what they say"
    return f"{_symbol(constant)} is wide, {_percent(_gap(report, constant))} %: {advice}"


def _percent(share: Fraction) -> str:
    """Two significant digits, rounded up."""
    return at_most(100 * share, 2)


def _gap(report: RobotReport, constant: ConstantResult) -> Fraction:
    """Of the certified ends, which users rely on; where one is missing, of the numeric ones."""
    shown = report.certified.get(constant.name)
    if shown is None or shown.lower is None or shown.upper is None:
        low, high = constant.enclosure.lower, constant.enclosure.upper
    else:
        low, high = shown.lower, shown.upper
    size = max(abs(low), abs(high))
    return (high - low) / size if size else Fraction(0)


def _by_certificates(report: RobotReport, constant: ConstantResult) -> bool:
    """Whether both ends are certified; that a norm is not negative needs no certificate."""
    shown = report.certified.get(constant.name, CertifiedBounds())
    zero = constant.name != "lambda_min" and shown.upper == 0
    return zero or (shown.lower is not None and shown.upper is not None)


def _constant_row(report: RobotReport, constant: ConstantResult) -> tuple[str, ...]:
    """The ends that certificates show, those of floating point, rounded outward, and the gap."""
    shown, gap = report.certified.get(constant.name, CertifiedBounds()), _gap(report, constant)
    known = [NONE if end is None else decimal_text(end) for end in (shown.lower, shown.upper)]
    cell = "0" if gap == 0 else f"{_percent(gap)} %"
    star = "" if _by_certificates(report, constant) else "*"
    ends = decimals(constant.enclosure, DIGITS)
    return (_symbol(constant), constant.unit, *known, *ends, cell + star)


def _state_rows(report: RobotReport, constant: ConstantResult) -> list[tuple[str, str]]:
    """The angles; of k_c also the direction x."""
    n, name = report.model.n, _symbol(constant)
    angles, x = (", ".join(f"{x:z.4f}" for x in part) for part in (constant.state[:n], constant.state[n:]))
    return [(name, angles), *([(f"{name}: x", x)] if x else [])]


def _symbol(constant: ConstantResult) -> str:
    return SYMBOLS.get(constant.name, constant.name)


def _numbers(model: RobotModel) -> Table:
    """Every number with where it comes from; its range where any has one."""
    ranged = any(number.ranged for number in model.numbers.values())
    rows = []
    for name, number in model.numbers.items():
        between = " and ".join(map(decimal_text, number.bounds)) if number.ranged else ""
        origin = "assumed" if number.assumed else number.source
        rows.append((name, with_unit(number.value, number.unit), *([between] * ranged), origin))
    heads = ("number", "value", *(["between"] * ranged), "source")
    return Table(heads, tuple(rows), align="l" * len(heads))


def inertia_sections(model: RobotModel) -> list[Section]:
    """M(q) with its ranges and at the nominal numbers, where its statements do not have the entries."""
    result: dict[str, Section] = {}
    for robot in (model, model.fixed()):
        if robot.chain is not None and robot.n > FEW_JOINTS:
            continue
        mass, ranges = robot.mass_terms, robot.ranges
        entries, title = mass_entries(mass, ranges), mass_text(mass, ranges).removeprefix("the ")
        if entries[0] not in title and sum(map(len, entries)) <= READABLE:
            names = (f"p{k + 1} is {name}" for k, name in enumerate(robot.parameters))
            result[title] = Section(title, (Bullets((*entries, *names)),))
    return list(result.values())


@dataclass(frozen=True)
class ArmAssumptions(Answer):
    """All that is assumed about an arm: numbers without a source, then what its model takes for granted."""

    schema = "lyapcheck/robot-assumptions/1"

    model: RobotModel
    arm: str

    def document(self) -> Document:
        """The assumed numbers as a table, the rest as sentences."""
        model = self.model
        numbers = [(name, number) for name, number in model.numbers.items() if number.assumed]
        rows = [
            (
                name,
                with_unit(number.value, number.unit),
                " … ".join(map(decimal_text, number.bounds)) if number.ranged else "",
                number.note or number.source,
            )
            for name, number in numbers
        ]
        heads = ("number", "value", "range", "why")
        others = (*model.remarks, *model.doubts)
        table: list[Block] = [Table(heads, tuple(rows), align="llll")] if rows else []
        title = f"{model.name}: {len(numbers)} of {len(model.numbers)} numbers are assumed"
        then = command("robot", *arm_words(self.arm), "--export", "own_arm.toml")
        return Document(title, (*table, *([Bullets(others)] if others else [])), next=then)

    def data(self) -> dict[str, Any]:
        """``numbers: {name: {value, unit, …}}`` and ``assumptions``, one sentence each."""
        known = {name: _data(number) for name, number in self.model.numbers.items() if number.assumed}
        return {"robot": self.model.name, "numbers": known, "assumptions": list(self.model.assumptions)}

    def records(self) -> list[dict[str, Any]]:
        """A row a number."""
        return [{"name": name, **(row or {})} for name, row in self.data()["numbers"].items()]
