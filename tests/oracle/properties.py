"""What V and the loop need of h and U in one variable: points at which a property certainly fails."""

from fractions import Fraction

from mpmath import mp

from tests import oracle
from tests.oracle import Objection
from tests.oracle.numbers import DIGITS, Undefined, Unsure, ends
from tests.oracle.trees import Evaluation

NEAR = Fraction(1, 10**15)
TOLERANCE = Fraction(1, 10**9)
PLACES = (*map(Fraction, (1, 2, 3, 5, 10, 40)), *(Fraction(1, 10**k) for k in (1, 3, 6)), Fraction(22, 7))


class Failing(Exception):
    """A property that does not hold, with the place."""


class Functions:
    """h, h' and U at points; middles of enclosures."""

    def __init__(self, member):
        self.trees = {"h": member.value, "slope": member.slope, "potential": member.potential}

    def at(self, name, x):
        """A value.

        Raises:
            Unsure: it is not known.
            Undefined: there is none.
        """
        low, high = ends(Evaluation({"x": x}).of(self.trees[name]))
        return (low + high) / 2

    def sign(self, name, x):
        """The sign of a value, 0 only where it is 0 for all that 60 digits tell."""
        low, high = ends(Evaluation({"x": x}).of(self.trees[name]))
        if low <= 0 <= high and high - low > mp.mpf(10) ** -40:
            raise Unsure
        return 0 if low <= 0 <= high else 1 if low > 0 else -1


@oracle.objections_to("Property")
def of_a_loop(statement, random):
    """A point at which a part is undefined, the slope is not that of h, or the property fails."""
    own = [Fraction(random.randint(1, 10**4), 1000) for _ in range(4)]
    points = sorted({sign * x for x in (*PLACES, *own) for sign in (1, -1)} | {Fraction(0)})
    of = Functions(statement.argument.system.functions[0].member)
    with mp.workdps(DIGITS):
        for x in points:
            try:
                for name in of.trees:
                    of.at(name, x)
                _require_slope(of, x)
                _require(statement.name, of, x)
            except Undefined as why:
                return Objection("undefined", f"x = {x} ({why})")
            except Failing as why:
                return Objection("false", f"x = {float(x)}: {why}")
            except Unsure:
                continue
    return None


def _require_slope(of, x):
    before, here, after = (of.at("h", x + k * NEAR) for k in (-1, 0, 1))
    left, right = (here - before) * 10**15, (after - here) * 10**15
    size = TOLERANCE.numerator * (1 + abs(left) + abs(right)) / TOLERANCE.denominator
    if abs(left - right) > size:
        raise Failing("h has a corner")
    if abs((left + right) / 2 - of.at("slope", x)) > size:
        raise Failing("the slope is not that of h")


def _require(what, of, x):
    """What the property needs at one point.

    Raises:
        Failing: it is not so.
    """
    if "equilibrium" in what:
        if x == 0 and of.sign("h", x) != 0:
            raise Failing("h(0) is not 0")
        if "only" in what and x and of.sign("h", x) * of.sign("h", _near_zero(x)) <= 0:
            raise Failing("h is 0 there, or between 0 and there")
    elif "decrescent" in what or "positive definite" in what:
        if x == 0 and of.sign("potential", x) != 0:
            raise Failing("U(0) is not 0")
        if "decrescent" not in what and x and of.sign("potential", x) <= 0:
            raise Failing("U is not positive")
    elif "unbounded" in what and x:
        far, farther = (of.at("potential", _far(x, k)) for k in (1, 3))
        if (farther - far) * 100 < 1:
            raise Failing("U does not grow")


def _near_zero(x):
    return Fraction(1 if x > 0 else -1, 1000)


def _far(x, digits):
    return Fraction((1 if x > 0 else -1) * 10**digits)
