"""The step of a theorem, as it should be, or with one thing changed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from random import Random

from tests.statement_fuzz.generators import TRUE, UNPROVABLE, Made, generates
from tests.statement_fuzz.generators.controlled import gains
from tests.statement_fuzz.generators.loop_properties import FITTING
from tests.statement_fuzz.generators.robots import robot
from tests.statement_fuzz.generators.trees import ONE, Tree, div, lt, mul, neg, num, power, root, sub, var
from tests.statement_fuzz.oracle.theorems import HYPOTHESES, OF_ARM
from tests.statement_fuzz.subject import ArmAndGains, ClosedLoop, Theorem

EPS, KP, KC, BETA = (var(name) for name in ("eps", "kp", "kc", "beta"))
FORM: tuple[Tree, Tree, Tree] = (
    mul(EPS, KP),
    neg(div(mul(EPS, var("b_max")), num(2))),
    sub(var("b_min"), mul(EPS, BETA)),
)
CONDITION = lt(var("eps0"), div(var("b_min"), BETA))


def _base(random: Random) -> Theorem:
    """A step as it should be."""
    name = random.choice(list(HYPOTHESES))
    with_arm = random.random() < 0.5
    arm = robot(random, plain=True)
    n = arm.n if with_arm else random.randint(1, 6)
    wanted = [*HYPOTHESES[name], *(OF_ARM if with_arm else ())]
    random.shuffle(wanted)
    reach = Fraction(random.choice((3, 4, 5)))
    desired = "time" in name
    h, slope, potential = random.choice(FITTING)
    largest = random.choice((Fraction(1), Fraction(3, 2)))
    share = reach * largest / (reach + largest)
    loop = ClosedLoop(
        n, h, slope, potential, Fraction(1), Fraction(2), largest, reach, share, FORM, desired, (CONDITION,)
    )
    if with_arm:
        kp, kv, b = (gains(random, n) for _ in range(3))
        numbers = {
            "kp": min(kp),
            "b_min": min(b),
            "b_max": max(b),
            "kv_max": max(kv),
            "beta": Fraction(random.choice((0, 3))),
            "kc": Fraction(1),
            "eps0": Fraction(1, 10),
        } | ({"vd": Fraction(1)} if desired else {})
        own = ArmAndGains(arm.mass, b, kp, kv)
        loop = replace(loop, condition=(), arm=own, numbers=tuple(numbers.items()))
    return Theorem(name, loop, tuple((label, f"c{k}") for k, label in enumerate(wanted)))


def _size(random: Random, t: Theorem) -> Theorem:
    name = random.choice(("gamma", "reach", "G", "rho", "L"))
    value = getattr(t.loop, name)
    factor = {"gamma": Fraction(6), "reach": Fraction(1, 6), "G": Fraction(999, 1000)}.get(name, Fraction(-1))
    return replace(
        t, loop=replace(t.loop, **{name: value * random.choice((factor, Fraction(-1), Fraction(0)))})
    )


def _hypothesis(random: Random, t: Theorem) -> Theorem:
    k = random.randrange(len(t.hypotheses))
    rest = t.hypotheses[:k] + t.hypotheses[k + 1 :]
    more: tuple[tuple[str, str], ...] = random.choice(((), ((f"{t.hypotheses[k][0]} ", "c"), rest[0])))
    return replace(t, hypotheses=(*rest, *more))


def _number(random: Random, t: Theorem) -> Theorem:
    numbers = dict(t.loop.numbers)
    if not numbers:
        return replace(t, loop=replace(t.loop, numbers=(("kp", Fraction(1)),)))
    name = random.choice(("kp", "b_min", "b_max", "kv_max", "eps0", "beta"))
    up = Fraction(1001, 1000) if name in ("kp", "b_min") else Fraction(999, 1000)
    factor = random.choice((up, Fraction(-1))) if name not in ("eps0", "beta") else Fraction(-1)
    numbers[name] = factor * (numbers[name] or Fraction(1))
    return replace(t, loop=replace(t.loop, numbers=tuple(numbers.items())))


def _term(random: Random, t: Theorem) -> Theorem:
    bad = random.choice(
        (div(ONE, sub(EPS, ONE)), root(sub(KP, ONE)), ("log", sub(KC, BETA)), power(root(neg(EPS)), 0))
    )
    return replace(t, loop=replace(t.loop, form=(t.loop.form[0], bad, t.loop.form[2])))


def _kind(random: Random, t: Theorem) -> Theorem:
    if random.random() < 0.5:
        return replace(t, loop=replace(t.loop, desired=not t.loop.desired))
    return replace(t, name=random.choice([*(name for name in HYPOTHESES if name != t.name), "a theorem"]))


CHANGES: tuple[Callable[[Random, Theorem], Theorem], ...] = (_size, _hypothesis, _number, _term, _kind)


@generates("Theorem", 0.5)
def theorem(random: Random) -> Made:
    """The step of a theorem."""
    base = _base(random)
    if random.random() < 0.5:
        return Made(base, "a theorem", TRUE)
    return Made(random.choice(CHANGES)(random, base), "a theorem, one thing changed", UNPROVABLE)
