"""Relations between numbers, near and far or equal in disguise; printed numbers; implications; small ε."""

from dataclasses import replace
from decimal import Decimal
from fractions import Fraction

from mpmath import mp

from lyapcheck.claims import Agrees, Constant, ForSmall, Implies, Relation, Variable
from tests.oracle.numbers import Undefined, Unsure, lifted
from tests.oracle.trees import Evaluation, names
from tests.statement_fuzz.generators import FALSE, NEITHER, TRUE, UNPROVABLE, Made, generates
from tests.statement_fuzz.generators.expressions import (
    ONE,
    TWO,
    ZERO,
    add,
    constant,
    disguised,
    div,
    hidden_zero,
    le,
    lt,
    mul,
    neg,
    nonzero,
    num,
    positive,
    power,
    relation,
    risky,
    root,
    rough,
    small_number,
    smooth,
    sub,
    undefined_number,
    var,
)

LARGEST = 10**20


@generates("Constant", 28)
def constants(random):
    """One relation between numbers."""
    kind = random.random()
    if kind < 0.25:
        return _undefined(random)
    if kind < 0.45:
        return _equal(random)
    if kind < 0.85:
        return _near(random)
    return Made(Constant(relation(random, rough(random, [], 3), rough(random, [], 2))), "random numbers")


def _undefined(random):
    bad = undefined_number(random)
    other = num(small_number(random)) if random.random() < 0.6 else smooth(random, [], 1)
    sides = [disguise(random, bad), other]
    random.shuffle(sides)
    return Made(Constant(relation(random, *sides)), "an undefined number", NEITHER)


def disguise(random, bad):
    """An expression that contains a number that is none."""
    plain = num(nonzero(random))
    return random.choice(
        (
            bad,
            neg(bad),
            add(plain, bad),
            mul(plain, bad),
            mul(num(0), bad),
            div(bad, bad),
            sub(bad, bad),
            ("pow", bad, random.choice((0, 1, 2))),
            div(plain, bad),
            add(plain, mul(num(0), bad)),
            (random.choice(("abs", "sin", "cos", "tanh", "atan", "exp")), bad),
        )
    )


def _equal(random):
    """Equal numbers: <= holds and < does not."""
    zero = hidden_zero(random, [])
    a = smooth(random, [], 1)
    left, right = random.choice(
        ((add(a, zero), a), (a, add(zero, a)), (zero, num(0)), (num(0), mul(num(-3), zero)))
    )
    result = relation(random, left, right)
    return Made(Constant(result), "equal numbers", FALSE if result.operator == "<" else TRUE)


def _near(random):
    """A number against a decimal beside it."""
    tree = random.choice((lambda: smooth(random, [], 2), lambda: mul(constant(random), constant(random))))()
    try:
        with mp.workdps(60):
            value = lifted(Evaluation({}).of(tree))
            digits = random.choice((2, 6, 12, 30))
            too_wide = (value.high - value.low) * 10 ** (digits + 1) > 1
            if not -LARGEST < value.low < LARGEST or too_wide:
                raise Unsure
            near = Fraction(int(mp.floor(value.low * 10**digits)), 10**digits)
    except (Undefined, Unsure):
        return Made(Constant(relation(random, tree, num(1))), "random numbers")
    unit = Fraction(1, 10**digits)
    above = random.random() < 0.5
    bound = near + 2 * unit if above else near - unit
    left, right = tree, num(bound)
    if random.random() < 0.5:
        left, right, above = right, left, not above
    truth = TRUE if above else FALSE
    if random.random() < 0.2:
        return Made(
            Constant(relation(random, disguised(random, left, []), right)),
            "disguised numbers",
            UNPROVABLE if truth == FALSE else None,
        )
    return Made(Constant(relation(random, left, right)), "a decimal beside a number", truth)


PA, PB = var("a"), var("b")


@generates("Agrees", 8)
def printed(random):
    """A formula with its inputs and its result as printed."""
    formula = random.choice(
        (
            mul(PA, PB),
            div(PA, PB),
            add(PA, mul(num(2), PB)),
            mul(root(PA), PB),
            div(power(PA, 2), add(ONE, PB)),
            sub(PA, PB),
            div(ONE, sub(PA, PB)),
            mul(("gamma", 2), PA, PB),
            ("sin", mul(PA, PB)),
            ("log", div(PA, PB)),
            mul(PA, ("tanh", PB)),
        )
    )
    inputs = [(name, f"{random.uniform(0.05, 4):.{random.choice((0, 1, 2, 4))}f}") for name in "ab"]
    printed = _result(random, formula, dict(inputs))
    if random.random() < 0.35:
        formula = disguised(random, formula, ["a", "b"])
    return Made(Agrees(formula, tuple(inputs), printed, random.choice((None, "a"))), "printed numbers")


def _result(random, formula, inputs):
    places = random.choice((1, 2, 3, 5))
    try:
        with mp.workdps(60):
            value = lifted(Evaluation({name: Fraction(text) for name, text in inputs.items()}).of(formula))
        outcome = Decimal(f"{float(value.low):.{places}f}")
    except (Undefined, Unsure, OverflowError):
        outcome = Decimal(f"{random.uniform(0, 5):.{places}f}")
    step = random.choice((0, 0, 0, 1, -1, 3, 40))
    result = outcome + step * Decimal(1).scaleb(-places)
    return f"{result:.{places}e}" if random.random() < 0.1 else str(result)


A, B, C, D = (var(name) for name in "abcd")
POSITIVE, WEAK, REAL = "positive", "weak", "real"

LEMMAS = (
    ((le(A, B), le(B, C)), le(A, C), REAL),
    ((lt(A, B), le(B, C)), lt(A, C), REAL),
    ((le(A, B),), le(mul(A, C), mul(B, C)), WEAK),
    ((lt(A, B),), lt(mul(A, C), mul(B, C)), POSITIVE),
    ((le(A, B), le(C, D)), le(mul(A, C), mul(B, D)), WEAK),
    ((le(A, B),), le(power(A, 2), power(B, 2)), WEAK),
    ((lt(A, B),), lt(div(ONE, B), div(ONE, A)), POSITIVE),
    ((lt(mul(A, B), C),), lt(A, div(C, B)), POSITIVE),
    ((lt(A, div(B, C)),), lt(mul(A, C), B), POSITIVE),
    ((), le(mul(TWO, A, B), add(power(A, 2), power(B, 2))), REAL),
    ((), le(ZERO, power(A, 2)), REAL),
    ((), lt(ZERO, add(ONE, power(A, 2))), REAL),
    ((le(A, B), le(A, sub(ZERO, B))), le(A, ZERO), REAL),
    ((lt(A, ZERO),), lt(B, C), POSITIVE),
    ((lt(A, B), lt(B, A)), le(add(C, ONE), C), REAL),
    ((le(add(A, B), C),), le(A, C), WEAK),
    ((lt(A, mul(root(num(3)), B)),), lt(div(A, root(num(3))), B), POSITIVE),
    ((le(mul(("gamma", 2), A), B),), le(A, B), WEAK),
    ((le(("pi",), A),), le(num("3.14"), A), REAL),
    ((lt(A, mul(("gamma", 3), B)), lt(B, C)), lt(A, mul(("gamma", 3), C)), POSITIVE),
    ((), le(div(A, add(ONE, A)), ONE), WEAK),
    ((), lt(div(A, add(A, B)), ONE), POSITIVE),
    ((le(power(A, 2), mul(A, B)),), le(A, B), POSITIVE),
    ((), le(ZERO, add(mul(A, B), mul(root(TWO), C))), WEAK),
    ((le(ONE, A),), le(A, power(A, 2)), WEAK),
    ((le(A, ONE),), le(power(A, 2), A), WEAK),
)
KINDS = {POSITIVE: (Fraction(0), True), WEAK: (Fraction(0), False), REAL: (None, True)}


def variables(random, kind, own_names="abcd"):
    """Variables of one kind."""
    return tuple(Variable(name, *KINDS[kind]) for name in own_names)


def used(statement):
    """The statement with the variables that occur, and no others."""
    result = names(*(s for r in (*statement.hypotheses, statement.conclusion) for s in (r.left, r.right)))
    kept = tuple(v for v in statement.variables if v.name in result)
    return replace(statement, variables=kept or statement.variables[:1])


@generates("Implies", 20)
def implications(random):
    """One implication."""
    hypotheses, conclusion, kind = random.choice(LEMMAS)
    statement = Implies(variables(random, kind), hypotheses, conclusion)
    how = random.random()
    if how < 0.15:
        return Made(used(statement), "a lemma", TRUE)
    if how < 0.45:
        return Made(used(_changed(random, statement)), "a lemma, changed")
    if how < 0.7:
        return Made(used(_hidden(random, statement)), "a lemma, disguised")
    if how < 0.8:
        return _positivity(random)
    if how < 0.9:
        return _signs(random)
    own_names = ["a", "b", "c"][: random.randint(1, 3)]
    given = tuple(
        relation(random, rough(random, own_names, 1), rough(random, own_names, 1))
        for _ in range(random.randint(0, 2))
    )
    wanted = relation(random, rough(random, own_names, 2), rough(random, own_names, 1))
    own = tuple(Variable(n, *random.choice(list(KINDS.values()))) for n in own_names)
    return Made(Implies(own, given, wanted), "random relations")


def _changed(random, statement):
    """One thing made another: a hypothesis, an operator, a range, a bound by 10⁻⁶."""
    given, wanted, own = list(statement.hypotheses), statement.conclusion, list(statement.variables)
    how = random.randrange(7)
    if how == 0 and given:
        given.pop(random.randrange(len(given)))
    elif how == 1 and given:
        k = random.randrange(len(given))
        given[k] = Relation(given[k].right, given[k].operator, given[k].left)
    elif how == 2:
        wanted = Relation(wanted.left, "<" if wanted.operator == "<=" else "<=", wanted.right)
    elif how == 3:
        k = random.randrange(len(own))
        own[k] = Variable(own[k].name, *random.choice(list(KINDS.values())))
    elif how == 4:
        wanted = Relation(
            add(wanted.left, num(random.choice(("1/1000000", "-1/1000000")))), wanted.operator, wanted.right
        )
    elif how == 5:
        wanted = Relation(
            wanted.left,
            wanted.operator,
            mul(random.choice((num(2), num("1/2"), constant(random))), wanted.right),
        )
    else:
        k = random.randrange(len(own))
        own[k] = Variable(
            own[k].name, Fraction(random.randint(-2, 3), random.choice((1, 2))), random.random() < 0.5
        )
    return Implies(tuple(own), tuple(given), wanted)


def _hidden(random, statement):
    """A risky part hidden in the conclusion or in a hypothesis."""
    own_names = ["a", "b"]

    def hide(relation):
        if random.random() < 0.5:
            return replace(relation, left=disguised(random, relation.left, own_names))
        return replace(relation, right=disguised(random, relation.right, own_names))

    given = list(statement.hypotheses)
    if given and random.random() < 0.4:
        k = random.randrange(len(given))
        given[k] = hide(given[k])
        return replace(statement, hypotheses=tuple(given))
    return replace(statement, conclusion=hide(statement.conclusion))


def _positivity(random):
    """Sums of products of what is >= 0, over sums of the same."""
    kind = random.choice((POSITIVE, WEAK))
    parts = [
        mul(num(positive(random)), power(random.choice((A, B, C)), random.randint(0, 3))) for _ in range(3)
    ]
    tree = add(*parts)
    if random.random() < 0.6:
        bottom = random.choice(
            (add(A, B), A, mul(A, B), add(ONE, A), root(A), add(A, root(TWO)), sub(A, B), power(C, 0))
        )
        tree = div(tree, bottom)
    if random.random() < 0.3:
        tree = add(tree, mul(hidden_zero(random, ["a"]), risky(random, ["a", "b"])))
    statement = Implies(variables(random, kind), (), relation(random, ZERO, tree))
    return Made(used(statement), "sums of what is not negative")


def _signs(random):
    """Roots and named numbers among the variables; squares of roots."""
    kind = random.choice((POSITIVE, WEAK, REAL))
    inner = random.choice(
        (A, sub(A, B), add(A, B), mul(A, B), num(-3), sub(A, num(small_number(random))), ZERO)
    )
    tree = random.choice(
        (
            power(root(inner), 2),
            mul(root(inner), root(inner)),
            root(inner),
            mul(root(inner), B),
            power(root(inner), 3),
            div(inner, root(inner)),
            power(root(inner), 0),
            div(ONE, power(root(inner), 2)),
        )
    )
    other = random.choice((inner, ZERO, num(-1), smooth(random, ["a", "b"], 1)))
    sides = [tree, other]
    random.shuffle(sides)
    return Made(used(Implies(variables(random, kind), (), relation(random, *sides))), "roots")


def _of_small(random, generators):
    """A function of ε, t or of what they divide: it may tend to 0, to 1 or to infinity."""
    a = random.choice(generators[:1] + generators[3:])
    inner = random.choice(
        (a, div(ONE, a), div(ONE, power(a, 2)), div(A, a), add(ONE, a), div(ONE, power(a, 4)))
    )
    return (random.choice(("exp", "log", "sqrt", "abs", "sin", "tanh", "cosh")), inner)


E, T, A, B = var("eps"), var("t"), var("a"), var("b")


@generates("ForSmall", 7)
def small(random):
    """A polynomial in ε, t and others against 0 or another."""
    bounded = ("t",) if random.random() < 0.5 else ()
    generators = [E, A, B, *([T] if bounded else [])]

    def monomial():
        c = num(small_number(random)) if random.random() < 0.85 else constant(random)
        return mul(c, *(power(random.choice(generators), random.randint(0, 2)) for _ in range(2)))

    left, right = (
        add(*(monomial() for _ in range(2))),
        add(*(monomial() for _ in range(random.randint(1, 3)))),
    )
    if random.random() < 0.4:
        left = ZERO
    if random.random() < 0.2:
        right = div(right, random.choice((E, A, add(A, E), power(E, 2))))
    if random.random() < 0.25:
        left = add(left, mul(random.choice((E, A, power(E, 2))), _of_small(random, generators)))
    if random.random() < 0.2:
        right = disguised(random, right, ["a", "eps"])
    kind = random.choice(("positive", "positive", "weak", "real"))
    own = tuple(Variable(name, *KINDS[kind]) for name in "ab")
    given = random.choice(((), (lt(A, B),), (le(A, B),), (lt(ZERO, A),), (lt(A, B), lt(B, A))))
    return Made(ForSmall("eps", own, given, relation(random, left, right), bounded), "a small parameter")
