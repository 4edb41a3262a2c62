"""What is known of an arm: decided properties and certified constants, for people and for programs."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from lyapcheck.answers import arm_words, assumed_line
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
class _Constant:
    """A constant with the ends that certificates show, of an arm."""

    of: ConstantResult
    known: CertifiedBounds
    model: RobotModel

    @property
    def symbol(self) -> str:
        return SYMBOLS.get(self.of.name, self.of.name)

    @property
    def gap(self) -> Fraction:
        """Of the certified ends, which users rely on; where one is missing, of the numeric ones."""
        low, high = self.known.lower, self.known.upper
        if low is None or high is None:
            low, high = self.of.enclosure.lower, self.of.enclosure.upper
        size = max(abs(low), abs(high))
        return (high - low) / size if size else Fraction(0)

    @property
    def star(self) -> str:
        """Where an end is not certified; that a norm is not negative needs no certificate."""
        zero = self.of.name != "lambda_min" and self.known.upper == 0
        return "" if zero or None not in (self.known.lower, self.known.upper) else "*"

    def states(self) -> list[tuple[str, str]]:
        """The angles; of k_c also the direction x."""
        n, name = self.model.n, self.symbol
        angles, x = (", ".join(f"{x:z.4f}" for x in part) for part in (self.of.state[:n], self.of.state[n:]))
        return [(name, angles), *([(f"{name}: x", x)] if x else [])]

    def wide(self) -> Iterator[str]:
        """How wide the ends are if they are, and what might narrow them."""
        advice, model = "try a larger --max-boxes", self.model
        if model.n > FEW_JOINTS and model.fixed().chain is not None:
            advice = "bounded by the best forms along the links, which more boxes do not change"
        elif self.of.gap <= WIDE:
            advice = "the numeric ends are nearer, and no certificate was found for what they say"
        if self.gap > WIDE:
            yield f"{self.symbol} is wide, {_percent(self.gap)} %: {advice}"

    def data(self) -> dict[str, Any]:
        """``lower`` and ``upper`` are the ends in floating point, like ``numeric``, and ``gap`` is theirs."""
        of, n = self.of, self.model.n
        numeric = dict(zip(("lower", "upper"), decimals(of.enclosure, DATA_DIGITS), strict=True))
        known = {"lower": self.known.lower, "upper": self.known.upper}
        certified = {end: None if x is None else decimal_text(x) for end, x in known.items()}
        state = [repr(x) for x in of.state]
        return {
            "name": of.name,
            "unit": of.unit,
            **numeric,
            "certified": certified,
            "numeric": numeric,
            "gap": f"{of.gap:.3e}",
            "q": state[:n],
            "x": state[n:] or None,
            "boxes": of.boxes,
        }


def _percent(share: Fraction) -> str:
    """Two significant digits, rounded up."""
    return "0" if share == 0 else at_most(100 * share, 2)


def _or_none(show: Callable[[Fraction], str]) -> Callable[[Fraction | None], str]:
    return lambda end: NONE if end is None else show(end)


SHORT = (
    Field("", "symbol", "constant", align="l"),
    Field("", "of.unit", "unit", align="l"),
    Field("", "known.lower", "proved: above", _or_none(at_least)),
    Field("", "known.upper", "proved: at most", _or_none(at_most)),
    Field("", "gap", "gap [%]", _percent),
)
WHOLE = (
    *SHORT[:2],
    Field("", "known.lower", "certified: above", _or_none(decimal_text)),
    Field("", "known.upper", "at most", _or_none(decimal_text)),
    Field("", lambda row: decimals(row.of.enclosure, DIGITS)[0], "numeric: at least"),
    Field("", lambda row: decimals(row.of.enclosure, DIGITS)[1], "at most"),
    Field("", lambda row: f"{_percent(row.gap)}{' %' if row.gap else ''}{row.star}", "gap"),
)
"""The ends of a constant that certificates show: in four digits, or whole beside those of floating point."""


def _constants(rows: Sequence[_Constant]) -> Section:
    said = tuple(text for row in rows for text in row.wide())
    states = Table(
        ("constant", "shown at q [rad]"), tuple(x for row in rows for x in row.states()), align="ll"
    )
    notes = Paragraph(AT_NOMINAL), Paragraph(f"{GAPS} {NUMERIC}" if any(row.star for row in rows) else GAPS)
    ends = table(WHOLE, [(row,) for row in rows])
    return Section("Constants", (*notes, ends, *([Bullets(said)] if said else []), states))


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
    def rows(self) -> list[_Constant]:
        """The constants, each with its certified ends."""
        known = self.certified
        return [_Constant(one, known.get(one.name, CertifiedBounds()), self.model) for one in self.constants]

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
            "numbers": {name: _data(number) for name, number in model.numbers.items()},
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
    numbers = [Section("Numbers", (_numbers(model),))] if model.numbers else []
    properties = _judged("Properties", "property", report.properties, report)
    return [
        properties,
        *prints,
        _constants(report.rows),
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


def _numbers(model: RobotModel, only: bool = False) -> Table:
    """Every number with where it comes from, or the assumed ones with the reason; ranges if any has one."""
    shown = {name: one for name, one in model.numbers.items() if one.assumed or not only}
    ranged = only or any(one.ranged for one in shown.values())
    rows = []
    for name, one in shown.items():
        between = " and ".join(map(decimal_text, one.bounds)) if one.ranged else ""
        origin = one.note or one.source if only else "assumed" if one.assumed else one.source
        rows.append((name, with_unit(one.value, one.unit), *([between] * ranged), origin))
    heads = ("number", "value", *(["between"] * ranged), "why" if only else "source")
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
        numbers, others = _numbers(model, only=True), (*model.remarks, *model.doubts)
        blocks: list[Block] = [numbers] if numbers.rows else []
        title = f"{model.name}: {len(numbers.rows)} of {len(model.numbers)} numbers are assumed"
        then = command("robot", *arm_words(self.arm), "--export", "own_arm.toml")
        return Document(title, (*blocks, *([Bullets(others)] if others else [])), next=then)

    def data(self) -> dict[str, Any]:
        """``numbers: {name: {value, unit, …}}`` and ``assumptions``, one sentence each."""
        known = {name: _data(number) for name, number in self.model.numbers.items() if number.assumed}
        return {"robot": self.model.name, "numbers": known, "assumptions": list(self.model.assumptions)}

    def records(self) -> list[dict[str, Any]]:
        """A row a number."""
        return [{"name": name, **(row or {})} for name, row in self.data()["numbers"].items()]
