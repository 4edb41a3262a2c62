"""Closed loops as data, with numbers: does the origin attract, of an arm of one or two joints?

The equations of motion are written out here, for a pendulum and for two links in a vertical plane, at a q_d
that rests. Arms, gains and constants are drawn until the conditions of the theorem hold. Then it is false if
the origin moves, if a linearisation has an eigenvalue on the right, if it swings for ever although functions
have slopes at 0, or if another state rests too.
"""

import warnings
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from math import exp, log, prod, sqrt
from typing import Any

import numpy as np
from scipy.optimize import fsolve

from lyapcheck.check.kinds.coriolis import CoriolisBelow
from lyapcheck.check.kinds.inertia import MassAbove, MassBelow
from tests import oracle
from tests.oracle import Objection
from tests.oracle.arm import Place, derivative

Array = Any
Function = Callable[[Array], Array]
TRIES, ARMS, STARTS = 300, 6, 6
BOUNDED = (
    (np.tanh, 1.0, 1.0),
    (np.arctan, 1.0, 1.6),
    (lambda x: x / np.sqrt(1 + x * x), 1.0, 1.0),
    (lambda x: 2 * np.tanh(3 * x), 6.0, 2.0),
)
"""Functions of the class, with a bound of slope and secant, and of the value."""
UNBOUNDED = ((lambda x: x, 1.0, 1e9), (lambda x: x + np.tanh(x), 2.0, 1e9))


@dataclass(frozen=True)
class Planar:
    """M = ((a + 2b cos q2, d + b cos q2), (…, d)), U_g = −p1 cos q1 − p2 cos(q1 + q2); or a pendulum."""

    n: int
    a: float
    b: float
    d: float
    p: tuple[float, float]
    viscous: Array

    def M(self, q):
        c = np.cos(q[-1])
        whole = [[self.a + 2 * self.b * c, self.d + self.b * c], [self.d + self.b * c, self.d]]
        return np.array(whole if self.n == 2 else [[self.a]])

    def C(self, q, x):
        if self.n == 1:
            return np.zeros((1, 1))
        k = self.b * np.sin(q[1])
        return np.array([[-k * x[1], -k * (x[0] + x[1])], [k * x[0], 0.0]])

    def g(self, q):
        first = self.p[0] * np.sin(q[0])
        last = self.p[1] * np.sin(q.sum())
        return np.array([first + last, last] if self.n == 2 else [first])

    @property
    def constants(self):
        """Bounds on the right side, not all of them tight."""
        eigenvalues = [np.linalg.eigvalsh(self.M(np.array([0.0, x]))) for x in np.linspace(0, np.pi, 91)]
        bounds = {"mu": min(one[0] for one in eigenvalues) / 1.001, "kg": self.p[0] + 2 * self.p[1]}
        bounds |= {"beta": max(one[-1] for one in eigenvalues) * 1.001}
        return bounds | {"kc": 3 * self.b, "kc2": 3 * self.b, "km": 2.5 * self.b}


class Written:
    """An arm whose M and U_g are written out as polynomials."""

    def __init__(self, arm):
        self.arm, self.n, self.viscous = arm, len(arm.mass), np.array(arm.viscous, float)

    def _at(self, q):
        return Place(np.sin(q), np.cos(q), (), float)

    def M(self, q):
        return np.array(self._at(q).matrix(self.arm.mass), float)

    def C(self, q, x):
        return np.array(self._at(q).symbols(self.arm.mass)) @ x

    def g(self, q):
        slopes = (derivative(self.arm.potential, k, self.n) for k in range(self.n))
        return np.array([self._at(q).value(slope) for slope in slopes])


def _size(random, low, high):
    return exp(random.uniform(log(low), log(high)))


def _sizes(random, wide, count):
    return [_size(random, 1 / wide, wide) for _ in range(count)]


def _arm(random, friction):
    n, weight = random.choice((1, 1, 2)), random.choice((0.0, 9.81))
    first, last = ([_size(random, *ends) for ends in ((0.2, 5), (0.3, 1.5), (0.01, 0.5))] for _ in range(2))
    (m1, l1, i1), (m2, l2, i2) = first, last
    rubbing = {"none": 0.0, "positive": 1.0}.get(friction, random.choice((0.0, 1.0)))
    viscous = np.array([rubbing * _size(random, 0.05, 3) for _ in range(n)])
    if n == 1:
        return Planar(1, i1 + m1 * l1 * l1, 0.0, 0.0, (weight * m1 * l1, 0.0), viscous)
    a = i1 + i2 + m1 * l1 * l1 / 4 + m2 * (l1 * l1 + l2 * l2 / 4)
    fall = (weight * (m1 / 2 + m2) * l1, weight * m2 * l2 / 2)
    return Planar(2, a, m2 * l1 * l2 / 2, i2 + m2 * l2 * l2 / 4, fall, viscous)


def _applied(matrix, vector):
    return matrix @ vector if np.ndim(matrix) and np.ndim(vector) else 0.0


COMBINED = {
    "apply": _applied,
    **dict.fromkeys(("sum", "add"), lambda *parts: sum(parts)),
    **dict.fromkeys(("scale", "mul"), lambda *parts: prod(parts)),
    "transpose": np.transpose,
    "neg": np.negative,
    "div": np.divide,
    "dot": np.dot,
    "atan": np.arctan,
}


def value(tree, known):
    """An expression in letters; a vector or matrix that is 0 may be the number 0."""
    kind, *rest = tree
    if kind in ("var", "vec", "mat"):
        return known[kind, rest[0]]
    if kind == "diag":
        return np.diag(known["vec", rest[0]])
    if kind == "pow":
        return value(rest[0], known) ** rest[1]
    if kind == "h":
        x = np.clip(value(rest[1], known), -100, 100)  # beyond, it is the same in doubles
        s, c = np.sinh(x), np.cosh(x)
        return s ** (2 * rest[0] - 1) * c / (1 + s ** (2 * rest[0]))
    if kind == "num":
        return float(Fraction(rest[0]))
    return (COMBINED.get(kind) or getattr(np, kind))(*(value(part, known) for part in rest))


@dataclass(frozen=True)
class Loop:
    """A closed loop with all its numbers, at a goal that rests."""

    system: Any
    arm: Planar
    goal: Array
    constants: dict[Any, Any]
    functions: dict[str, Function]
    sizes: dict[str, int]
    regressors: dict[str, Function]

    @property
    def ends(self):
        """Where the states end in the whole state."""
        each = [self.arm.n, self.arm.n, *(self.sizes.get(one.name, self.arm.n) for one in self.system.states)]
        return np.cumsum(each)

    @property
    def size(self):
        return int(self.ends[-1])

    def rate(self, x):
        """The derivative of (e, w, further states) by the equation of motion of the arm."""
        n, arm, system = self.arm.n, self.arm, self.system
        e, w, *more = np.split(x, self.ends[:-1])
        q, still = self.goal - e, np.zeros(n)
        at_goal = arm.g(self.goal)
        vectors = {"e": e, "w": w, "dqd": still, "ddqd": still, "g": arm.g(q), "gd": at_goal}
        vectors |= {"dg": arm.g(q) - at_goal, "d": still}
        vectors |= {state.name: own for state, own in zip(system.states, more, strict=True)}
        gain = {"": np.ones(n)} | {name: self.constants["vec", name] for name in system.gains}
        inner = {f.name: gain[f.gain] * vectors[f.of] for f in system.functions}
        vectors |= {name: self.functions[name](x) for name, x in inner.items()}
        for one in system.increases:
            sign = -1 if one.back else 1
            there = self.functions[one.function](
                inner[one.function] + sign * gain[one.gain] * vectors[one.of]
            )
            vectors[one.name] = sign * (there - vectors[one.function])
        nothing = np.zeros((n, n))
        matrices = {"M": arm.M(q), "C": arm.C(q, w), "D": nothing, "dD": nothing}
        matrices |= {"dM": arm.M(q) - arm.M(self.goal)}
        matrices |= {name: own(x) for name, own in self.regressors.items()}
        known = self.constants | {("vec", k): v for k, v in vectors.items()}
        known |= {("var", "s"): 1 / (1 + np.linalg.norm(e))}
        known |= {("mat", k): v for k, v in matrices.items()}
        torque = value(system.torque, known) + still
        moved = np.linalg.solve(arm.M(q), torque - arm.C(q, w) @ w - arm.g(q) - arm.viscous * w)
        moving = [value(one.rate, known) + 0 * own for one, own in zip(system.states, more, strict=True)]
        return np.concatenate([-w, moved, *moving])

    def slope(self):
        """The linearisation at the origin."""
        steps = 1e-6 * np.eye(self.size)
        return np.array([(self.rate(step) - self.rate(-step)) / 2e-6 for step in steps]).T


def _loops(argument, random):
    """Some that meet the conditions."""
    system, count = argument.system, 0
    for _ in range(TRIES):
        arm = _arm(random, system.friction)
        wide = random.choice((3, 30, 1000))
        sizes, regressors = _sized(system, arm.n, random)
        gains = {name: np.array(_sizes(random, wide, sizes.get(name, arm.n))) for name in system.gains}
        constants, functions = dict(arm.constants), {}
        for name, own in {**gains, "B": arm.viscous}.items():
            ends = {"min": own.min(), "max": own.max(), "norm": np.linalg.norm(own)}
            constants |= {f"{name}_{end}": float(number) for end, number in ends.items()}
        for f in system.functions:
            function, secant, slope, reach = _function(f, random)
            functions[f.name] = function
            gain = gains.get(f.gain, np.ones(arm.n))
            for one in (one for one in system.increases if one.function == f.name):
                own = slope * gains[one.gain].max()
                sizes_of = {"secant": own, "sector": 1 / own, "reach": 2 * sqrt(arm.n) * reach}
                constants |= {f"{one.name}_{end}": number for end, number in sizes_of.items()}
            if f.of == "e":
                constants |= _compared(f, function, gain, gains, arm)
            secant, slope = secant * gain.max(), slope * gain.max()
            bounds = {"secant": secant, "slope": slope, "sector": 1 / secant, "reach": sqrt(arm.n) * reach}
            constants |= {f"{f.name}_{end}": number for end, number in bounds.items()}
        constants |= {name: _size(random, 1e-3, 1e3) for name in system.constants}
        constants |= {"R": _size(random, 0.01, 10), "eps0": _size(random, 1e-4, 10), "delta": 0.0}
        constants |= {name: _size(random, 1e-3, 1) if system.desired else 0.0 for name in ("vd", "ad")}
        known = {("var", name): number for name, number in constants.items()}
        known |= {("vec", name): own for name, own in gains.items()} | {("vec", "B"): arm.viscous}
        gaps = [(value(one.right, known) - value(one.left, known), one.strict) for one in argument.where]
        if all(gap > 0 or (gap == 0 and not strict) for gap, strict in gaps):
            goal = np.array([random.uniform(-3, 3) for _ in range(arm.n)])
            yield Loop(system, arm, goal, known, functions, sizes, regressors)
            count += 1
        if count == ARMS:
            return


def _compared(f, function, gain, gains, arm):
    """f_kg and f_load of an arm, on a grid, from above."""
    x = np.geomspace(1e-4, 1e3, 400)
    values = [np.maximum(function(a * x), 1e-300) for a in gain]
    most = 2 * np.array([sum(arm.p), arm.p[1]])[: arm.n]
    kg = arm.constants["kg"]
    whole = max((np.minimum(kg * x, np.linalg.norm(most)) / own).max() for own in values)
    result = {f"{f.name}_kg": 1.05 * whole}
    if f.level:
        beside = zip(most, gains[f.level], values, strict=True)
        result[f"{f.name}_load"] = 1.05 * max(
            (np.minimum(kg * x, k) / (l * own)).max() for k, l, own in beside
        )
    return result


def _sized(system, n, random):
    """The sizes of gains and states that are not n, and regressors: smooth functions of the state."""
    columns = {name: random.randint(1, 3) for _, name in system.sizes}
    columns |= {one.columns: columns.get(one.columns, random.randint(1, 3)) for one in system.regressors}
    columns["n"] = n

    def regressor(width):
        shift = np.array([[random.uniform(-2, 2) for _ in range(width)] for _ in range(n)])
        slope = random.uniform(-1, 1)
        return lambda x: np.cos(shift + slope * x[: 2 * n].sum())

    regressors = {one.name: regressor(columns[one.columns]) for one in system.regressors}
    return {name: columns[size] for name, size in system.sizes}, regressors


def _function(f, random):
    """A function of the class, its secant, slope and reach."""
    if f.member is not None:
        own = f.member
        numbers = (float(own.secant), float(own.rho), 1e9 if own.gamma is None else float(own.gamma))
        return (lambda x: value(own.value, {("var", "x"): x}), *numbers)
    function, slope, reach = random.choice(BOUNDED if f.bounded else (*BOUNDED, *UNBOUNDED))
    return function, slope, slope, reach


@oracle.objections_to("StableArm")
def _stable_arm(statement, random):
    """Numbers that do not meet the conditions or are no bounds of this arm; or what breaks a theorem."""
    argument, arm = statement.argument, statement.arm
    numbers = {("var", name): number for name, number in statement.numbers}
    for one in argument.where:
        gap = value(one.right, numbers) - value(one.left, numbers)
        if gap < -1e-12:
            return Objection("false", "a condition at the numbers")
    for name, kind in (("mu", MassAbove), ("beta", MassBelow), ("kc", CoriolisBelow)):
        bound = numbers.get(("var", name))
        found = bound and oracle.objection(kind(arm.mass, (), bound), random.getrandbits(32))
        if found:
            return Objection("false", f"{name}: {found}")
    gains = {name: np.array(row, float) for name, row in statement.gains}
    known = {("vec", name): row for name, row in gains.items()} | {("vec", "B"): np.array(arm.viscous, float)}
    functions = {f.name: _function(f, random)[0] for f in argument.system.functions}
    goal = np.array([random.uniform(-3, 3) for _ in arm.mass])
    loop = Loop(argument.system, Written(arm), goal, known, functions, {}, {})
    try:
        fault = _fault(argument, loop, random)
    except KeyError:
        return None  # a constant that no condition asks for
    return Objection("false", f"{fault}, at q_d = {goal}") if fault else None


@oracle.objections_to("Stable")
def stable(statement, random):
    """The origin of an arm with such gains moves, is unstable, or is not the only state of rest."""
    argument = statement.argument
    try:
        with np.errstate(all="ignore"), warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of a search for rest that ends elsewhere
            for loop in _loops(argument, random):
                if fault := _fault(argument, loop, random):
                    gains = {name[1]: own for name, own in loop.constants.items() if name[0] == "vec"}
                    return Objection("false", f"{fault}, with {loop.arm}, q_d = {loop.goal}, gains {gains}")
    except (KeyError, OverflowError, ZeroDivisionError, np.linalg.LinAlgError):
        return None  # letters that the checker refuses, and numbers that doubles do not have
    return None


def _fault(argument, loop, random):
    origin = np.zeros(loop.size)
    if np.abs(loop.rate(origin)).max() > 1e-8:
        return "the origin moves"
    slope = loop.slope()
    rightmost, scale = np.linalg.eigvals(slope).real.max(), np.abs(slope).max()
    if rightmost > 1e-5 * (1 + scale):
        return f"an eigenvalue is {rightmost:.3g}"
    if argument.theorem in ("exponential", "ISS") and rightmost > -1e-12 * scale:
        return f"no decay: an eigenvalue is {rightmost:.3g}"
    comes = argument.theorem != "convergence" or "e" in argument.seen(argument.rate)
    elsewhere = _rests_elsewhere(loop, random) if comes and not argument.local else ""
    fading = {"LaSalle": set(loop.system.moving), "convergence": argument.seen(argument.rate)}
    swings = not elsewhere and _swings(loop, slope, fading.get(argument.theorem, ()))
    return "a linearisation does not fade" if swings else elsewhere


def _swings(loop, slope, fading):
    """Whether an eigenvalue is imaginary, as far as doubles tell, and states that should fade move with it.

    Where gains differ too much, weak damping looks like none; so does that by a function that is flat at 0.
    """
    gains = [own for (kind, name), own in loop.constants.items() if kind == "vec" and name != "B"]
    sizes = np.concatenate(gains or [[]])
    even = len(sizes) == 0 or sizes.max() < 1e3 * sizes.min()
    sloped = all(abs(function(np.array([1e-3]))[0]) > 1e-4 for function in loop.functions.values())
    values, vectors = np.linalg.eig(slope)
    lasting = vectors[:, values.real > -1e-12 * np.abs(values).max()]  # slow is not lasting
    parts = dict(zip(loop.system.moving, np.split(lasting, loop.ends[:-1]), strict=True))
    return even and sloped and any(np.abs(parts[name]).max(initial=0) > 1e-4 for name in fading)


def _rests_elsewhere(loop, random):
    """Another state of rest, found from random starts."""
    n = loop.arm.n
    resting = [k for k in range(loop.size) if not n <= k < 2 * n]

    def placed(y):
        x = np.zeros(loop.size)
        x[resting] = y
        return x

    for _ in range(STARTS):
        start = np.array([random.gauss(0, 3) for _ in resting])
        y, _, done, _ = fsolve(lambda y: loop.rate(placed(y))[n:], start, full_output=True)
        far = np.abs(y[:n]).max() > 0.05 and np.abs(y).max() < 1e3
        if done == 1 and far and np.abs(loop.rate(placed(y))).max() < 1e-9:
            return f"it rests at e = {y[:n]} too"
    return ""
