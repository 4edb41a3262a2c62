"""Arms under a bounded controller: dV/dt < 0 at gains, friction and ε₀ of all signs; where they rest."""

from fractions import Fraction

from mpmath import mp

from lyapcheck.check.kinds.decreasing import DampingBelow, Decreasing
from lyapcheck.check.kinds.resting import Resting
from tests.oracle.arm import many
from tests.oracle.loop import many_digits
from tests.statement_fuzz.generators import FALSE, TRUE, UNPROVABLE, Made, generates
from tests.statement_fuzz.generators.arms import robot, size
from tests.statement_fuzz.generators.expressions import add, hidden_zero, num, smooth, undefined_number

FAMILIES = (
    ("tanh", None),
    ("tanh", None),
    ("arctan", None),
    ("algebraic", None),
    *(("hyperbolic", m) for m in (1, 2, 3)),
)
GAINS = tuple(map(Fraction, (1, 2, 5, 20)))
SMALL = tuple(Fraction(1, k) for k in (10**6, 1000, 200, 50))


def gains(random, n):
    """A positive number for each joint."""
    return tuple(random.choice(GAINS) for _ in range(n))


def friction(random, n):
    """A range for each joint, mostly a single number."""
    low = [Fraction(random.choice((1, 2, 5)), random.choice((1, 2, 4))) for _ in range(n)]
    wide = random.random() < 0.15
    return tuple((b, b + random.choice((0, 1)) * wide) for b in low)


def _spoiled(random, values):
    """One of them 0 or with its sign turned."""
    k = random.randrange(len(values))
    return (*values[:k], random.choice((Fraction(0), -values[k])), *values[k + 1 :])


def _heaviest(arm):
    """A bound of ‖M(q)‖."""
    return max(sum((size(entry, arm.parameters) for entry in row), Fraction(0)) for row in arm.mass)


@generates("Decreasing", 0.7)
def decreasing(random):
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
    coupling = ()
    if dear:
        eps0, what = (natural * random.choice((1, 4, 20, 100)), "some ε₀")
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
def damping(random):
    """A bound of the damping, which dV/dt < 0 never asks for; it holds where V can not fall at all."""
    kind = random.random()
    arm = robot(random, None, kind < 0.96, plain=True)
    viscous, kp, kv = friction(random, arm.n), gains(random, arm.n), gains(random, arm.n)
    bound = num(random.choice((0, -1, 1, 2, 5, 40)))
    truth = FALSE if arm.definite else TRUE
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


SHARES = (Fraction(0), Fraction(1, 1000), Fraction(1, 3), Fraction(9, 10), Fraction(999, 1000))
LARGE = (Fraction(1), Fraction(1001, 1000), Fraction(3, 2), Fraction(40))
STEPS = (Fraction(1, 5), Fraction(1, 1000), Fraction(1, 10**7), Fraction(1, 10**12))


def _reached(family, m, share):
    """About the error at which h is this share of the stiffness, where h still rises."""
    low, high = Fraction(0), Fraction(4000)
    with mp.workdps(30):
        of = many_digits()
        for _ in range(70):
            middle = (low + high) / 2
            below = of.h(family, m, many(min(middle, Fraction(30)))) < many(share)
            low, high = (middle, high) if below else (low, middle)
    return low.limit_denominator(10**15)


@generates("Resting", 0.8)
def resting(random):
    """Bounds of the errors: none, far, near what h allows, or too small."""
    n = random.choice((1, 1, 2, 3))
    family, m = random.choice(FAMILIES)
    kp = gains(random, n)
    torque, errors, truth = [], [], None
    for k in kp:
        share = random.choice(SHARES if random.random() < 0.8 else LARGE)
        torque.append(share * k)
        if random.random() < 0.15:
            errors.append(None)
            continue
        error = _reached(family, m, min(share, Fraction(999, 1000)))
        step, kind = random.choice(STEPS), random.random()
        if share >= 1:
            errors.append(random.choice((Fraction(1), Fraction(10**6))))
        elif kind < 0.6:
            errors.append(error + step)
        elif error > step:
            errors.append(error - step)
            truth = FALSE
        else:
            errors.append(Fraction(0))
    if random.random() < 0.05:
        family, m, truth = *random.choice((("hyperbolic", None), ("linear", None), ("tanh", 2))), UNPROVABLE
    return Made(Resting(family, m, kp, tuple(torque), tuple(errors)), "states of rest", truth)
