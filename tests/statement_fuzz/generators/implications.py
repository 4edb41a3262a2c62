"""Implications: lemmas with all hypotheses, with one missing or turned round, contradictions, disguises."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from random import Random

from tests.statement_fuzz.generators import TRUE, Made, generates
from tests.statement_fuzz.generators.traps import disguised, hidden_zero, risky
from tests.statement_fuzz.generators.trees import (
    ONE,
    TWO,
    ZERO,
    Tree,
    add,
    constant,
    div,
    le,
    lt,
    mul,
    num,
    positive,
    power,
    relation,
    root,
    rough,
    small_number,
    smooth,
    sub,
    var,
)
from tests.statement_fuzz.subject import Implies, Relation, Variable

A, B, C, D = (var(name) for name in "abcd")
POSITIVE, WEAK, REAL = "positive", "weak", "real"
Lemma = tuple[tuple[Relation, ...], Relation, str]

LEMMAS: tuple[Lemma, ...] = (
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


def variables(random: Random, kind: str, names: str = "abcd") -> tuple[Variable, ...]:
    """Variables of one kind."""
    return tuple(Variable(name, *KINDS[kind]) for name in names)


def used(statement: Implies) -> Implies:
    """The statement with the variables that occur, and no others."""
    from tests.statement_fuzz.oracle.evaluate import names

    result = names(*(s for r in (*statement.hypotheses, statement.conclusion) for s in (r.left, r.right)))
    kept = tuple(v for v in statement.variables if v.name in result)
    return replace(statement, variables=kept or statement.variables[:1])


@generates("Implies", 20)
def make(random: Random) -> Made:
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
    names = ["a", "b", "c"][: random.randint(1, 3)]
    given = tuple(
        relation(random, rough(random, names, 1), rough(random, names, 1))
        for _ in range(random.randint(0, 2))
    )
    wanted = relation(random, rough(random, names, 2), rough(random, names, 1))
    own = tuple(Variable(n, *random.choice(list(KINDS.values()))) for n in names)
    return Made(Implies(own, given, wanted), "random relations")


def _changed(random: Random, statement: Implies) -> Implies:
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


def _hidden(random: Random, statement: Implies) -> Implies:
    """A risky part hidden in the conclusion or in a hypothesis."""
    names = ["a", "b"]

    def hide(relation: Relation) -> Relation:
        if random.random() < 0.5:
            return replace(relation, left=disguised(random, relation.left, names))
        return replace(relation, right=disguised(random, relation.right, names))

    given = list(statement.hypotheses)
    if given and random.random() < 0.4:
        k = random.randrange(len(given))
        given[k] = hide(given[k])
        return replace(statement, hypotheses=tuple(given))
    return replace(statement, conclusion=hide(statement.conclusion))


def _positivity(random: Random) -> Made:
    """Sums of products of what is >= 0, over sums of the same."""
    kind = random.choice((POSITIVE, WEAK))
    parts = [
        mul(num(positive(random)), power(random.choice((A, B, C)), random.randint(0, 3))) for _ in range(3)
    ]
    tree: Tree = add(*parts)
    if random.random() < 0.6:
        bottom = random.choice(
            (add(A, B), A, mul(A, B), add(ONE, A), root(A), add(A, root(TWO)), sub(A, B), power(C, 0))
        )
        tree = div(tree, bottom)
    if random.random() < 0.3:
        tree = add(tree, mul(hidden_zero(random, ["a"]), risky(random, ["a", "b"])))
    statement = Implies(variables(random, kind), (), relation(random, ZERO, tree))
    return Made(used(statement), "sums of what is not negative")


def _signs(random: Random) -> Made:
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
