"""A statement as relations over a box of real variables, and the test of one point."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

from mpmath import mp, mpf

from tests.statement_fuzz.oracle import exact
from tests.statement_fuzz.oracle.evaluate import Evaluation, Signs, Tree, nodes
from tests.statement_fuzz.oracle.numbers import DIGITS, Num, Undefined, Unsure, Value, sign

Point = dict[str, Value]
MORE_DIGITS = 250
LONGEST = 60


@dataclass(frozen=True)
class Objection:
    """Why a statement is not true: it is ``false`` or ``undefined`` at a place."""

    what: str
    place: str

    def __str__(self) -> str:
        return f"{self.what} at {self.place}"


@dataclass(frozen=True)
class Axis:
    """A variable between two ends; ``None`` is infinity."""

    name: str
    low: Fraction | None = None
    high: Fraction | None = None
    open_low: bool = False
    open_high: bool = False

    def holds(self, value: Value) -> bool:
        """Whether a number certainly lies between the ends."""
        try:
            above = self.low is None or sign(value - self.low) > -1 + self.open_low
            return above and (self.high is None or sign(self.high - value) > -1 + self.open_high)
        except Unsure:
            return False


@dataclass(frozen=True)
class Relation:
    """``left operator right`` with ``<=``, ``<`` or ``=``."""

    left: Tree
    operator: str
    right: Tree


@dataclass
class Region:
    """At every point of the box: where the hypotheses hold, so do all claims; and every term is defined.

    ``signs`` keeps, for each divisor, a point of either sign. All parts of it are continuous where they are
    defined, and the box is convex: on the way from one to the other something is undefined.
    """

    axes: tuple[Axis, ...]
    claims: tuple[Relation, ...]
    hypotheses: tuple[Relation, ...] = ()
    signs: dict[Tree, dict[int, Point]] = field(default_factory=dict)

    def terms(self) -> list[Tree]:
        """Both sides of everything."""
        return [side for r in (*self.hypotheses, *self.claims) for side in (r.left, r.right)]

    def nodes(self) -> Iterator[Tree]:
        """All parts of all terms."""
        return nodes(*self.terms())

    def objection(self, point: Point) -> Objection | None:
        """What is wrong at a point of the box, as far as that is certain."""
        if not all(axis.holds(point[axis.name]) for axis in self.axes):
            return None
        for forms in (False, True):
            try:
                with exact.kept(forms):
                    return self._at(point)
            except Unsure:
                continue
        return None

    def _at(self, point: Point) -> Objection | None:
        evaluation = Evaluation(point)
        try:
            values = evaluation.parts(self.terms())
        except Undefined as why:
            return Objection("undefined", f"{shown(point)} ({why})")
        finally:
            crossed = self._note(evaluation.divisors, point)
        if crossed is not None:
            return crossed
        if self._breaks(values):
            return Objection("false", shown(point))
        return None

    def _note(self, divisors: Signs, point: Point) -> Objection | None:
        for divisor, side in divisors.items():
            if side:
                known = self.signs.setdefault(divisor, {})
                known.setdefault(side, point)
                if -side in known:
                    ends = f"{shown(known[1])} and {shown(known[-1])}"
                    return Objection("undefined", f"a point between {ends} (a divisor changes its sign)")
        return None

    def _breaks(self, values: list[Value]) -> bool:
        """Whether the hypotheses certainly hold and some claim certainly does not."""
        pairs = list(zip(values[::2], values[1::2], strict=True))
        first = len(self.hypotheses)
        outcomes: list[bool | Unsure] = []
        for relation, pair in zip(self.claims, pairs[first:], strict=True):
            try:
                outcomes.append(holds(relation.operator, *pair))
            except Unsure as problem:
                outcomes.append(problem)
        if all(outcome is True for outcome in outcomes):
            return False
        given = zip(self.hypotheses, pairs, strict=False)
        if not all(holds(r.operator, *pair) for r, pair in given):
            return False
        if any(outcome is False for outcome in outcomes):
            return True
        raise Unsure

    def fails_at(self, point: Mapping[str, Fraction]) -> bool | None:
        """Whether a point is a counterexample; ``None`` where that is too close to call."""
        if not all(axis.name in point and axis.holds(point[axis.name]) for axis in self.axes):
            return False
        for digits, forms in ((DIGITS, False), (DIGITS, True), (MORE_DIGITS, False)):
            try:
                with mp.workdps(digits), exact.kept(forms):
                    return self._breaks(Evaluation(point).parts(self.terms()))
            except Undefined:
                return False
            except Unsure:
                continue
        return None


def holds(operator: str, left: Value, right: Value) -> bool:
    """Whether a relation between numbers holds.

    Raises:
        Unsure: they are too close.
    """
    gap = right - left
    if operator == "<=" and isinstance(gap, Num) and gap.low >= 0:
        return True
    side = sign(gap)
    return side == 0 if operator == "=" else side > 0 or (side == 0 and operator == "<=")


def shown(point: Mapping[str, Any]) -> str:
    """A point in words."""
    return ", ".join(f"{name} = {_text(value)}" for name, value in point.items()) or "every point"


def _text(value: Any) -> str:
    if isinstance(value, Num):
        return f"{mp.nstr(value.low, 12)}…"
    text = str(value)
    short = len(text) <= LONGEST
    return text if short else f"about {mp.nstr(mpf(value.numerator) / value.denominator, 12)}"
