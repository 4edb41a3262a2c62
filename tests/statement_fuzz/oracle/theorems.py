"""The step of a theorem: each of its hypotheses once, and numbers that bound what they stand for."""

from __future__ import annotations

from collections import Counter
from fractions import Fraction
from random import Random
from typing import Any

from mpmath import mp

from tests.statement_fuzz.oracle import exact, kinds
from tests.statement_fuzz.oracle.evaluate import Evaluation
from tests.statement_fuzz.oracle.numbers import DIGITS, Undefined, Unsure
from tests.statement_fuzz.oracle.region import Objection

COMMON = (
    "differentiable",
    "positive definite",
    "radially unbounded",
    "bounds of h",
    "rate bounded by a form",
)
BOUNDS = tuple(f"bounded {side} by a positive definite function" for side in ("below", "above"))
HYPOTHESES = {
    "Lyapunov's direct method": (*COMMON, "form negative definite", "only equilibrium"),
    "Lyapunov's direct method, time-varying": (*COMMON, *BOUNDS, "form negative definite", "equilibrium"),
}
OF_ARM = ("bounds of M", "bounds of C")
CONSTANTS = ("eps", "kp", "b_min", "b_max", "kv_max", "beta", "kc", "vd", "eps0")
VALUES = tuple(map(Fraction, ("1/10", "1/3", "1/2", "1", "2", "3", "5")))


@kinds.objections_to("Theorem")
def theorem(statement: Any, random: Random) -> Objection | None:
    """A hypothesis that is missing, a number with the wrong size, or a term without a value."""
    loop, timed = statement.loop, "time" in statement.name
    if statement.name not in HYPOTHESES:
        return Objection("false", "a theorem of another name")
    wanted = Counter((*HYPOTHESES[statement.name], *(OF_ARM if loop.arm else ())))
    if Counter(name for name, _ in statement.hypotheses) != wanted or loop.desired != timed:
        return Objection("false", "hypotheses of another theorem")
    sizes = (loop.gamma, loop.rho, loop.L, loop.reach, loop.G)
    if min(sizes) <= 0 or loop.gamma**2 * loop.n > loop.reach**2:
        return Objection("false", "a size of h that is not positive, or a reach that is none")
    # min(Lr, reach)/(1 + r) is largest where Lr = reach
    r = loop.reach / loop.L
    if loop.reach / (1 + r) > loop.G:
        return Objection("false", f"r = {r}")
    return _of_numbers(loop, timed) or _undefined(loop, random)


def _of_numbers(loop: Any, timed: bool) -> Objection | None:
    numbers, arm = dict(loop.numbers), loop.arm
    if arm is None:
        return Objection("false", "numbers of no arm") if numbers else None
    names = [*CONSTANTS[1:7], "eps0", *(["vd"] if timed else [])]
    if loop.condition or sorted(numbers) != sorted(names) or len(arm.kp) != loop.n or min(arm.kv) <= 0:
        return Objection("false", "numbers of another arm")
    bounds = (
        numbers["kp"] <= min(arm.kp),
        numbers["b_min"] <= min(arm.viscous),
        numbers["b_max"] >= max(arm.viscous),
        numbers["kv_max"] >= max(arm.kv),
        min(numbers["kp"], numbers["b_min"], numbers["eps0"]) > 0,
        min(numbers.values()) >= 0,
    )
    return None if all(bounds) else Objection("false", "a number that bounds nothing")


def _undefined(loop: Any, random: Random) -> Objection | None:
    """Positive constants, or an x, at which a term has no value."""
    with mp.workdps(DIGITS), exact.kept(True):
        for _ in range(30):
            point = {name: random.choice(VALUES) for name in CONSTANTS}
            sides = [side for relation in loop.condition for side in (relation.left, relation.right)]
            point["x"] = random.choice(VALUES) * random.choice((-1, 0, 1))
            try:
                for tree in (*loop.form, *sides, loop.h, loop.slope, loop.potential):
                    Evaluation(point).of(tree)
            except Undefined as why:
                return Objection("undefined", f"{point} ({why})")
            except Unsure:
                continue
    return None
