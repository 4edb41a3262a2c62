"""Closed loops as data: shipped theorems with one to three things changed; properties of loops."""

import runpy
from dataclasses import fields, is_dataclass, replace
from fractions import Fraction
from functools import lru_cache
from pathlib import Path

from lyapcheck.check.kinds.stability import Property, Stable
from lyapcheck.claims import Relation
from lyapcheck.claims.claim import Case
from tests.statement_fuzz.generators import Made, generates
from tests.statement_fuzz.generators.expressions import (
    ONE,
    TWO,
    add,
    disguised,
    div,
    mul,
    neg,
    num,
    power,
    root,
    sub,
    var,
)

PROOFS = Path(__file__).parents[3] / "proofs"
SCRIPTS = (
    "adaptive_pd",
    "bounded_filter",
    "computed_torque",
    "feedforward",
    "flexible_joints",
    "kelly_filter",
    "kelly_gravity",
    "kelly_santibanez",
    "kelly_tanh",
    "nonlinear_pid",
    "pd_plus",
    "pid",
    "saturated_pd_gravity_goal",
    "slotine_li",
    "slotine_li_adaptive",
    "spd_plus",
    "takegaki_arimoto",
    "tomei",
)
OPERATIONS = {
    *["add", "apply", "diag", "div", "dot", "mat", "mul", "neg", "num", "pow", "scale", "sum", "var", "vec"]
}
NAMED = ("var", "vec", "mat", "diag")
FACTORS = ("-1", "0", "2", "1/2", "10", "1/10")


@lru_cache(maxsize=1)
def theorems():
    """The theorems of the shipped proofs, those that are there to be refused among them."""
    result = []
    for name in SCRIPTS:
        for claim in runpy.run_path(str(PROOFS / f"{name}.py"))["proof"].claims.values():
            statement = claim.statement(Case(2, 2))
            if isinstance(statement, Stable) and statement not in result:
                result.append(statement)
    return tuple(result)


@generates("Stable", 0.6)
def changed(random):
    """A theorem with one to three changes."""
    argument = changed_theorem(random.choice(theorems()).argument, random)
    return Made(Stable(argument), "a shipped theorem, changed")


def changed_theorem(argument, random):
    """With one to three changes."""
    for _ in range(random.choice((1, 1, 1, 2, 2, 3))):
        argument = random.choices((_expression, _condition, _kind), (88, 6, 6))[0](argument, random)
    return argument


def _expression(argument, random):
    places = list(_trees(argument, ()))
    path, tree = random.choice(places)
    operation, *parts = tree
    new = ("scale" if operation in ("vec", "mat", "diag", "sum", "apply", "scale") else "mul",)
    new += (("num", random.choice(FACTORS)), tree)
    if operation in NAMED and random.random() < 0.7:
        names = sorted({other[1] for _, other in places if other[0] == operation})
        new = (operation, random.choice(names))
    elif operation in ("sum", "add") and len(parts) > 1:
        left_out = random.randrange(len(parts))
        new = (operation, *(part for k, part in enumerate(parts) if k != left_out))
    elif operation == "num":
        new = ("num", str(Fraction(parts[0]) * Fraction(random.choice(FACTORS))))
    return _put(argument, path, new)


def _condition(argument, random):
    if not argument.where:
        return argument
    k = random.randrange(len(argument.where))
    one = argument.where[k]
    new = random.choice(((), (Relation(one.right, one.operator, one.left),)))
    return replace(argument, where=(*argument.where[:k], *new, *argument.where[k + 1 :]))


def _kind(argument, random):
    system = argument.system
    changes = [
        lambda: replace(argument, gravity=not argument.gravity),
        lambda: replace(argument, small=not argument.small),
        lambda: replace(argument, local=not argument.local),
        lambda: replace(argument, theorem=random.choice(("strict", "LaSalle", "uniform", "exponential"))),
        lambda: replace(
            argument, system=replace(system, friction=random.choice(("none", "any", "positive")))
        ),
        lambda: replace(argument, system=replace(system, desired=not system.desired)),
    ]
    if argument.steps:
        steps = random.sample(argument.steps, random.randint(1, len(argument.steps)))
        states = (*system.moving, *(name for one in argument.steps for name in one.still))
        moved = replace(
            steps[0],
            still=tuple(random.sample(states, random.randint(0, 2))),
            against=tuple((random.choice(system.moving), x) for _, x in steps[0].against),
        )
        changes += [lambda: replace(argument, steps=tuple(steps))] * 2
        changes += [lambda: replace(argument, steps=(moved, *argument.steps[1:]))] * 4
    return random.choice(changes)()


def _trees(value, path):
    """All expressions in an argument and their places; those of the members of a class stay as they are."""
    if isinstance(value, tuple):
        if value and isinstance(value[0], str) and value[0] in OPERATIONS:
            yield path, value
        for k, part in enumerate(value):
            yield from _trees(part, (*path, k))
    elif is_dataclass(value):
        for field in fields(value):
            if field.name != "member":
                yield from _trees(getattr(value, field.name), (*path, field.name))


def _put(value, path, new):
    if not path:
        return new
    first, *rest = path
    if isinstance(first, str):
        return replace(value, **{first: _put(getattr(value, first), tuple(rest), new)})
    return (*value[:first], _put(value[first], tuple(rest), new), *value[first + 1 :])


X = var("x")
SQUARE = add(ONE, power(X, 2))

FITTING = (
    (("tanh", X), sub(ONE, power(("tanh", X), 2)), ("log", ("cosh", X))),
    *((("h", m, X), ("dh", m, X), ("potential", m, X)) for m in (1, 2, 3)),
    (("atan", X), div(ONE, SQUARE), sub(mul(X, ("atan", X)), div(("log", SQUARE), TWO))),
    (div(X, root(SQUARE)), div(ONE, mul(SQUARE, root(SQUARE))), sub(root(SQUARE), ONE)),
)
OTHERS = (
    (("sin", X), ("cos", X), sub(ONE, ("cos", X))),
    (X, ONE, div(power(X, 2), TWO)),
    (div(X, SQUARE), div(sub(ONE, power(X, 2)), power(SQUARE, 2)), div(("log", SQUARE), TWO)),
    (
        div(X, power(SQUARE, 2)),
        div(sub(ONE, mul(num(3), power(X, 2))), power(SQUARE, 3)),
        div(sub(ONE, div(ONE, SQUARE)), TWO),
    ),
    (mul(X, ("abs", X)), mul(TWO, ("abs", X)), div(power(("abs", X), 3), num(3))),
    (add(X, div(("abs", X), TWO)), add(ONE, div(("abs", X), mul(TWO, X))), add(power(X, 2), X)),
    (("abs", X), div(X, ("abs", X)), div(mul(X, ("abs", X)), TWO)),
    (power(X, 2), mul(TWO, X), div(power(X, 3), num(3))),
    (sub(("tanh", X), div(X, num(9))), sub(num("8/9"), power(("tanh", X), 2)), sub(("log", ("cosh", X)), X)),
    (neg(("tanh", X)), sub(power(("tanh", X), 2), ONE), neg(("log", ("cosh", X)))),
)
PROPERTIES = (
    "the origin is the only equilibrium",
    "the origin is an equilibrium",
    "V is positive definite",
    "V is decrescent",
    "V is radially unbounded",
    "V is continuously differentiable",
)
NUMBERS = {"gamma": Fraction(8, 5), "rho": Fraction(3), "secant": Fraction(1), "low": Fraction(1, 2)}
"""Bounds that all that fit have."""


@lru_cache(maxsize=1)
def arguments():
    """Of (6) at rest, of (6) and of (21), each with tanh and for any ε₀."""
    rest, every = (runpy.run_path(str(PROOFS / f"{n}.py")) for n in ("kelly_santibanez", "every_function"))
    tanh = every["MEMBERS"]["tanh"]
    return {
        "rest": rest["regulator"](tanh, friction="positive")[2].argument,
        "strict": every["regulator"](tanh, "any").argument,
        "uniform": every["tracking"](tanh, "any").argument,
    }


def property_of(name, trio, desired=False):
    """A property of a loop with h, h' and U."""
    kind = "rest" if "only" in name else "uniform" if desired or name.endswith("decrescent") else "strict"
    argument = arguments()[kind]
    h, slope, potential = trio
    functions = tuple(
        replace(f, member=replace(f.member, value=h, slope=slope, potential=potential, **NUMBERS))
        for f in argument.system.functions
    )
    return Property(name, replace(argument, system=replace(argument.system, functions=functions)))


@generates("Property", 0.6)
def of_a_loop(random):
    """A property of a loop with some h; one of its parts may be off."""
    fits = random.random() < 0.6
    h, slope, potential = random.choice(FITTING if fits else OTHERS)
    kind = random.random()
    tiny = num(random.choice((1, Fraction(1, 1000), Fraction(1, 10**6), Fraction(-1, 1000))))
    if kind < 0.12:
        potential = add(potential, tiny)
    elif kind < 0.24:
        h = add(h, tiny)
    elif kind < 0.32:
        slope = mul(slope, add(ONE, tiny))
    elif kind < 0.4:
        potential = random.choice(FITTING)[2]
    elif kind < 0.48:
        h = disguised(random, h, ["x"])
    made = property_of(random.choice(PROPERTIES), (h, slope, potential), random.random() < 0.3)
    return Made(made, "a property of a loop" if fits else "a property that h does not have perhaps")
