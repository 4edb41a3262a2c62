"""The numbers of an arm: its constants with the ends that certificates show, its joints, what is assumed."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from lyapcheck.answers import arm_words
from lyapcheck.answers.robot.properties import SYMBOLS, CertifiedBounds
from lyapcheck.check.kinds.inertia import mass_entries, mass_text
from lyapcheck.files.decimals import decimal_text
from lyapcheck.output.answer import Answer
from lyapcheck.output.digits import at_least, at_most, ends
from lyapcheck.output.document import Block, Bullets, Document, Paragraph, Section, Table, command
from lyapcheck.output.fields import Field, data, table
from lyapcheck.robots.dynamics import FEW_JOINTS
from lyapcheck.robots.fields import with_unit

if TYPE_CHECKING:
    from lyapcheck.constants import ConstantResult
    from lyapcheck.robots import Number, RobotModel

NONE = "–"
DATA_DIGITS = 15
"""Of what a search found, for programs."""
AT_NOMINAL = "At nominal parameters, by certificates; the gap is relative to the larger end."
WIDE = 0.25
"""The gap from which a word is said about it."""
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


def number_data(number: Number | None) -> dict[str, Any] | None:
    """A number for programs."""
    return None if number is None else data(NUMBER, number)


def _each(numbers: Iterable[Number | None]) -> list[dict[str, Any] | None]:
    return list(map(number_data, numbers))


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
class Constant:
    """A constant with the ends that certificates show, of an arm."""

    of: ConstantResult
    known: CertifiedBounds
    model: RobotModel

    @property
    def symbol(self) -> str:
        name = SYMBOLS.get(self.of.name, self.of.name)
        return f"{name} = β_M" if self.of.name == "lambda_max" else name

    @property
    def gap(self) -> Fraction | None:
        """Of the ends, relative to the larger one; none where one is missing."""
        low, high = self.known.lower, self.known.upper
        if low is None and self.of.name != "lambda_min":
            low = Fraction(0)  # that a norm is not negative needs no certificate
        if low is None or high is None:
            return None
        size = max(abs(low), abs(high))
        return (high - low) / size if size else Fraction(0)

    def states(self) -> list[tuple[str, str]]:
        """The angles; of k_c also the direction x."""
        n, name = self.model.n, self.symbol
        angles, x = (", ".join(f"{x:z.4f}" for x in part) for part in (self.of.state[:n], self.of.state[n:]))
        return [(name, angles), *([(f"{name}: x", x)] if x else [])]

    def wide(self) -> Iterator[str]:
        """How wide the ends are if they are, and what might narrow them."""
        if self.gap is None or self.gap <= WIDE:
            return
        advice = "try a larger --max-boxes"
        if self.model.n > FEW_JOINTS and self.model.fixed().chain is not None:
            advice = "bounded by the best forms along the links, which more boxes do not change"
        yield f"{self.symbol} is wide, {_percent(self.gap)} %: {advice}"

    def data(self) -> dict[str, Any]:
        """``lower`` and ``upper`` are the ends as found, like ``numeric``; ``gap`` is theirs."""
        of, n = self.of, self.model.n
        numeric = ends(of.enclosure, DATA_DIGITS)
        known = ("lower", self.known.lower), ("upper", self.known.upper)
        certified = {end: None if x is None else decimal_text(x) for end, x in known}
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
    Field("", "gap", "gap [%]", _or_none(_percent)),
)
WHOLE = (
    *SHORT[:2],
    Field("", "known.lower", "above", _or_none(decimal_text)),
    Field("", "known.upper", "at most", _or_none(decimal_text)),
    SHORT[-1],
)
"""The ends of a constant that certificates show: in four digits, or whole."""


def constants_section(rows: Sequence[Constant]) -> Section:
    """The ends of each constant, and the states that show them."""
    said = tuple(text for row in rows for text in row.wide())
    states = Table(
        ("constant", "shown at q [rad]"), tuple(x for row in rows for x in row.states()), align="ll"
    )
    shown = table(WHOLE, [(row,) for row in rows])
    remarks = [Bullets(said)] if said else []
    return Section("Constants", (Paragraph(AT_NOMINAL), shown, *remarks, states))


def numbers_table(model: RobotModel, only: bool = False) -> Table:
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
        numbers, others = numbers_table(model, only=True), (*model.remarks, *model.doubts)
        blocks: list[Block] = [numbers] if numbers.rows else []
        title = f"{model.name}: {len(numbers.rows)} of {len(model.numbers)} numbers are assumed"
        then = command("robot", *arm_words(self.arm), "--export", "own_arm.toml")
        return Document(title, (*blocks, *([Bullets(others)] if others else [])), next=then)

    def data(self) -> dict[str, Any]:
        """``numbers: {name: {value, unit, …}}`` and ``assumptions``, one sentence each."""
        known = {name: number_data(number) for name, number in self.model.numbers.items() if number.assumed}
        return {"robot": self.model.name, "numbers": known, "assumptions": list(self.model.assumptions)}

    def records(self) -> list[dict[str, Any]]:
        """A row a number."""
        return [{"name": name, **(row or {})} for name, row in self.data()["numbers"].items()]
