"""Arms under a bounded controller: dV/dt < 0 at gains, friction and ε₀ of all signs; bounds of K_v."""

from __future__ import annotations

from fractions import Fraction
from random import Random

from tests.statement_fuzz.generators import FALSE, TRUE, Made, generates
from tests.statement_fuzz.generators.robots import Robot, robot, size
from tests.statement_fuzz.generators.traps import hidden_zero, undefined_number
from tests.statement_fuzz.generators.trees import Tree, add, num, smooth
from tests.statement_fuzz.subject import DampingBelow, Decreasing

FAMILIES = (
    ("tanh", None),
    ("tanh", None),
    ("arctan", None),
    ("algebraic", None),
    *(("hyperbolic", m) for m in (1, 2, 3)),
)
GAINS = tuple(map(Fraction, (1, 2, 5, 20)))
SMALL = tuple(Fraction(1, k) for k in (10**6, 1000, 200, 50))


def gains(random: Random, n: int) -> tuple[Fraction, ...]:
    """A positive number for each joint."""
    return tuple(random.choice(GAINS) for _ in range(n))


def friction(random: Random, n: int) -> tuple[tuple[Fraction, Fraction], ...]:
    """A range for each joint, mostly a single number."""
    low = [Fraction(random.choice((1, 2, 5)), random.choice((1, 2, 4))) for _ in range(n)]
    wide = random.random() < 0.15
    return tuple((b, b + random.choice((0, 1)) * wide) for b in low)


def _spoiled(random: Random, values: tuple[Fraction, ...]) -> tuple[Fraction, ...]:
    """One of them 0 or with its sign turned."""
    k = random.randrange(len(values))
    return (*values[:k], random.choice((Fraction(0), -values[k])), *values[k + 1 :])


def _heaviest(arm: Robot) -> Fraction:
    """A bound of ‖M(q)‖."""
    return max(sum((size(entry, arm.parameters) for entry in row), Fraction(0)) for row in arm.mass)


@generates("Decreasing", 0.7)
def decreasing(random: Random) -> Made:
    """dV/dt < 0: mostly with a small ε₀, some with one that is too large, some with a sign turned."""
    kind = random.random()
    dear = kind < 0.16
    n = 1 if dear and random.random() < 0.7 else None
    arm = robot(random, n, True if kind < 0.85 else None, plain=dear)
    viscous, kp, kv = friction(random, arm.n), gains(random, arm.n), gains(random, arm.n)
    family, m = random.choice(FAMILIES)
    # ε₀ (‖M‖ + …) is what stands beside the friction
    natural = min(b for b, _ in viscous) / (_heaviest(arm) + max(b for _, b in viscous) + max(kv))
    eps0, truth, what = natural * random.choice(SMALL), None, "a small ε₀"
    coupling: tuple[Fraction, ...] = ()
    if dear:
        eps0, what = (
            natural * random.choice((1, 4, 20, 100)),
            "some ε₀",
        )
    elif kind < 0.26:
        eps0, what = natural * random.choice((10**3, 10**6)), "a huge ε₀"
    elif kind < 0.36:
        eps0, truth, what = random.choice((Fraction(0), -eps0)), FALSE, "ε₀ not positive"
    elif kind < 0.46:
        kp, truth, what = _spoiled(random, kp), FALSE, "a stiffness that is not positive"
    elif kind < 0.54:
        b = viscous[0][0]
        viscous, truth, what = ((-b, b), *viscous[1:]), FALSE, "friction that may be negative"
    elif kind < 0.6:
        kv, what = _spoiled(random, kv), "damping that is not positive"
    elif kind < 0.7:
        coupling, what = gains(random, arm.n), "weights"
        eps0 = eps0 / max(coupling)
    statement = Decreasing(arm.mass, viscous, arm.parameters, family, m, kp, kv, eps0, coupling)
    return Made(statement, what, FALSE if arm.definite is False else truth)


@generates("DampingBelow", 0.6)
def damping(random: Random) -> Made:
    """A bound of the damping, which dV/dt < 0 never asks for; it holds where V can not fall at all."""
    kind = random.random()
    arm = robot(random, None, kind < 0.96, plain=True)
    viscous, kp, kv = friction(random, arm.n), gains(random, arm.n), gains(random, arm.n)
    bound: Tree = num(random.choice((0, -1, 1, 2, 5, 40)))
    truth: str | None = FALSE if arm.definite else TRUE
    what = "a bound of the damping" if arm.definite else "M that is not positive"
    if kind < 0.1:
        bound = smooth(random, [], 2)
        truth = None
    elif kind < 0.16:
        bound = add(bound, random.choice((hidden_zero(random, []), undefined_number(random))))
        truth = None
    elif kind < 0.3:
        kp, truth, what = _spoiled(random, kp), TRUE, "a stiffness that is not positive"
    elif kind < 0.45:
        viscous, truth, what = ((Fraction(-1), Fraction(-1, 2)), *viscous[1:]), TRUE, "negative friction"
    family, m = random.choice(FAMILIES)
    return Made(DampingBelow(arm.mass, viscous, arm.parameters, family, m, kp, kv, bound), what, truth)
