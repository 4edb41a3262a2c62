"""ODEs of a few variables: motions by SciPy's integrators, with expressions evaluated here.

A state that occurs in sines and cosines alone is an angle: its distance from 0 is 2|sin(θ/2)|.
"""

import warnings
from collections import Counter
from fractions import Fraction
from math import cos, sin

import numpy as np
from scipy.integrate import solve_ivp

from tests import oracle
from tests.oracle import Objection

STARTS, FAR, MOST = 4, 1e6, 10_000
"""Motions, the size beyond which one has run away, and how often its rates may be asked for."""
LONG = {"nearby": 200.0, "everywhere": 200.0, "bounded": 10.0, "towards": 100.0}


class _Long(Exception):
    """A motion takes too many steps."""


@oracle.objections_to("Flow")
def flow(statement, random):
    """A motion that does not do what is said, of constants drawn at random."""
    names = [name for name, _ in statement.rates]
    known = {name: random.uniform(0.1, 3) for name in statement.constants}
    functions = {}

    def at(tree, x):
        if tree not in functions:
            functions[tree] = _compiled(tree, [*known, *names])
        return functions[tree](*known.values(), *map(float, x))

    asked = Counter()

    def rate(_, x):
        asked["rate"] += 1
        if asked["rate"] > MOST * STARTS:
            raise _Long
        return [at(tree, np.clip(x, -FAR, FAR)) + 0.0 for _, tree in statement.rates]

    try:
        with np.errstate(all="ignore"), warnings.catch_warnings():
            warnings.simplefilter("ignore")
            for _ in range(STARTS):
                start = _start(statement, at, len(names), random)
                if start is None:
                    return None
                fault = _fault(statement, at, rate, start)
                if fault:
                    return Objection("false", f"{fault}, from {start}, with {known}")
    except (_Long, KeyError, OverflowError, ZeroDivisionError, ValueError, AttributeError):
        return None
    return None


def _start(statement, at, n, random):
    """A start that the conclusion is about."""
    for _ in range(1000):
        radius = 3.0 if statement.radius is None else abs(at(statement.radius, [0.0] * n)) ** 0.5
        x = np.array([random.gauss(0, 1) for _ in range(n)])
        x *= random.uniform(0.3, 1) * radius / np.linalg.norm(x)
        if statement.conclusion != "nearby" or at(statement.energy, x) <= at(statement.level, x):
            return x
    return None


def _fault(statement, at, rate, start):
    origin = np.zeros(len(start))
    fixed = statement.conclusion in ("nearby", "everywhere")
    if fixed and np.abs(rate(0, origin)).max() > 1e-9:
        return "the origin moves"

    def escaped(_, x):
        return FAR - np.abs(x).max()

    escaped.terminal = True
    run = solve_ivp(
        rate, (0, LONG[statement.conclusion]), start, method="LSODA", rtol=1e-6, atol=1e-8, events=escaped
    )
    end = run.y[:, -1]
    if run.status == 1 or not np.isfinite(end).all():
        return "a motion runs away"
    if fixed and np.linalg.norm(_chords(statement, end)) > 0.5 * np.linalg.norm(_chords(statement, start)):
        return f"it is at {end} in the end"
    if statement.conclusion == "bounded" and at(statement.energy, end) > at(statement.level, end) + 1e-6:
        return f"V is {at(statement.energy, end)} in the end"
    far = [part for part in statement.parts if abs(at(part, end)) > 0.5 * abs(at(part, start)) + 1e-3]
    return f"{far[0]} is {at(far[0], end)} in the end" if far else ""


def _compiled(tree, names):
    """An expression as a function of its variables, in doubles."""
    body = _written(tree, {name: f"v{k}" for k, name in enumerate(names)})
    return eval(f"lambda {', '.join(f'v{k}' for k, _ in enumerate(names))}: {body}", {"sin": sin, "cos": cos})


def _written(tree, letters):
    kind, *rest = tree
    if kind == "num":
        return repr(float(Fraction(rest[0])))
    if kind == "var":
        return letters[rest[0]]
    if kind == "pow":
        return f"({_written(rest[0], letters)}) ** {rest[1]}"
    parts = [_written(part, letters) for part in rest]
    if kind in ("sin", "cos"):
        return f"{kind}({parts[0]})"
    if kind == "neg":
        return f"(-({parts[0]}))"
    return "(" + {"add": " + ", "mul": " * ", "div": " / "}[kind].join(f"({part})" for part in parts) + ")"


def _chords(statement, x):
    """The state with chords of the circle instead of angles."""
    trees = (*(tree for _, tree in statement.rates), statement.energy, *statement.parts)
    names = [name for name, _ in statement.rates]
    plain = {name for tree in trees for name in _plain(tree)}
    angles = {name for tree in trees for name in _turned(tree)} - plain
    return [2 * np.sin(entry / 2) if name in angles else entry for name, entry in zip(names, x, strict=True)]


def _plain(tree):
    """The states in an expression outside of sines and cosines."""
    if tree[0] == "var":
        yield tree[1]
    elif tree[0] not in ("sin", "cos", "num"):
        for part in tree[1:]:
            yield from _plain(part) if isinstance(part, tuple) else ()


def _turned(tree):
    """The states in sines and cosines."""
    if tree[0] in ("sin", "cos"):
        yield tree[1][1]
    for part in tree[1:]:
        yield from _turned(part) if isinstance(part, tuple) else ()
