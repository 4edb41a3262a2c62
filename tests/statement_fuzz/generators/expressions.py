"""Expressions to build statements from; parts that are undefined somewhere, and ways to hide them."""

from fractions import Fraction

from lyapcheck.claims import Relation

SMOOTH = ("sin", "cos", "exp", "sinh", "cosh", "tanh", "atan")
PARTIAL = ("sqrt", "log", "tan", "asin", "acos")


def num(value):
    return ("num", str(Fraction(value)))


def var(name):
    return ("var", name)


def add(*parts):
    return ("add", *parts) if len(parts) > 1 else parts[0]


def mul(*parts):
    return ("mul", *parts) if len(parts) > 1 else parts[0]


def neg(a):
    return ("neg", a)


def sub(a, b):
    """A difference, as scripts write it."""
    return ("add", a, ("neg", b))


def div(a, b):
    return ("div", a, b)


def power(a, k):
    return ("pow", a, k)


def root(a):
    return ("sqrt", a)


ZERO, ONE, TWO = num(0), num(1), num(2)


def le(a, b):
    return Relation(a, "<=", b)


def lt(a, b):
    return Relation(a, "<", b)


def relation(random, a, b):
    """a <= b or a < b."""
    return Relation(a, random.choice(("<=", "<")), b)


def small_number(random):
    """What users write: small integers and short fractions, now and then a huge or tiny number."""
    kind = random.random()
    if kind < 0.6:
        return Fraction(random.randint(-6, 6))
    if kind < 0.95:
        return Fraction(random.randint(-20, 20), random.choice((2, 3, 4, 5, 10, 100)))
    return Fraction(random.choice((1, -1)) * 10 ** random.choice((6, 9, 30))) ** random.choice((1, -1))


def nonzero(random):
    """The same, not 0."""
    value = small_number(random)
    return value if value else Fraction(1)


def positive(random):
    """The same, above 0."""
    return abs(nonzero(random))


def smooth(random, names, depth=2):
    """An expression that is defined everywhere."""
    if depth == 0 or random.random() < 0.15:
        if not names or random.random() < 0.35:
            return constant(random) if random.random() < 0.3 else num(small_number(random))
        return var(random.choice(names))
    a, b = smooth(random, names, depth - 1), smooth(random, names, depth - 1)
    shapes = (
        *((kind, a, b) for kind in ("add", "add", "mul", "mul")),
        neg(a),
        power(a, random.choice((0, 1, 2, 2, 3, 4))),
        (random.choice((*SMOOTH, "abs")), a),
        div(a, add(power(b, 2), num(positive(random)))),
        (random.choice(("h", "dh", "potential")), random.choice((1, 2, 3)), a),
    )
    return random.choice(shapes)


def constant(random):
    """A number with a name."""
    return random.choice(
        (
            ("pi",),
            ("gamma", random.randint(1, 4)),
            ("rho", random.randint(1, 3)),
            ("L", random.randint(1, 3)),
            root(num(random.choice((2, 3, 5, 6, 8, 12, Fraction(1, 2), Fraction(4, 9))))),
            ("exp", num(random.choice((1, 2, -1)))),
            ("log", num(random.choice((2, 3, 4)))),
        )
    )


def rough(random, names, depth=2):
    """An expression that may be undefined somewhere."""
    if depth == 0:
        return smooth(random, names, 1)
    kind = random.choice(("smooth", "partial", "div", "add", "mul", "double", "power 0"))
    a = rough(random, names, depth - 1)
    if kind == "smooth":
        return smooth(random, names, depth)
    if kind == "partial":
        return (random.choice(PARTIAL), a)
    if kind == "double":
        return div(ONE, div(ONE, a))
    if kind == "power 0":
        return power(a, random.choice((0, 0, 2)))
    b = rough(random, names, depth - 1)
    return div(a, b) if kind == "div" else (kind, a, b)


# Laws of functions, as pairs of expressions -----------------------------------------------------------------


def everywhere(a, b):
    """Laws that hold wherever a and b have values, and have values there."""
    return (
        (root(power(a, 2)), ("abs", a)),
        (add(power(("sin", a), 2), power(("cos", a), 2)), ONE),
        (("sin", mul(TWO, a)), mul(TWO, ("sin", a), ("cos", a))),
        (("sinh", mul(TWO, a)), mul(TWO, ("sinh", a), ("cosh", a))),
        (power(("cosh", a), 2), add(ONE, power(("sinh", a), 2))),
        (("tanh", a), div(("sinh", a), ("cosh", a))),
        (("h", 1, a), ("tanh", a)),
        (("exp", add(a, b)), mul(("exp", a), ("exp", b))),
        (("sin", neg(a)), neg(("sin", a))),
        (("atan", neg(a)), neg(("atan", a))),
        (("cos", neg(a)), ("cos", a)),
        (("abs", neg(a)), ("abs", a)),
        (("abs", mul(a, b)), mul(("abs", a), ("abs", b))),
        (("log", ("exp", a)), a),
        (("sin", add(a, b)), add(mul(("sin", a), ("cos", b)), mul(("cos", a), ("sin", b)))),
        (power(add(a, b), 2), add(power(a, 2), mul(TWO, a, b), power(b, 2))),
        (div(a, add(ONE, power(b, 2))), mul(a, div(ONE, add(ONE, power(b, 2))))),
    )


def somewhere(a, b, k):
    """Laws with a side that may have no value, or another one; k is a number that is not 0."""
    return (
        (power(root(a), 2), a),
        (mul(root(a), root(b)), root(mul(a, b))),
        (("exp", ("log", a)), a),
        (("log", mul(a, b)), add(("log", a), ("log", b))),
        (("log", power(a, 2)), mul(TWO, ("log", a))),
        (div(a, a), ONE),
        (div(ONE, div(ONE, a)), a),
        (("tan", a), div(("sin", a), ("cos", a))),
        (mul(("tan", a), ("cos", a)), ("sin", a)),
        (("sin", ("asin", a)), a),
        (("asin", ("sin", a)), a),
        (root(power(a, 2)), a),
        (sub(("log", a), ("log", a)), num(0)),
        (power(("log", a), 0), ONE),
        (power(a, 0), ONE),
        (div(sub(power(a, 2), power(b, 2)), sub(a, b)), add(a, b)),
        (add(("asin", a), ("acos", a)), div(("pi",), TWO)),
        (mul(k, div(a, k)), a),
        (div(power(a, 3), a), power(a, 2)),
        (("abs", a), a),
        (("atan", ("tan", a)), a),
        (add(div(a, b), div(b, a)), div(add(power(a, 2), power(b, 2)), mul(a, b))),
        (div(div(a, b), div(a, b)), ONE),
        (mul(ZERO, ("log", a)), ZERO),
        (root(div(a, b)), div(root(a), root(b))),
    )


# Traps ------------------------------------------------------------------------------------------------------


def hidden_zero(random, names):
    """An expression that is 0 at every point, though it may take a law to see it."""

    def some():
        return smooth(random, names, 1) if names else num(random.choice((1, 2, 3, Fraction(1, 2), -2)))

    one, other, k = some(), some(), random.choice((2, 3, 10))
    c = num(random.choice((2, 3, 5, Fraction(1, 2), Fraction(7, 3))))
    a, b = random.choice(((2, 3), (2, 8), (3, 12), (5, 7)))
    two, three, nested, pi = root(TWO), root(num(3)), root(add(ONE, root(TWO))), ("pi",)
    laws = [sub(*law) for law in everywhere(one, other)]
    kinds = (
        [sub(one, one)],
        [sub(power(root(c), 2), c)],
        [sub(mul(root(num(a)), root(num(b))), root(num(a * b)))],
        [sub(mul(power(nested, 2), two), add(two, TWO))],
        [sub(root(add(num(4), mul(TWO, three))), add(ONE, three))],
        [sub(root(num(2 * k * k)), mul(num(k), two))],
        [sub(("log", num(4)), mul(TWO, ("log", TWO))), sub(("exp", ("log", num(3))), num(3)), ("log", ONE)],
        [
            *(sub(mul(num(4), ("atan", ONE)), pi), sub(mul(TWO, ("asin", ONE)), pi)),
            add(("asin", num("1/3")), ("acos", num("1/3")), neg(div(pi, TWO))),
            *(("sin", pi), ("cos", div(pi, TWO)), add(ONE, ("cos", pi))),
        ],
        *[laws] * 4,
        [*(("h", 2, ZERO), ("potential", 3, ZERO)), sub(("gamma", 1), ONE), sub(("L", 1), ("rho", 1))],
        [mul(ZERO, one), sub(mul(one, other), mul(other, one))],
    )
    return random.choice(random.choice(kinds))


def undefined_number(random):
    """A number that is none: a quotient by 0, the root or the logarithm of what it does not exist for."""
    zero = hidden_zero(random, [])
    return random.choice(
        (
            div(num(small_number(random)), zero),
            div(zero, zero),
            div(hidden_zero(random, []), zero),
            root(num(-abs(nonzero(random)))),
            root(sub(zero, ONE)),
            ("log", zero),
            ("log", num(-abs(nonzero(random)))),
            ("log", neg(ONE)),
            ("asin", num(random.choice((2, -3, "1000001/1000000")))),
            ("acos", TWO),
            ("tan", div(("pi",), TWO)),
            div(ONE, div(ONE, zero)),
            mul(root(num(-3)), root(num(-3))),
            power(root(num(-2)), random.choice((0, 2, 4))),
        )
    )


def risky(random, names):
    """An expression that is undefined at some points or at all, as users stumble upon."""
    if not names or random.random() < 0.2:
        return undefined_number(random)
    a = var(random.choice(names))
    c = num(random.choice((0, 0, 1, 2, 5, -1, "1/2", "1/3", 10)))
    inner = random.choice((a, sub(a, c), sub(c, a), add(a, c), power(sub(a, c), 2), sub(power(a, 2), c)))
    kind = random.randrange(9)
    if kind < 5:
        name = random.choice(("log", "sqrt", "tan", "asin", "acos"))
        return (name, inner)
    if kind < 7:
        return div(random.choice((ONE, a, inner, ZERO)), inner)
    return rough(random, names, 2) if kind == 7 else div(ONE, hidden_zero(random, names))


def disguised(random, of, names):
    """An expression with the same value wherever it has one."""
    r = risky(random, names)
    return random.choice(
        (
            lambda: add(of, mul(ZERO, r)),
            lambda: add(mul(r, ZERO), of),
            lambda: add(of, div(ZERO, r)),
            lambda: mul(of, power(r, 0)),
            lambda: mul(of, div(r, r)),
            lambda: add(of, r, neg(r)),
            lambda: add(of, sub(r, r)),
            lambda: sub(add(of, r), r),
            lambda: div(ONE, div(ONE, of)),
            lambda: div(mul(of, r), r),
            lambda: power(root(of), 2),
            lambda: mul(root(of), root(of)),
            lambda: ("exp", ("log", of)),
            lambda: add(power(of, 0), of, num(-1)),
            lambda: mul(of, div(hidden_like(random, r), r)),
            lambda: add(of, mul(sub(a := smooth(random, names, 1), a), r)),
            lambda: add(of, mul(hidden_zero(random, names), r)),
            lambda: div(of, add(power(r, 0), ZERO)),
            lambda: add(of, mul(ZERO, (random.choice(("sin", "tanh", "atan", "cos")), r))),
            lambda: add(of, div(ZERO, add(TWO, ("sin", r)))),
        )
    )()


def hidden_like(random, of):
    """The same expression, written in another way."""
    return random.choice((add(of, ZERO), mul(ONE, of), neg(neg(of)), mul(TWO, div(of, TWO))))
