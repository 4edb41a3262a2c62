"""Identities and bounds in vectors and matrices: products expanded, and the same with one thing changed."""

from dataclasses import replace
from fractions import Fraction

from lyapcheck.check.kinds.bound_every_n import BoundEveryN
from lyapcheck.check.kinds.every_n import EveryN, Given
from tests.oracle.letters import letters
from tests.statement_fuzz.generators import TRUE, Made, generates
from tests.statement_fuzz.generators.expressions import (
    add,
    disguised,
    div,
    hidden_zero,
    mul,
    neg,
    num,
    power,
    var,
)

VECTORS = ("a", "b", "w")
MATRICES = ("M", "N")


@generates("EveryN", 28)
def every_n(random):
    """One identity in vectors and matrices."""
    kind = random.random()
    if kind < 0.6:
        return _expanded(random)
    if kind < 0.75:
        return _rate(random)
    if kind < 0.85:
        return _given(random)
    return _with_numbers(random)


def _matrix(random):
    kind = random.random()
    if kind < 0.6:
        return ("mat", random.choice(MATRICES))
    if kind < 0.8:
        return ("transpose", ("mat", random.choice(MATRICES)))
    return ("diag", random.choice(VECTORS))


def _word(random):
    length = random.choice((0, 0, 1, 1, 2, 3))
    vectors = VECTORS[: random.choice((1, 2, 3))]
    return (*(_matrix(random) for _ in range(length)), ("vec", random.choice(vectors)))


def _vector(word):
    tree = word[-1]
    for matrix in reversed(word[:-1]):
        tree = ("apply", matrix, tree)
    return tree


def _sum(terms):
    parts = [_vector(w) if c == 1 else ("scale", num(c), _vector(w)) for c, w in terms]
    return ("sum", *parts) if len(parts) > 1 else parts[0]


def _terms(random):
    coefficients = (1, 1, 1, 2, -1, 3, Fraction(1, 2))
    result = [(Fraction(random.choice(coefficients)), _word(random)) for _ in range(random.randint(1, 3))]
    if random.random() < 0.5:
        c, word = result[0]
        result.append((c, (_matrix(random), *word)))
    return result


def _transposed(matrix):
    if matrix[0] == "transpose":
        return matrix[1]
    return matrix if matrix[0] == "diag" else ("transpose", matrix)


def _scalar(random, x, y):
    """xᵀy, with some of the matrices moved to the other side."""
    left, right = list(x), list(y)
    for _ in range(random.randint(0, 2)):
        if len(left) > 1 and random.random() < 0.5:
            right.insert(0, _transposed(left.pop(0)))
        elif len(right) > 1:
            left.insert(0, _transposed(right.pop(0)))
    sides = [_vector(tuple(left)), _vector(tuple(right))]
    random.shuffle(sides)
    return ("dot", *sides)


def _expanded(random):
    """(Σ …)·(Σ …) expanded; half of the time with one coefficient, letter or transpose changed."""
    left, right = _terms(random), _terms(random)
    if random.random() < 0.4:
        right = list(left)
    products = [(c * d, x, y) for c, x in left for d, y in right]
    truth = TRUE
    symmetric = tuple(name for name in MATRICES if random.random() < 0.4)
    how = random.random()
    if how < 0.4:
        products, truth = _perturbed(random, products)
    elif how < 0.6:
        return _collected(random, left, right, symmetric)
    expanded = add(*(mul(num(c), _scalar(random, x, y)) for c, x, y in products)) if products else num(0)
    sides = [("dot", _sum(left), _sum(right)), expanded]
    random.shuffle(sides)
    return Made(_every_n(*sides, symmetric), "an expanded product", truth)


def _perturbed(random, products):
    k = random.randrange(len(products))
    c, x, y = products[k]
    how = random.randrange(4)
    if how == 0:
        return products[:k] + products[k + 1 :], None
    if how == 1:
        return [
            *products[:k],
            (c + random.choice((1, -1, Fraction(1, 10**6))), x, y),
            *products[k + 1 :],
        ], None
    if how == 2 and len(x) > 1:
        return [*products[:k], (c, (_transposed(x[0]), *x[1:]), y), *products[k + 1 :]], None
    if len(x) > 2:
        return [*products[:k], (c, (x[1], x[0], *x[2:]), y), *products[k + 1 :]], None
    return [*products[:k], (2 * c, x, y), *products[k + 1 :]], None


def _collected(random, left, right, symmetric):
    """Terms collected as one who forgets what occurs twice would: each product word once."""

    def turned(matrix):
        return matrix if matrix[0] == "mat" and matrix[1] in symmetric else _transposed(matrix)

    once = {}
    for c, x in left:
        for d, y in right:
            once[(*(turned(m) for m in reversed(x[:-1])), x[-1], *y)] = mul(num(c * d), _scalar(random, x, y))
    return Made(_every_n(("dot", _sum(left), _sum(right)), add(*once.values()), symmetric), "each word once")


def _every_n(left, right, symmetric=(), rates=(), given=()):
    """The statement with those of the symmetric matrices that occur."""
    result = _letters(left, right, *(t for pair in rates for t in pair), *(g.equals for g in given))
    result |= {("mat", g.matrix) for g in given}
    return EveryN(left, right, tuple(name for name in symmetric if ("mat", name) in result), rates, given)


def _letters(*trees):
    return set(letters(*trees))


def _rate(random):
    """d/dt of xᵀMx and of its like, with the rates of the letters."""
    x, y = ("vec", "a"), ("vec", random.choice(("a", "b")))
    dx, dy = ("vec", "w"), (("vec", "w") if y == x else ("vec", "c"))
    m, dm = ("mat", "M"), ("mat", "Mdot")
    form = ("dot", x, ("apply", m, y))
    first = ("dot", dx, ("apply", m, y))
    middle = ("dot", x, ("apply", dm, y))
    last = ("dot", x, ("apply", m, dy))
    symmetric = tuple(name for name in ("M", "Mdot") if random.random() < 0.6)
    parts = [first, middle, last]
    if random.random() < 0.4:
        parts.pop(random.randrange(3))
    if random.random() < 0.3:
        parts[0] = mul(num(2), parts[0])
    inside = form
    outside = add(*parts)
    if random.random() < 0.3:
        s = var("s")
        inside = random.choice(
            (mul(s, form), div(form, add(num(1), power(s, 2))), power(form, 2), div(form, s))
        )
        outside = random.choice(
            (
                add(mul(var("r"), form), mul(s, outside)),
                mul(num(2), form, outside),
                div(add(mul(outside, s), neg(mul(form, var("r")))), power(s, 2)),
                outside,
            )
        )
    rates = [(x, dx), (m, dm)]
    if y != x:
        rates.append((y, dy))
    if ("var", "s") in _letters(inside):
        rates.append((var("s"), var("r")))
    return Made(_every_n(("rate", inside), outside, symmetric, tuple(rates)), "a derivative")


def _given(random):
    """A x = b put in, on the side where it belongs and on the others."""
    m = ("mat", "M")
    equals = random.choice(
        (("vec", "b"), ("sum", ("vec", "b"), ("vec", "w")), ("scale", num(2), ("vec", "b")), ("sum",))
    )
    symmetric = ("M",) if random.random() < 0.5 else ()
    y = ("vec", random.choice(("w", "x", "b")))
    left = random.choice(
        (
            ("dot", y, ("apply", m, ("vec", "x"))),
            ("dot", ("apply", m, ("vec", "x")), y),
            ("dot", ("apply", ("transpose", m), ("vec", "x")), y),
            ("dot", ("vec", "x"), ("apply", m, y)),
            ("dot", ("apply", m, ("vec", "x")), ("apply", m, ("vec", "x"))),
            ("dot", y, ("apply", m, ("apply", m, ("vec", "x")))),
        )
    )
    right = random.choice((("dot", y, equals), ("dot", equals, equals), ("dot", y, ("apply", m, equals))))
    return Made(_every_n(left, right, symmetric, (), (Given("M", "x", equals),)), "something given")


def _with_numbers(random):
    """Numbers among the letters: quotients, disguises and powers."""
    x = ("dot", ("vec", "a"), ("vec", random.choice(("a", "b"))))
    s = var("s")
    pairs = [
        (div(x, x), num(1)),
        (div(mul(x, s), s), x),
        (mul(x, power(s, 0)), x),
        (power(x, 0), num(1)),
        (
            ("dot", ("scale", div(num(1), s), ("vec", "a")), ("scale", s, ("vec", "b"))),
            ("dot", ("vec", "a"), ("vec", "b")),
        ),
        (("dot", ("vec", "a"), ("scale", div(num(1), s), ("sum",))), num(0)),
        (power(("sqrt", x), 2), x),
        (disguised(random, x, ["s"]), x),
        (add(x, hidden_zero(random, ["s"])), x),
        (div(x, add(num(1), power(s, 2))), mul(x, div(num(1), add(num(1), power(s, 2))))),
        (mul(num(0), div(x, s)), num(0)),
        (div(num(1), div(num(1), s)), s),
        (("dot", ("sum",), ("scale", ("log", s), ("vec", "a"))), num(0)),
        (("dot", ("scale", ("log", num(-1)), ("sum",)), ("vec", "a")), num(0)),
        (("dot", ("apply", ("scale", div(num(1), s), ("mat", "M")), ("sum",)), ("vec", "a")), num(0)),
        (("rate", mul(power(s, 0), x)), num(0)),
        (("rate", num(3)), num(0)),
        (("rate", power(("log", s), 0)), num(0)),
    ]
    left, right = random.choice(pairs)
    rates = ()
    if left[0] == "rate":
        rates = ((s, var("r")), *((("vec", n), ("sum",)) for n in ("a", "b") if ("vec", n) in _letters(left)))
    statement = _every_n(left, right, (), rates)
    if ("var", "s") in _letters(left, right):
        statement = replace(statement, positive=random.choice(((), ("s",))))
    return Made(statement, "numbers among the letters")


@generates("BoundEveryN", 3)
def bound(random):
    """A sum of terms against the product of norms, with coefficients that suffice or not."""
    words = []
    m, a, b = ("mat", "M"), ("vec", "a"), ("vec", "b")
    terms = [
        (("dot", a, b), mul(var("x"), var("y"))),
        (("dot", a, ("apply", m, b)), mul(var("k"), var("x"), var("y"))),
        (("dot", a, ("apply", ("transpose", m), a)), mul(var("k"), power(var("x"), 2))),
        (("dot", a, a), power(var("x"), 2)),
        (("dot", ("apply", m, a), ("apply", m, b)), mul(power(var("k"), 2), var("x"), var("y"))),
        (("dot", a, ("apply", ("diag", "d"), b)), mul(var("z"), var("x"), var("y"))),
        (mul(var("s"), ("dot", a, b)), mul(var("s"), var("x"), var("y"))),
    ]
    for _ in range(random.randint(1, 3)):
        tree, size = random.choice(terms)
        words.append((Fraction(random.choice((1, -1, 2, -3, Fraction(1, 2)))), tree, size))
    left = add(*(mul(num(c), tree) for c, tree, _ in words))
    off = random.choice((0, 0, 0, Fraction(-1, 10**6), Fraction(-1, 2), 1))
    sizes = [mul(num(abs(c)), size) for c, _, size in words]
    if off:
        sizes[0] = mul(num(abs(words[0][0]) + off), words[0][2])
    right = add(*sizes)
    norms = [((a,), var("x")), ((b,), var("y")), ((m,), var("k"))]
    if random.random() < 0.2:
        norms[0] = ((a, b), mul(var("x"), var("y")))
    norms.append(((("diag", "d"),), var("z")))
    least = ()
    if random.random() < 0.3:
        least = ((("dot", a, a), mul(num(random.choice((1, "1/2"))), power(var("x"), 2))),)
        left = add(left, mul(num(-2), ("dot", a, a)))
        right = add(right, mul(num(random.choice((-2, -1, -3))), power(var("x"), 2)))
    symmetric = ("M",) if random.random() < 0.4 and ("mat", "M") in _letters(left) else ()
    if random.random() < 0.1:
        same = div(var("z"), var("z"))
        left, right = random.choice(((left, mul(right, same)), (mul(left, same), right)))
        return Made(BoundEveryN(left, right, symmetric, (), (), tuple(norms), least), "products, disguised")
    truth = TRUE if off >= 0 and not least and len(norms[0][0]) == 1 else None
    return Made(BoundEveryN(left, right, symmetric, (), (), tuple(norms), least), "products of norms", truth)
