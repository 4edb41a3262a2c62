"""Identities and bounds in vectors and matrices, at rational entries of which all that is given holds."""

from fractions import Fraction
from itertools import product
from math import isqrt, prod

import numpy as np
from mpmath import mp

from tests import oracle
from tests.oracle import Objection
from tests.oracle.boxes import holds
from tests.oracle.numbers import DIGITS, Num, Undefined, Unsure, apply, divide, power, sign
from tests.oracle.trees import Evaluation, names, nodes

SORTS = ("var", "vec", "mat")
SIZES, TRIES, BORDERS = (1, 2, 3), 6, 40


class Dual:
    """A number that moves, with its speed."""

    def __init__(self, value, speed=Fraction(0)):
        self.value, self.speed = value, speed

    def __add__(self, other):
        other = _dual(other)
        return Dual(self.value + other.value, self.speed + other.speed)

    __radd__ = __add__

    def __neg__(self):
        return Dual(-self.value, -self.speed)

    def __mul__(self, other):
        other = _dual(other)
        return Dual(self.value * other.value, self.value * other.speed + self.speed * other.value)

    __rmul__ = __mul__


def _dual(value):
    return value if isinstance(value, Dual) else Dual(value)


SLOPES = {
    "log": lambda x, of: divide(Fraction(1), x),
    "exp": lambda x, of: of,
    "sqrt": lambda x, of: divide(Fraction(1, 2), of),
    "sin": lambda x, of: apply("cos", x),
    "cos": lambda x, of: -apply("sin", x),
}


class Entries(Evaluation):
    """Expressions in numbers, vectors and matrices at values of the letters, as arrays of numbers."""

    def __init__(self, values, n, rates):
        super().__init__({})
        self.values, self.n, self.rates = values, n, dict(rates)

    def node(self, kind, *rest):
        if kind in SORTS:
            return self.values[kind, rest[0]]
        if kind in ("diag", "transpose"):
            return _diagonal(self.values["vec", rest[0]]) if kind == "diag" else self.of(rest[0]).T
        if kind in PRODUCTS:
            return PRODUCTS[kind](*self.parts(rest))
        if kind == "sum":
            return sum(self.parts(rest)) if rest else np.array([Fraction(0)] * self.n)
        if kind == "rate":
            return _dual(self._moving().of(rest[0])).speed
        return super().node(kind, *rest)

    def applied(self, name, x):
        if not isinstance(x, Dual):
            return apply(name, x)
        if name not in SLOPES:
            raise Unsure
        value = apply(name, x.value)
        return Dual(value, SLOPES[name](x.value, value) * x.speed)

    def power(self, base, k):
        return prod([base] * k, start=Fraction(1)) if isinstance(base, Dual) else power(base, k)

    def quotient(self, divisor, top, bottom):
        if not isinstance(top, Dual) and not isinstance(bottom, Dual):
            return divide(top, bottom)
        top, bottom = _dual(top), _dual(bottom)
        value = divide(top.value, bottom.value)
        return Dual(value, divide(top.speed - value * bottom.speed, bottom.value))

    def _moving(self):
        """The same letters with their speeds."""
        moved = dict(self.values)
        for letter, speed in self.rates.items():
            if letter in moved:
                nothing = _times(moved[letter], Fraction(0))  # an empty sum is of any shape
                moved[letter] = _each(Dual, moved[letter], nothing if speed == ("sum",) else self.of(speed))
        return Entries(moved, self.n, {})

    def __str__(self):
        shown = (f"{name} = {_each(str, value)}" for (_, name), value in self.values.items())
        return f"n = {self.n}, " + ", ".join(shown)


def _each(function, *arrays):
    """A function of each entry."""
    if not isinstance(arrays[0], np.ndarray):
        return function(*arrays)
    result = np.empty(arrays[0].shape, object)
    for place in np.ndindex(result.shape):
        result[place] = function(*(array[place] for array in arrays))
    return result


def _times(array, factor):
    return _each(lambda x: x * factor, array)


def _diagonal(x):
    return np.array([[a if i == j else Fraction(0) for j in range(len(x))] for i, a in enumerate(x)])


PRODUCTS = {
    **dict.fromkeys(("dot", "apply"), lambda left, right: left @ right),
    "scale": lambda factor, array: _times(array, factor),
}


def letters(*trees):
    """The letters of expressions."""
    found = {
        ("vec" if node[0] == "diag" else node[0], node[1])
        for node in nodes(*trees)
        if node[0] in (*SORTS, "diag")
    }
    return sorted(found)


def _letters_of(statement):
    trees = [statement.left, statement.right, *(tree for pair in statement.rates for tree in pair)]
    for known in statement.given:
        trees += [known.equals, ("mat", known.matrix), ("vec", known.vector)]
    for known, size in getattr(statement, "norms", ()):
        trees += [*known, size]
    for pair in getattr(statement, "least", ()):
        trees += pair
    return letters(*trees)


def _shaped(sort, n, entry):
    if sort == "var":
        return entry()
    return _each(lambda _: entry(), np.empty((n,) * SORTS.index(sort), object))


def _symmetric(rows, wanted):
    return (
        np.array([[rows[min(i, j), max(i, j)] for j in range(len(rows))] for i in range(len(rows))])
        if wanted
        else rows
    )


def _drawn(statement, n, random, style):
    """Values of the letters: anything (0), zeros among them (1), equal vectors (2)."""
    values, positive = {}, set(getattr(statement, "positive", ()))

    def entry():
        zero = style == 1 and random.random() < 0.6
        return Fraction(0 if zero else random.randint(-5, 5), random.randint(1, 3))

    for sort, name in _letters_of(statement):
        value = _shaped(sort, n, entry)
        if sort == "var" and name in positive:
            value = abs(value) + Fraction(1, 2)
        values[sort, name] = _symmetric(value, sort == "mat" and name in statement.symmetric)
    if style == 2:
        vectors = [letter for letter in values if letter[0] == "vec"]
        values |= dict.fromkeys(vectors, values[vectors[0]] if vectors else None)
    return values


def _solved(statement, values, n):
    """The values with each vector for which A x = b is given solved for; None: A is singular."""
    for known in statement.given:
        x = _solution(values["mat", known.matrix], Entries(values, n, statement.rates).of(known.equals))
        if x is None:
            return None
        values = {**values, ("vec", known.vector): x}
    return values


def _solution(rows, right):
    table = np.concatenate([rows, right[:, None]], axis=1)
    n = len(rows)
    for k in range(n):
        pivot = next((i for i in range(k, n) if table[i, k]), None)
        if pivot is None:
            return None
        table[[k, pivot]] = table[[pivot, k]]
        table[k] = table[k] / table[k, k]
        for i in range(n):
            if i != k:
                table[i] = table[i] - table[k] * table[i, k]
    return table[:, -1]


def _meets(statement, at):
    """Whether all that is given holds, and symmetric matrices keep being so."""
    for known in statement.given:
        if any(at.of(("apply", ("mat", known.matrix), ("vec", known.vector))) != at.of(known.equals)):
            return False
    moving = [at.of(value) for (_, name), value in statement.rates if name in statement.symmetric]
    return all((rows == rows.T).all() for rows in moving)


def _read(statement, point):
    """The values of a witness; an entry that it does not give does not matter and is 1."""
    point = dict(point)
    n, values = int(point.pop("n")), {}
    for sort, name in _letters_of(statement):
        if sort == "var":
            values[sort, name] = Fraction(point.get(name, "1"))
            continue
        value = np.empty((n,) * SORTS.index(sort), object)
        for place in np.ndindex(value.shape):
            own = sorted(place) if name in statement.symmetric else place
            value[place] = Fraction(point.get(f"{name}[{','.join(str(i + 1) for i in own)}]", "1"))
        values[sort, name] = value
    return Entries(values, n, statement.rates)


def _wrong(statement, at, operator):
    """The objection at entries that meet what is given, if there is one."""
    try:
        if holds(operator, *at.parts((statement.left, statement.right))):
            return None
    except Undefined as why:
        return Objection("undefined", f"{at} ({why})")
    except Unsure:
        return None
    return Objection("false", str(at))


@oracle.objections_to("EveryN")
def _every_n(statement, random):
    """Entries at which the sides differ, or one of them is undefined."""
    with mp.workdps(DIGITS):
        for k, n in product(range(TRIES), SIZES):
            values = _solved(statement, _drawn(statement, n, random, k % 3), n)
            at = None if values is None else Entries(values, n, statement.rates)
            if at is not None and _meets(statement, at) and (found := _wrong(statement, at, "=")) is not None:
                return found
    return None


@oracle.judges("EveryN")
def _entries_refute(statement, point):
    at = _read(statement, point)
    try:
        with mp.workdps(DIGITS):
            inside = all(at.values.get(("var", name), 1) > 0 for name in getattr(statement, "positive", ()))
            equal = holds("=", *at.parts((statement.left, statement.right)))
            return inside and _meets(statement, at) and not equal
    except Undefined:
        return False
    except Unsure:
        return None


# Upper bounds: letters scaled to the border of what the norms allow -----------------------------------------


@oracle.objections_to("BoundEveryN")
def _bound_every_n(statement, random):
    with mp.workdps(DIGITS):
        for k in range(BORDERS):
            n = (1, 1, 2)[k % 3]
            values = {
                (sort, name): _sharp(sort, n, random, name in statement.symmetric)
                for sort, name in _letters_of(statement)
            }
            try:
                at = _at_the_border(statement, values, n, random)
                found = None if at is None else _wrong(statement, at, "<=")
            except Undefined as why:
                found = Objection("undefined", f"{Entries(values, n, ())} ({why})")
            except Unsure:
                continue
            if found is not None:
                return found
    return None


def _at_the_border(statement, values, n, random):
    """The letters as large as the norms allow, or half; ``None`` where something that is given fails."""
    for known, size in statement.norms:
        allowed, total = Entries(values, n, statement.rates).of(size), prod(_norms(values, known))
        if sign(allowed) < 0:
            return None
        if known and not isinstance(allowed, Num) and total:
            key = ("vec" if known[0][0] == "diag" else known[0][0], known[0][1])
            share = random.choice((1, 1, 1, Fraction(1, 2)))
            values = {**values, key: _times(values[key], share * allowed / total)}
    values = _solved(statement, values, n)
    if values is None:
        return None
    at = Entries(values, n, statement.rates)
    within = all(holds("<=", prod(_norms(values, known)), at.of(size)) for known, size in statement.norms)
    least = all(holds("<=", at.of(low), at.of(number)) for number, low in statement.least)
    return at if within and least and _meets(statement, at) else None


def _sharp(sort, n, random, symmetric):
    """Numbers >= 0, vectors along an axis, and multiples of rotations or reflections: norms are rational."""
    side = Fraction(random.choice((1, -1)))
    if sort == "var":
        return Fraction(random.choice((0, 1, 1, 2, 5, 9)), random.choice((1, 2, 3)))
    if sort == "vec":
        axis = random.randrange(n)
        return np.array([side if k == axis else Fraction(0) for k in range(n)])
    if n == 1:
        return np.array([[side]])
    a, b = random.choice(((Fraction(3, 5), Fraction(4, 5)), (Fraction(0), Fraction(1)), (side, Fraction(0))))
    reflected = symmetric or random.random() < 0.5
    return np.array([[a, b], [b, -a]] if reflected else [[a, -b], [b, a]])


def _norms(values, known):
    """The norms of what :func:`_sharp` makes, and of diagonal matrices."""
    for letter in known:
        value = values["vec" if letter[0] == "diag" else letter[0], letter[1]]
        if letter[0] in ("diag", "var"):
            yield max(map(abs, np.ravel(value)), default=Fraction(0))
            continue
        if (
            letter[0] == "mat"
            and (value @ value.T != np.eye(len(value), dtype=int) * (value[0] @ value[0])).any()
        ):
            raise Unsure
        square = value @ value if letter[0] == "vec" else value[0] @ value[0]
        root = Fraction(isqrt(square.numerator), isqrt(square.denominator))
        if root * root != square:
            raise Unsure
        yield root


@oracle.judges("BoundEveryN")
def _entries_break(statement, point):
    """Whether entries break a bound while the norms hold; ``None`` for matrices whose norm is not plain."""
    at = _read(statement, point)
    sizes = names(statement.right, *(size for _, size in (*statement.norms, *statement.least)))
    if any(at.values["var", name] < 0 for name in sizes):
        return False
    try:
        with mp.workdps(DIGITS):
            least = all(holds("<=", at.of(low), at.of(number)) for number, low in statement.least)
            if (
                not least
                or not _meets(statement, at)
                or holds("<=", *at.parts((statement.left, statement.right)))
            ):
                return False
            # with Frobenius norms for those of matrices
            fits = []
            for known, size in statement.norms:
                squares = [
                    max(x * x for x in at.values["vec", one[1]])
                    if one[0] == "diag"
                    else sum(x * x for x in np.ravel(at.values[one[0], one[1]]))
                    for one in known
                ]
                allowed = at.of(size)
                fits.append(sign(allowed) >= 0 and holds("<=", prod(squares), power(allowed, 2)))
            return True if all(fits) else None
    except Undefined:
        return False
    except Unsure:
        return None
