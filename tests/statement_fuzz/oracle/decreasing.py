"""dV/dt < 0: states at which it is not, found in doubles and shown in many digits; likewise bounds of K_v."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from math import isinf
from random import Random
from types import SimpleNamespace
from typing import Any

import numpy as np
from mpmath import mp

from tests.statement_fuzz.oracle import kinds
from tests.statement_fuzz.oracle.arm import CERTAIN, DIGITS, read
from tests.statement_fuzz.oracle.arms import mass_above
from tests.statement_fuzz.oracle.climb import climbed
from tests.statement_fuzz.oracle.evaluate import Evaluation
from tests.statement_fuzz.oracle.functions import ends
from tests.statement_fuzz.oracle.loop import DOUBLES, FARTHEST, Loop
from tests.statement_fuzz.oracle.numbers import Undefined, Unsure
from tests.statement_fuzz.oracle.region import Objection

SAMPLES = 1_000
ROUNDS = 12
LARGEST = 9.0
"""The logarithm of the largest rates: beyond them, doubles lose what is left when C(q, w)w cancels."""
ALLOWED = Fraction(1, 1000)
"""ε₀ at which V should fall under any damping, as a share of what is thought of as small."""


def loop_of(statement: Any, viscous: Sequence[Any], parameters: Sequence[Any]) -> Loop:
    """One arm within the ranges of a statement."""
    return Loop(
        statement.mass,
        viscous,
        parameters,
        statement.family,
        statement.m,
        statement.kp,
        statement.kv,
        getattr(statement, "eps0", Fraction(0)),
        getattr(statement, "coupling", ()),
    )


class States:
    """Columns of a search as states, and as arms within their ranges."""

    def __init__(self, z: Any, statement: Any) -> None:
        n = len(statement.mass)
        self.q = z[:n]
        moved = np.sign(z[n : 3 * n]) * np.expm1(np.minimum(np.abs(z[n : 3 * n]), LARGEST))
        self.e, self.w = moved[:n], moved[n:]
        self.e = np.where(self.e == 0, 1e-9, np.clip(self.e, -FARTHEST, FARTHEST))
        self.shares = np.clip(z[3 * n :], 0, 1)
        self.ranges = [*statement.viscous, *statement.parameters]

    def numbers(self) -> list[Any]:
        """Friction and parameters in doubles."""
        return [float(a) + float(b - a) * t for (a, b), t in zip(self.ranges, self.shares, strict=True)]

    def exactly(self) -> tuple[list[list[Fraction]], list[Fraction]]:
        """q, e, w, and friction and parameters, of a single column as fractions."""
        state = [[Fraction(float(x)) for x in part] for part in (self.q, self.e, self.w)]
        pairs = zip(self.ranges, self.shares, strict=True)
        return state, [a + (b - a) * Fraction(float(t)) for (a, b), t in pairs]


def _start(n: int, numbers: int) -> Any:
    """Columns to begin with: near the origin and far from it, w often beside a multiple of e."""

    def columns(random: Any, count: int) -> Any:
        q = random.uniform(-np.pi, np.pi, (n, count))
        e = random.standard_normal((n, count)) * np.exp(random.uniform(-5, 1, count))
        w = random.standard_normal((n, count)) * np.exp(random.uniform(-5, 1.5, count))
        beside = random.random(count) < 0.5
        w = np.where(beside, e * np.exp(random.uniform(-4, 2, count)) * np.sign(w[:1]), w)
        shares = np.clip(random.uniform(-0.5, 1.5, (numbers, count)), 0, 1)
        return np.concatenate([q, e, w, shares])

    return columns


def rising(statement: Any, random: Random) -> tuple[float, States]:
    """How fast V rises at most beside friction and stiffness, and the states at which it does."""
    n = len(statement.mass)

    def share(z: Any) -> Any:
        at = States(z, statement)
        numbers = at.numbers()
        loop = loop_of(statement, numbers[:n], numbers[n:])
        with np.errstate(all="ignore"):
            rate = loop.rate(list(at.q), list(at.e), list(at.w), DOUBLES)
            h = DOUBLES.h(statement.family, statement.m, at.e)
            eps = abs(float(loop.eps0)) / (1 + np.linalg.norm(at.e, axis=0))
            size = sum(at.w**2) + eps * sum(h**2)
            return rate / np.where(size > 0, size, np.inf)

    best, z = climbed(share, _start(n, n + len(statement.parameters)), random, SAMPLES, ROUNDS)
    return best, States(z, statement)


@kinds.objections_to("Decreasing")
def decreasing(statement: Any, random: Random) -> Objection | None:
    """A posture at which M is not positive definite, or a state at which V does not fall."""
    low = SimpleNamespace(mass=statement.mass, parameters=statement.parameters, low=Fraction(0))
    result = mass_above(low, random)
    if result is not None:
        return result
    if (joint := held(statement)) is not None:
        return Objection("false", f"w = 0, e along joint {joint + 1}")
    best, at = rising(statement, random)
    return rises_at(statement, at) if best > -1e-6 else None


def rises_at(statement: Any, at: States) -> Objection | None:
    """An objection, where dV/dt ≥ 0 at a state in many digits."""
    state, numbers = at.exactly()
    n = len(statement.mass)
    if not _rises(loop_of(statement, numbers[:n], numbers[n:]), state):
        return None
    places = ", ".join(
        f"{name} = {[float(x) for x in part]}" for name, part in zip("qew", state, strict=True)
    )
    return Objection("false", places)


def held(statement: Any) -> int | None:
    """A joint along which V does not fall at rest, where dV/dt = −ε Σ λ_i k_pi h_i²."""
    weights = statement.coupling or (1,) * len(statement.kp)
    signs = [statement.eps0 * k * c for k, c in zip(statement.kp, weights, strict=True)]
    return next((joint for joint, sign in enumerate(signs) if sign <= 0), None)


def _rises(loop: Loop, state: Sequence[Sequence[Fraction]]) -> bool | None:
    """Whether dV/dt ≥ 0 at a state, which at 0 itself is left open."""
    if not any(state[1]):
        state = [state[0], [Fraction(1, 10**30)] * len(state[0]), state[2]]
    with mp.workdps(3 * DIGITS):
        rate = loop.exact_rate(*state)
        return None if abs(rate) < CERTAIN**2 else bool(rate > 0)


@kinds.judges("Decreasing")
def rises_there(statement: Any, witness: Mapping[str, Any]) -> bool | None:
    """Whether dV/dt > 0 at the state for the arm in the middle of the ranges, or M is not definite there."""
    point, n = witness["point"], len(statement.mass)
    if "x1" in point:
        low = SimpleNamespace(mass=statement.mass, parameters=statement.parameters, low=Fraction(0))
        return kinds.JUDGEMENTS["MassAbove"](low, witness)
    parts = [read(point, letter, n) for letter in "qew"]
    if any(part is None for part in parts):
        return False
    viscous, parameters = (
        [(a + b) / 2 for a, b in ranges] for ranges in (statement.viscous, statement.parameters)
    )
    return _rises(loop_of(statement, viscous, parameters), [part or [] for part in parts])


@kinds.objections_to("DampingBelow")
def damping_below(statement: Any, random: Random) -> Objection | None:
    """A multiple of K_v beyond the bound, and an ε₀ at which no state is found where V does not fall."""
    try:
        with mp.workdps(DIGITS):
            highest = float(ends(Evaluation({}).of(statement.bound))[1])
    except Undefined as why:
        return Objection("undefined", f"the bound ({why})")
    except Unsure:
        return None
    if isinf(highest):
        return None
    bound = Fraction(highest)
    factor = (max(bound, Fraction(0)) + 1) / max(statement.kv)
    if _falls(statement, factor, ALLOWED / (1 + factor), random):
        return Objection("false", f"κ = {float(factor)}")
    return None


def _falls(statement: Any, factor: Fraction, eps0: Fraction, random: Random) -> bool:
    """Whether nothing is found against dV/dt < 0 at κK_v and ε₀."""
    data = {name: getattr(statement, name) for name in ("mass", "viscous", "parameters", "family", "m", "kp")}
    tried = SimpleNamespace(**data, kv=tuple(factor * k for k in statement.kv), eps0=eps0, coupling=())
    positive = min((*statement.kp, *(low for low, _ in statement.viscous))) > 0
    return positive and decreasing(tried, random) is None


@kinds.judges("DampingBelow")
def damping_above(statement: Any, witness: Mapping[str, Any]) -> bool | None:
    """Whether the gains break the bound, and nothing is found against dV/dt < 0 with them."""
    point = witness["point"]
    factor, eps0 = Fraction(point["factor of K_v"]), Fraction(point["eps0"])
    with mp.workdps(DIGITS):
        try:
            low = ends(Evaluation({}).of(statement.bound))[0]
        except (Undefined, Unsure):
            return False
        reached = factor * max(statement.kv)
        if mp.mpf(reached.numerator) / reached.denominator < low * (1 - mp.mpf(10) ** -12):
            return False
    return _falls(statement, factor, eps0, Random(0))
