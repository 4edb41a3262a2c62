"""Goals at which a sampled loop is unstable: postures by eigenvalues, then data for the checker's rule.

References: ``reyes2019family`` (1), (6).
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import pairwise

import numpy as np
from flint import arb

from lyapcheck._types import SEED, Array
from lyapcheck.check.kinds.chain import OwnMoments
from lyapcheck.check.kinds.inertia import Bisection, Links, MassAtCorners
from lyapcheck.check.kinds.sampled import SampledStable
from lyapcheck.check.kinds.sampled_from_rest import SampledFromRest
from lyapcheck.check.kinds.sampled_unstable import GrowingMotion
from lyapcheck.check.loop import corners_of
from lyapcheck.check.numbers.members import member
from lyapcheck.check.statement import Ends, Monomials, Proof
from lyapcheck.control.judgement import refutes
from lyapcheck.files.decimals import decimal_text, significant_down, significant_up
from lyapcheck.robots import trig
from lyapcheck.robots.dynamics import FEW_JOINTS, Chain
from lyapcheck.robots.fields import Number
from lyapcheck.robots.numeric import NumericModel
from lyapcheck.robots.plant import RobotModel
from lyapcheck.robots.trig import Polynomials

POSTURES, SLOPES, LIGHT, STEEP = 3000, 300, 12, 4
"""At so many goals M is looked at, at so many ∂g/∂q; of so many of each then the eigenvalues."""
ROUNDS, TRIED, REACH, TENTHS = 6, 8, 30.0, 10
"""Steps from the worst goal, at first of about so many degrees, rounded to tenths."""
TERMS = 12
UNSTABLE = 1e-7
"""By how much a radius is to exceed 1 before the checker is asked."""
SHARES = (0.95, 0.8, 0.6, 0.4, 0.2)
"""Of the growth beyond 1, of which the first that the checker accepts is shown."""
DIGITS, SEEN = 3, 1e-9
MOST_RANGING = 5
STEP, HALVINGS, EACH = 0.7, 7, 3


@dataclass(frozen=True)
class LinearLoop:
    """A sampled loop of an arm, to be linearised at goals.

    Args:
        arm: in NumPy.
        parameters: its exact numbers.
        inertia: what shows M(q) ≻ 0.
        viscous: diagonal of B, (n,), N·m·s/rad.
        stiffness: diagonal of h'(0)K_p, (n,), N·m/rad.
        damping: diagonal of h'(0)K_v, (n,), N·m·s/rad.
        delay: samples from a reading to its torque.
        taps: of the velocity filter.
    """

    arm: NumericModel
    parameters: tuple[Fraction, ...]
    inertia: Proof
    viscous: Array
    stiffness: Array
    damping: Array
    delay: int
    taps: tuple[float, ...]

    def transition(self, goals: Array, period: float) -> Array:
        """Φ of ``lyapcheck.check.kinds.sampled_unstable`` at goals (N, n), degrees, in doubles: (N, s, s)."""
        q, n, d = np.radians(goals), self.arm.n, self.delay
        count, unit, readings = len(q), np.eye(n), d + len(self.taps)
        slope = self._slope(q)
        rates = np.zeros((count, 3 * n, 3 * n))
        rates[:, :n, n : 2 * n] = unit
        rates[:, n : 2 * n, :n], rates[:, n : 2 * n, 2 * n :] = -slope, unit
        rates[:, n : 2 * n, n : 2 * n] = -np.diag(self.viscous)
        rates[:, n : 2 * n] = np.linalg.solve(self.arm.mass(q), rates[:, n : 2 * n])
        step = _exponentials(rates * period)[:, : 2 * n]
        torque = np.zeros((count, n, n * (2 + readings)))
        place = [slice(0, n), *(slice((2 + k) * n, (3 + k) * n) for k in range(readings))]
        torque[:, :, place[d]] += slope - np.diag(self.stiffness)
        for j, tap in enumerate(self.taps, start=d):
            torque[:, :, place[j]] -= np.diag(self.damping) * tap / period
            torque[:, :, place[j + 1]] += np.diag(self.damping) * tap / period
        result = np.zeros((count, n * (2 + readings), n * (2 + readings)))
        result[:, : 2 * n, : 2 * n] = step[:, :, : 2 * n]
        result[:, : 2 * n] += step[:, :, 2 * n :] @ torque
        for new, old in zip(place[1:], place, strict=False):
            result[:, new, old] = unit
        return result

    def radii(self, goals: Array, period: float) -> Array:
        """The largest modulus of an eigenvalue of Φ at each goal, (N,)."""
        result: Array = np.abs(np.linalg.eigvals(self.transition(goals, period))).max(axis=-1)
        return result

    def _slope(self, q: Array) -> Array:
        """∂g/∂q: each angle is in g by its sine and cosine alone, so that quarter turns show it."""
        n, quarter = self.arm.n, 0.5 * np.pi * np.eye(self.arm.n)
        torques = self.arm.gravity(q[:, None, :] + np.concatenate([quarter, -quarter]))
        result: Array = 0.5 * (torques[:, :n] - torques[:, n:]).swapaxes(1, 2)
        return result

    @cached_property
    def _drawn(self) -> tuple[Array, Array, Array]:
        """Goals, degrees, M at them, and those of the first at which gravity pushes away most."""
        goals = np.random.default_rng(SEED).integers(-180, 180, (POSTURES, self.arm.n)).astype(float)
        slopes = self._slope(np.radians(goals[:: POSTURES // SLOPES]))
        steep = np.argsort(np.linalg.eigvalsh(slopes)[:, 0])[:STEEP]
        return goals, self.arm.mass(np.radians(goals)), goals[:: POSTURES // SLOPES][steep]

    def suspects(self, period: float) -> Array:
        """Goals, (N, n), degrees: where M + T B is least beside the gains, or gravity pushes away most."""
        goals, mass, steep = self._drawn
        scale = np.sqrt(self.damping + period * (1 + self.stiffness))  # h'(0) may be 0
        inertia = (mass + period * np.diag(self.viscous)) / np.outer(scale, scale)
        light = np.argsort(np.linalg.eigvalsh(inertia)[:, 0])[:LIGHT]
        return np.concatenate([goals[light], steep])

    def worst(self, goals: Array, period: float) -> tuple[Array, float]:
        """A goal near the worst of some at which the radius is about largest, and that radius."""
        random, radii = np.random.default_rng(SEED), self.radii(goals, period)
        best, radius, reach = goals[int(np.argmax(radii))], float(radii.max()), REACH
        for _ in range(ROUNDS):
            tried = np.round(best + random.normal(0, reach, (TRIED, len(best))) * TENTHS) / TENTHS
            radii = self.radii(tried, period)
            if radii.max() > radius:
                best, radius = tried[int(np.argmax(radii))], float(radii.max())
            else:
                reach *= 0.5
        return best, radius


def _exponentials(matrices: Array) -> Array:
    """e^A of many small matrices at once, (N, s, s): Taylor's series of A/2ᵏ, then squares.

    That of SciPy takes one after the other, each by threads that wait for each other.
    """
    halvings = max(0, math.ceil(math.log2(max(float(np.abs(matrices).sum(axis=-1).max()), 1e-300)))) + 2
    result = term = np.broadcast_to(np.eye(matrices.shape[-1]), matrices.shape)
    for k in range(1, TERMS + 1):
        term = term @ matrices / (k * 2**halvings)
        result = result + term
    for _ in range(halvings):
        result = result @ result
    return result


Data = tuple[Fraction, tuple[tuple[Fraction, ...], ...], tuple[Fraction, ...]]


def growth(step: Array, n: int, share: float) -> Data | None:
    """μ, S (its lower half) and a start that show how motions grow under Φ, (s, s).

    With Φ/μ = diag(T_u, T_s) in coordinates a, b and T_uᵀP_uT_u − P_u = I, P_s − T_sᵀP_sT_s = I the form
    S = bᵀP_sb − c aᵀP_ua makes μ²S − ΦᵀSΦ = μ²(|b|² + c|a|²); c is so large that the start has S < 0.
    """
    from scipy.linalg import eigh, matrix_balance, schur, solve_discrete_lyapunov, solve_sylvester

    balanced, (scale, _) = matrix_balance(step, permute=False, separate=True)
    radius = float(np.abs(np.linalg.eigvals(balanced)).max())
    mu = 1 + significant_down(Fraction(share * (radius - 1)), DIGITS)
    T, Z, count = schur(balanced / float(mu), output="real", sort="ouc")
    if not 0 < count < len(T):
        return None
    up, down = T[:count, :count], T[count:, count:]
    back = np.linalg.inv(up)
    grown = solve_discrete_lyapunov(back.T, back.T @ back)
    fallen = solve_discrete_lyapunov(down.T, np.eye(len(down)))
    axes = Z.T / scale
    a, b = axes[:count] + solve_sylvester(up, -down, T[:count, count:]) @ axes[count:], axes[count:]
    unstable, stable = a.T @ grown @ a, b.T @ fallen @ b
    moved = np.zeros((len(step), 2 * n))
    moved[:, :n], moved[n : 2 * n] = np.tile(np.eye(n), (len(step) // n, 1)), np.eye(2 * n)[n:]
    for entries in (n, 2 * n):  # from rest, unless that does not grow
        grows, falls = (moved[:, :entries].T @ form @ moved[:, :entries] for form in (unstable, stable))
        shares, starts = eigh(grows, falls)
        v = np.zeros(2 * n)
        v[:entries] = np.round(starts[:, -1] / np.abs(starts[:, -1]).max(), DIGITS)
        if shares[-1] > SEEN:
            break
    x = moved @ v
    form = stable - 4 * (x @ stable @ x) / (x @ unstable @ x) * unstable
    half = tuple(tuple(Fraction(float(x)) for x in row[: i + 1]) for i, row in enumerate(form))
    return mu, half, tuple(Fraction(repr(float(x))) for x in v)


def loops(statement: SampledStable, arm: RobotModel | None = None) -> Iterator[LinearLoop]:
    """The loop of each arm that is looked at: at the corners of the ranges, or at both ends of all."""
    steep = float(member(statement.family, statement.m).dh(arb(0)))
    plant = arm or plant_of(statement)
    for numbers in corners(plant):
        known = dict(zip(plant.parameters, numbers, strict=True))
        chain = plant.fixed(**known).chain
        inertia: Proof = OwnMoments() if statement.links else Bisection()
        if statement.mass and statement.n > FEW_JOINTS and chain is not None:
            links = Links(chain.links)
            inertia = MassAtCorners((links,)) if numbers else links
        yield LinearLoop(
            NumericModel(plant, known),
            numbers,
            inertia,
            np.array(statement.viscous_min, dtype=float),
            steep * np.array(statement.kp, dtype=float),
            steep * np.array(statement.kv, dtype=float),
            statement.delay,
            tuple(map(float, statement.taps)),
        )


def plant_of(statement: SampledStable | SampledFromRest) -> RobotModel:
    """The arm of a statement, with its ranges."""
    if isinstance(statement, SampledStable) and statement.links:
        chain = Chain(statement.links, statement.fall)
        return RobotModel(name="arm", joints=(), dynamics=chain, viscous=())
    return arm_of_terms(statement.mass, statement.parameters, statement.potential)


def arm_of_terms(
    mass: Sequence[Sequence[Monomials]], parameters: Sequence[Ends], potential: Monomials = ()
) -> RobotModel:
    """An arm from its polynomials as statements have them, at the middle of its ranges."""
    names = [f"p{k}" for k, _ in enumerate(parameters, 1)]
    numbers = {
        name: Number((low + high) / 2, low=low, high=high)
        for name, (low, high) in zip(names, parameters, strict=True)
    }
    ring = trig.trig_ring(len(mass), names)
    entries = tuple(tuple(trig.from_terms(ring, entry) for entry in row) for row in mass)
    dynamics = Polynomials(entries, trig.from_terms(ring, potential), tuple(names))
    return RobotModel(name="the arm", joints=(), dynamics=dynamics, viscous=(), parameters=numbers)


def corners(plant: RobotModel) -> Iterator[tuple[Fraction, ...]]:
    """The corners of the ranges of an arm, or both ends of all of them."""
    if sum(low < high for low, high in plant.ranges) <= MOST_RANGING:
        yield from corners_of(plant.ranges)
    else:
        yield from (tuple(pair[end] for pair in plant.ranges) for end in (0, 1))


def refuted_at(
    statement: SampledStable, period: Fraction, arm: RobotModel | None = None
) -> GrowingMotion | None:
    """What refutes stability at intervals of exactly this period; ``None`` where nothing is found.

    Args:
        statement: the loop.
        period: s, at most that of the statement.
        arm: that it is about, where it is known; of many joints with ranges it shows M ≻ 0.

    Soundness: ``lyapcheck.check.verify`` has accepted it.
    """
    T, known = float(period), list(loops(statement, arm))
    loop, _ = _least_stable(known, T)
    goal, radius = loop.worst(loop.suspects(T), T)
    return _accepted(statement, loop, goal, period) if radius > 1 + UNSTABLE else None


def smallest_refuted(
    statement: SampledStable, above: Fraction, arm: RobotModel | None = None
) -> GrowingMotion | None:
    """What refutes about the smallest period up to that of the statement; ``None`` where none is found.

    Args:
        statement: the loop.
        above: a period above which to look, s.
        arm: see `refuted_at`.

    Soundness: as `refuted_at`; nothing says that no smaller period is unstable.
    """
    ends = math.log(above), math.log(statement.period)
    periods = np.exp(np.linspace(*ends, 1 + math.ceil((ends[1] - ends[0]) / STEP)))
    known = list(loops(statement, arm))
    for low, high in pairwise(map(float, periods)):
        loop, radius = _least_stable(known, high)
        if radius > 1 + UNSTABLE:
            return _closed_in(statement, loop, low, high)
    return None


def _least_stable(known: Sequence[LinearLoop], period: float) -> tuple[LinearLoop, float]:
    """The loop with the largest radius at some of its suspects."""
    rows = ((loop, float(loop.radii(loop.suspects(period)[::EACH], period).max())) for loop in known)
    return max(rows, key=lambda row: row[1])


def _closed_in(statement: SampledStable, loop: LinearLoop, low: float, high: float) -> GrowingMotion | None:
    """From a period that a light goal refutes down to about the least that one near it does."""
    goal, _ = loop.worst(loop.suspects(high), high)
    for _ in range(HALVINGS):
        middle = math.sqrt(low * high)
        other, radius = loop.worst(np.concatenate([goal[None], loop.suspects(middle)]), middle)
        goal, low, high = (other, low, middle) if radius > 1 + UNSTABLE else (goal, middle, high)
    period = min(significant_up(Fraction(high), DIGITS), statement.period)
    return _accepted(statement, loop, goal, period)


def _accepted(
    statement: SampledStable, loop: LinearLoop, goal: Array, period: Fraction
) -> GrowingMotion | None:
    step = loop.transition(goal[None], float(period))[0]
    degrees = tuple(Fraction(round(float(x) * TENTHS), TENTHS) for x in goal)
    for share in SHARES:
        try:
            with np.errstate(divide="raise", over="raise", invalid="raise"):
                data = growth(step, statement.n, share)
        except (np.linalg.LinAlgError, ValueError, ArithmeticError):
            continue  # doubles are too coarse for this loop: nothing is shown of it
        if data is not None:
            proof = GrowingMotion(period, degrees, loop.parameters, *data, loop.inertia)
            if refutes(statement, proof):
                return proof
    return None


def witness_of(proof: GrowingMotion) -> dict[str, str]:
    """A refutation in words: where, at which period, how fast; a start up to a small factor."""
    words = {
        "goal": f"({', '.join(map(decimal_text, proof.goal))})°",
        "period": f"{decimal_text(1000 * proof.period)} ms",
        "growth": f"{decimal_text(proof.growth)} times a sample, or more",
    }
    n = len(proof.goal)
    for name, part in (
        ("away", proof.start[:n]),
        ("rates", proof.start[n:]),
        ("parameters", proof.parameters),
    ):
        if any(part):
            words[name] = f"({', '.join(map(decimal_text, part))})"
    return words
