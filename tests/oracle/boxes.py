"""The kinds of statement that are relations over a box of real variables, and the test of one point."""

from dataclasses import dataclass, field
from decimal import Decimal
from fractions import Fraction
from random import Random

from mpmath import mp

from tests import oracle
from tests.oracle import Objection
from tests.oracle.numbers import DIGITS, MORE, Num, Undefined, Unsure, ends, interval, sign
from tests.oracle.points import candidates
from tests.oracle.trees import Evaluation, names, nodes

CELLS, SAMPLES = 64, 200


@dataclass(frozen=True)
class Axis:
    """A variable between two ends; ``None`` is infinity."""

    name: str
    low: Fraction | None = None
    high: Fraction | None = None
    open_low: bool = False
    open_high: bool = False

    def holds(self, value):
        """Whether a number certainly lies between the ends."""
        try:
            above = self.low is None or sign(value - self.low) > -1 + self.open_low
            return above and (self.high is None or sign(self.high - value) > -1 + self.open_high)
        except Unsure:
            return False


@dataclass
class Region:
    """At every point of the box where the hypotheses hold, all claims do; and every term is defined.

    A relation is (left, operator, right). ``signs`` keeps, for each divisor, a point of either sign. All
    parts are continuous where they are defined, and the box is convex: between two something is undefined.
    """

    axes: tuple
    claims: tuple
    hypotheses: tuple = ()
    signs: dict = field(default_factory=dict)

    def terms(self):
        """Both sides of everything."""
        return [side for left, _, right in (*self.hypotheses, *self.claims) for side in (left, right)]

    def nodes(self):
        """All parts of all terms."""
        return nodes(*self.terms())

    def objection(self, point, digits=(DIGITS, MORE)):
        """What is wrong at a point of the box, as far as that is certain."""
        for many in digits:
            try:
                with mp.workdps(many):
                    at = {name: numbered(value) for name, value in point.items()}
                    return self._at(at) if all(axis.holds(at[axis.name]) for axis in self.axes) else None
            except Unsure:
                continue
        return None

    def _at(self, point):
        evaluation = Evaluation(point)
        try:
            values = evaluation.parts(self.terms())
        except Undefined as why:
            return Objection("undefined", f"{shown(point)} ({why})")
        finally:
            crossed = self._note(evaluation.divisors, point)
        if crossed is not None:
            return crossed
        return Objection("false", shown(point)) if self._breaks(values) else None

    def _note(self, divisors, point):
        for divisor, side in divisors.items():
            known = self.signs.setdefault(divisor, {})
            if side:
                known.setdefault(side, point)
            if {1, -1} <= set(known):
                where = f"a point between {shown(known[1])} and {shown(known[-1])}"
                return Objection("undefined", f"{where} (a divisor changes its sign)")
        return None

    def _breaks(self, values):
        """Whether the hypotheses certainly hold and some claim certainly does not."""
        relations = (*self.hypotheses, *self.claims)
        pairs = zip(relations, values[::2], values[1::2], strict=True)
        sure = [_sure(operator, left, right) for (_, operator, _), left, right in pairs]
        given, wanted = sure[: len(self.hypotheses)], sure[len(self.hypotheses) :]
        if all(wanted) or False in given:
            return False
        if None in given or False not in wanted:
            raise Unsure
        return True

    def fails_at(self, point):
        """Whether a point is a counterexample; ``None`` where that is too close to call."""
        if not all(axis.name in point and axis.holds(point[axis.name]) for axis in self.axes):
            return False
        for digits in (DIGITS, MORE):
            try:
                with mp.workdps(digits):
                    return self._breaks(Evaluation(point).parts(self.terms()))
            except Undefined:
                return False
            except Unsure:
                continue
        return None


def _sure(*relation):
    try:
        return holds(*relation)
    except Unsure:
        return None


def holds(operator, left, right):
    """Whether a relation between numbers holds; raises ``Unsure`` where they are too close."""
    gap = right - left
    if operator == "<=" and isinstance(gap, Num) and gap.low >= 0:
        return True
    side = sign(gap)
    return side == 0 if operator == "=" else side > 0 or (side == 0 and operator == "<=")


def numbered(value):
    """The number of a coordinate, which may be an expression such as √2 or π/2."""
    return Evaluation({}).of(value) if isinstance(value, tuple) else value


def shown(point):
    """A point in words."""
    return ", ".join(f"{name} = {_text(value)}" for name, value in point.items()) or "every point"


def _text(value):
    text = f"{mp.nstr(value.low, 12)}…" if isinstance(value, Num) else str(value)
    return text if len(text) <= 60 else f"about {float(value):.12g}"


def objection_in(region, random):
    """The first objection that a point gives; ``None`` says nothing."""
    with mp.workdps(DIGITS):
        found = map(region.objection, candidates(region, random))
        return next((one for one in found if one is not None), None)


# What each kind means ---------------------------------------------------------------------------------------


def relation(r):
    """As a triple."""
    return r.left, r.operator, r.right


def axes_of(variables):
    """Of declared variables, from their lower bounds on."""
    return tuple(Axis(v.name, v.low, open_low=v.low is not None and v.strict) for v in variables)


def _reals(*trees, but=()):
    taken = {axis.name for axis in but}
    return (*but, *(Axis(name) for name in sorted(names(*trees) - taken)))


def _identity(s):
    return Region(_reals(s.left, s.right, but=axes_of(s.variables)), ((s.left, "=", s.right),))


def _norm_bound(s):
    entries = [("var", f"x{k + 1}") for k in range(s.n)]
    of = [("pow", _put(s.component, entry), 2) for entry in entries]
    right = s.bound
    if s.power:
        right = ("mul", right, ("sqrt", ("add", *(("pow", entry, 2) for entry in entries))))
    return Region(tuple(Axis(entry[1]) for entry in entries), ((("sqrt", ("add", *of)), "<=", right),))


def _put(tree, entry):
    if tree[0] == "var":
        return entry
    return tuple(_put(part, entry) if isinstance(part, tuple) else part for part in tree)


REGIONS = {
    "Identity": _identity,
    "ForAll": lambda s: Region(
        (Axis(s.variable, s.low, s.high, s.open_low, s.open_high),), (relation(s.relation),)
    ),
    "Constant": lambda s: Region((), (relation(s.relation),)),
    "Implies": lambda s: Region(
        axes_of(s.variables), (relation(s.conclusion),), tuple(map(relation, s.hypotheses))
    ),
    "NormBound": _norm_bound,
}


@oracle.objections_to(*REGIONS)
def _look(statement, random):
    return objection_in(REGIONS[type(statement).__name__](statement), random)


@oracle.judges(*REGIONS)
def _judge(statement, point):
    region = REGIONS[type(statement).__name__](statement)
    return region.fails_at({name: Fraction(text) for name, text in point.items()})


def _any(outcomes):
    outcomes = list(outcomes)
    return True if True in outcomes else None if None in outcomes else False


@oracle.objections_to("AllOf")
def _look_at_parts(statement, random):
    found = (oracle.objection(part, random.getrandbits(32)) for _, part in statement.parts)
    return next((one for one in found if one is not None), None)


@oracle.judges("AllOf")
def _judge_parts(statement, point):
    return _any(oracle.confirms(part, point) for _, part in statement.parts)


# Printed numbers: the formula over all roundings of its inputs ----------------------------------------------


def _rounding(text):
    half = Fraction(10) ** int(Decimal(text).as_tuple().exponent) / 2
    return Fraction(text) - half, Fraction(text) + half


@oracle.objections_to("Agrees")
def _agrees(statement, random):
    """Every part of the box of inputs gives results outside the printed one; or none gives a result."""
    low, high = ends(interval(*_rounding(statement.printed)))
    parts = [{name: _rounding(text) for name, text in statement.inputs}]
    values = [_printed_at(statement, point) for point in _some_inputs(statement, 12)]
    if all(value == "undefined" for value in values):
        return Objection("undefined", "all inputs within their roundings")
    for name in list(parts[0]) * 3:
        if len(parts) * 2 <= CELLS:
            parts = [half for part in parts for half in _halves(part, name)]
    undefined = 0
    for part in parts:
        value = _printed_at(statement, {name: interval(*pair) for name, pair in part.items()})
        undefined += value == "undefined"
        if value is None or (value != "undefined" and value[0] <= high and low <= value[1]):
            return None
    return Objection("undefined" if undefined == len(parts) else "false", "all inputs within their roundings")


def _printed_at(statement, point):
    try:
        with mp.workdps(DIGITS):
            return ends(Evaluation(point).of(statement.formula))
    except Undefined:
        return "undefined"
    except Unsure:
        return None


def _halves(part, name):
    low, high = part[name]
    middle = (low + high) / 2
    return {**part, name: (low, middle)}, {**part, name: (middle, high)}


def _some_inputs(statement, count):
    random = Random(1)
    box = {name: _rounding(text) for name, text in statement.inputs}
    for _ in range(count if box else 1):
        yield {name: a + (b - a) * Fraction(random.randint(0, 100), 100) for name, (a, b) in box.items()}


@oracle.judges("Agrees")
def _disagrees(statement, point):
    """Whether no inputs give the printed result; too coarse an enclosure leaves it open."""
    found = _agrees(statement, Random(0))
    if found is not None:
        return found.what == "false"
    low, high = ends(interval(*_rounding(statement.printed)))
    values = (_printed_at(statement, point) for point in _some_inputs(statement, SAMPLES))
    reached = any(
        value not in (None, "undefined") and low <= value[0] and value[1] <= high for value in values
    )
    return False if reached else None
