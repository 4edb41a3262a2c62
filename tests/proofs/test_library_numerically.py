"""The library against a moving arm: what is derived from a torque is compared with the arm under that torque.

Nothing of ``check.systems`` is used but the data: letters get their values from the arm, V is differentiated
along its motion by small steps, and the constants are those of the arm.
"""

import runpy
from fractions import Fraction

import numpy as np
import pytest

from lyapcheck.check.kinds.stable_arm import slopes_of_mass, slopes_of_symbols
from lyapcheck.check.loop.field import size_of
from lyapcheck.check.numbers.harmonics import by_parameters
from lyapcheck.claims import ArmBounds
from lyapcheck.claims.script import find_script
from lyapcheck.robots import load
from lyapcheck.robots.numeric import NumericModel
from tests.helpers.shares import one_in

GAINS = {"Kp": (30.0, 40.0), "Kv": (7.0, 3.0), "Ki": (2.0, 3.0), "K": (7.0, 3.0), "Lambda": (5.0, 4.0)}
ROBOT = load("pelican2").fixed()
MODEL, BOUNDS = NumericModel(ROBOT), ArmBounds(ROBOT)
B = np.array([float(b) for b in BOUNDS.viscous])


def gravity_bound():
    """A number above ‖∂g/∂q‖, from samples and a margin."""
    grid, step = np.random.default_rng(1).uniform(-4, 4, (400, 2)), 1e-6
    columns = [
        (MODEL.gravity(grid + step * unit) - MODEL.gravity(grid - step * unit)) / (2 * step)
        for unit in np.eye(2)
    ]
    return 1.01 * np.linalg.norm(np.stack(columns, axis=2), 2, axis=(1, 2)).max()


def size_of_slopes(slopes):
    """What ``at_arm`` takes for ‖M(q) − M(p)‖ and ‖C(q, x) − C(p, x)‖, up to rounding."""
    sizes = (float(size_of(by_parameters(slope, 2), ())) for slope in slopes(BOUNDS.mass))
    return np.sqrt(sum(size**2 for size in sizes))


CONSTANTS = {
    "mu": float(BOUNDS.guessed_floor()),
    "beta": float(BOUNDS.beta),
    "kc": float(BOUNDS.kc),
    "kg": gravity_bound(),
    "vd": 3.0,
    "alpha": 0.1,
    "R": 0.5,
    "km": size_of_slopes(slopes_of_mass),
    "kc2": size_of_slopes(slopes_of_symbols),
    "ad": 6.0,
    "eps0": 0.05,
    "B_min": B.min(),
    "B_max": B.max(),
    "B_norm": np.linalg.norm(B),
    "h_reach": np.sqrt(2),
    "h_slope": 1.0,
    "h_secant": 1.0,
    "h_sector": 1.0,
} | {
    f"{name}_{end}": of(np.array(values))
    for name, values in GAINS.items()
    for end, of in (("min", np.min), ("max", np.max), ("norm", np.linalg.norm))
}


class Moment:
    """The arm at one time: q, q̇, q_d with its derivatives, and the states of the controller."""

    def __init__(self, system, q, speed, goal, own):
        self.system, self.q, self.speed, self.own = system, q, speed, own
        self.goal, self.goal_speed, self.goal_push = goal
        self.e, self.w = self.goal - q, speed - self.goal_speed

    def letter(self, kind, name):
        """What a letter stands for."""
        at = {
            "e": self.e,
            "w": self.w,
            "B": B,
            "dqd": self.goal_speed,
            "ddqd": self.goal_push,
            **self.own,
            **GAINS,
        }
        if kind == "mat":
            return self.matrix(name)
        if kind == "diag":
            return np.diag(self.letter("vec", name))
        if kind == "var":
            size = {f"norm_{x}": np.linalg.norm(at[x]) for x in self.system.moving}
            size |= {"norm_h": np.linalg.norm(np.tanh(self.e)), "s": 1 / (1 + np.linalg.norm(self.e))}
            return (CONSTANTS | size)[name]
        heavy = {"g": self.q, "gd": self.goal}
        if name in heavy:
            return MODEL.gravity(heavy[name][None])[0]
        if name == "dg":
            return self.letter("vec", "g") - MODEL.gravity(self.goal[None])[0]
        return {"h": np.tanh(self.e), "Uh": np.log(np.cosh(self.e))}.get(name, np.array(at.get(name, 0.0)))

    def matrix(self, name):
        """M, C(q, w), D = C(q, q̇_d), and what M and D differ by from where q is q_d."""
        if name[0] == "d":
            goal = (self.goal, self.goal_speed, self.goal_push)
            there = Moment(self.system, self.goal, self.speed, goal, self.own)
            return self.matrix(name[1]) - there.matrix(name[1])
        x = self.goal_speed if name == "D" else self.w
        return MODEL.mass(self.q[None])[0] if name == "M" else MODEL.coriolis(self.q[None], x[None])[0]

    def value(self, tree):
        """An expression in numbers, vectors and matrices."""
        kind, *rest = tree
        if kind in ("vec", "mat", "diag", "var"):
            return self.letter(kind, rest[0])
        if kind == "num":
            return float(Fraction(rest[0]))
        parts = [self.value(part) if isinstance(part, tuple) else part for part in rest]
        return {
            "sum": lambda *x: sum(x, np.zeros(2)),
            "add": lambda *x: sum(x),
            "mul": lambda *x: np.prod(x),
            "neg": lambda x: -x,
            "div": lambda x, y: x / y,
            "pow": lambda x, k: x**k,
            "dot": lambda x, y: x @ y,
            "apply": lambda a, x: a @ x,
            "scale": lambda c, x: c * x,
            "transpose": lambda a: a.T,
        }[kind](*parts)

    def moved(self, step):
        """The arm a little later, or earlier."""
        push = self.value(self.system.torque) - self.letter("vec", "g") - B * self.speed
        push = push - MODEL.coriolis(self.q[None], self.speed[None])[0] @ self.speed
        acceleration = np.linalg.solve(self.letter("mat", "M"), push)
        own = {s.name: self.own[s.name] + step * self.value(s.rate) for s in self.system.states}
        goal = (
            self.goal + step * self.goal_speed + step**2 / 2 * self.goal_push,
            self.goal_speed + step * self.goal_push,
            self.goal_push,
        )
        q = self.q + step * self.speed + step**2 / 2 * acceleration
        return Moment(self.system, q, self.speed + step * acceleration, goal, own)

    def V(self, argument):
        """The value of V."""
        energy = self.value(argument.energy)
        if argument.gravity:
            energy += (
                MODEL.potential(self.q[None])[0]
                - MODEL.potential(self.goal[None])[0]
                + self.letter("vec", "gd") @ self.e
            )
        return energy


LIBRARY = (
    "takegaki_arimoto",
    "tomei",
    "kelly_gravity",
    "kelly_tanh",
    "pd_plus",
    "slotine_li",
    "pid",
    "feedforward",
)


def argument_of(name):
    """The argument of a script of the library."""
    theorem = runpy.run_path(str(find_script(f"{name}.py")))["theorem"]
    return (theorem if hasattr(theorem, "argument") else theorem()).argument


def moments(argument, count=150):
    """The arm at random times, and dV/dt there."""
    rng, step = np.random.default_rng(5), 1e-5
    for _ in range(count):
        scale = 10 ** rng.uniform(-1, 0.5)
        speed, push = (rng.normal(size=2) if argument.system.desired else np.zeros(2) for _ in range(2))
        goal = rng.uniform(-3, 3, 2), np.clip(speed, -2, 2), push
        e, w, z = scale * rng.normal(size=(3, 2))
        e = e * min(1.0, CONSTANTS["R"] / np.linalg.norm(e)) if argument.local else e
        now = Moment(
            argument.system, goal[0] - e, goal[1] + w, goal, {s.name: z for s in argument.system.states}
        )
        yield now, (now.moved(step).V(argument) - now.moved(-step).V(argument)) / (2 * step)


def test_differences_of_the_arm_are_within_their_slopes():
    """M and C at pairs of postures, near and far."""
    rng, largest = np.random.default_rng(2), {"km": 0.0, "kc2": 0.0}
    for _ in range(400):
        q, x = rng.uniform(-4, 4, 2), rng.normal(size=2)
        p = q + 10 ** rng.uniform(-3, 0) * rng.normal(size=2)
        M = np.subtract(*(MODEL.mass(at[None])[0] for at in (q, p)))
        C = np.subtract(*(MODEL.coriolis(at[None], x[None])[0] for at in (q, p)))
        apart = np.linalg.norm(q - p)
        found = {
            "km": np.linalg.norm(M, 2) / apart,
            "kc2": np.linalg.norm(C, 2) / np.linalg.norm(x) / apart,
        }
        largest = {name: max(value, found[name]) for name, value in largest.items()}
    for name, value in largest.items():
        assert CONSTANTS[name] / 4 < value <= CONSTANTS[name]


@pytest.mark.parametrize("name", one_in(9, LIBRARY))
def test_v_falls_along_the_arm_as_its_bound_says(name):
    argument = argument_of(name)
    for now, rate in moments(argument):
        bound = -now.value(argument.rate.tree)
        size = 1 + abs(rate) + abs(bound)
        assert rate <= bound + 1e-5 * size
        if not argument.changes:
            assert now.V(argument) >= now.value(argument.lower.tree) - 1e-9 * size
        if argument.upper is not None:
            assert now.V(argument) <= now.value(argument.upper.tree) + 1e-9 * size


def test_the_cascade_moves_as_its_bounds_say():
    """y = Λe − w along the arm: ‖M dy/dt‖, eᵀw, V and its rate against what is bounded by y's size."""
    argument = runpy.run_path(str(find_script("slotine_li.py")))["convergence"].argument
    gaps, step = [], 1e-5
    for now, rate in moments(argument):
        after, before = ((np.array(GAINS["Lambda"]) * at.e - at.w) for at in map(now.moved, (step, -step)))
        y = (after + before) / 2
        at = Sized(now, y)
        moved = np.linalg.norm(now.letter("mat", "M") @ (after - before)) / (2 * step)
        size = 1 + moved + abs(rate)
        gaps.append(at.value(argument.cascade.motion) - moved)
        assert gaps[-1] >= -1e-5 * size
        assert now.e @ now.w >= at.value(argument.cascade.contraction.tree) - 1e-9 * size
        assert now.V(argument) >= at.value(argument.lower.tree) - 1e-9 * size
        assert rate <= -at.value(argument.rate.tree) + 1e-5 * size
    assert min(gaps) < 1


class Sized(Moment):
    """A moment at which the changed letter has a size too."""

    def __init__(self, now, y):
        super().__init__(now.system, now.q, now.speed, (now.goal, now.goal_speed, now.goal_push), now.own)
        self.y = np.linalg.norm(y)

    def letter(self, kind, name):
        return self.y if name == "norm_y_w" else super().letter(kind, name)


@pytest.mark.parametrize("name", one_in(9, LIBRARY))
def test_twice_the_bound_would_be_too_much(name):
    """Negative control: the steps are fine enough to see it."""
    argument = argument_of(name)
    gaps = [rate + 2 * now.value(argument.rate.tree) for now, rate in moments(argument)]
    assert max(gaps) > 0.01
