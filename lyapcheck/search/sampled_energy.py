"""The numbers of an energy that falls along the loop on a computer, by a convex program; only proposed.

References: ``lyapcheck.check.loop.sampled_energy``.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import pairwise, product
from typing import Any

import numpy as np
from flint import arb

from lyapcheck._types import SEED, Array
from lyapcheck.check.kinds.sampled_from_rest import (
    EnergyOfLinks,
    FallingEnergy,
    SampledFromRest,
    arm_bounds,
    bounded_gains,
)
from lyapcheck.check.loop.sampled_energy import PIECES, ArmBounds, Gains, SampledEnergy, Splits, form_of
from lyapcheck.check.loop.storage import Shown
from lyapcheck.check.numbers.members import member
from lyapcheck.constants.storage import energy_problem, propose
from lyapcheck.control.judgement import proves
from lyapcheck.convex import Ended, solved
from lyapcheck.robots.dynamics import Chain
from lyapcheck.robots.numeric import NumericModel
from lyapcheck.search.sampled import corners, plant_of

SAMPLES, WORST = 3000, 40
SPARE, SHARE, SPEED = 0.98, 0.2, 1.001
REACHES = (2.0, 1.5, 3.0)
MARGINS, ROUNDED = (1e-9, 1e-7, 1e-5), 1 - 1e-7
LEAST_WEIGHT, LARGEST_WEIGHT, STIFFEST, TINY = 1e-4, 50.0, 1.1, 1e-9


def falling_energy(statement: SampledFromRest, chains: Sequence[Chain] = ()) -> FallingEnergy | None:
    """A proof that the checker accepts; ``None`` where none is found.

    Args:
        statement: the question.
        chains: the links of the arm at each corner of its ranges, where they are known.

    Soundness: ``lyapcheck.check.verify`` has accepted it.
    """
    kp, kv = (np.array(row, dtype=float) for row in (statement.kp, statement.kv))
    friction = np.array(statement.viscous, dtype=float)
    weight = kv + friction[:, 1]
    least, along = _least(statement, kv + 0.02 * friction[:, 1] + 1e-3 * kp), None
    if not least.min() > 0:
        return None
    if chains:
        least, along = _along(chains, least)
        if along is None:
            return None
    arm = arm_bounds(statement, tuple(map(_fraction, least)))
    potential = member(statement.family, statement.m).potential
    stored = float(potential(arb(math.radians(float(statement.within))))) * kp.sum()
    speed = SPEED * math.sqrt(2 * STIFFEST * stored / (1 - SHARE))
    for reach in REACHES:
        proof = _Program(statement, arm, least, speed, reach, weight).proof()
        if proof is not None and proves(statement, proof := replace(proof, along=along)):
            return proof
    return None


def _fraction(x: Any) -> Fraction:
    return Fraction(float(f"{float(x):.9g}"))


def _least(statement: SampledFromRest, wanted: Array) -> Array:
    """u with M ≽ diag(u) at sampled postures and corners, its product about largest; a little less."""
    import cvxpy as cp

    random, masses, plant = np.random.default_rng(SEED), [], plant_of(statement)
    for numbers in corners(plant):
        arm = NumericModel(plant, dict(zip(plant.parameters, numbers, strict=True)))
        masses.append(arm.mass(random.uniform(-np.pi, np.pi, (SAMPLES, arm.n))))
        masses.append(arm.mass(random.choice(np.pi / 2 * np.arange(4), (SAMPLES // 10, arm.n))))
    mass = np.concatenate(masses)
    root = np.sqrt(wanted)
    sizes = np.linalg.eigvalsh(mass / np.outer(root, root))[:, 0]
    u, t = cp.Variable(len(wanted)), sizes.min()
    if not t > 0:  # M is not positive definite somewhere
        return np.zeros(len(wanted))
    scale = np.sqrt(np.diag(mass.max(axis=0)))
    some = [m / np.outer(scale, scale) for m in mass[np.argsort(sizes)[:WORST]]]
    rules = [m - cp.diag(cp.multiply(u, 1 / scale**2)) >> 0 for m in some] + [u >= 0.85 * t * wanted]
    found = solved(cp.sum(cp.log(u)), rules, [u])
    least = np.maximum(found.values[0] if found.values else 0.0, 0.85 * t * wanted)
    root = np.sqrt(least)
    result: Array = least * min(np.linalg.eigvalsh(mass / np.outer(root, root))[:, 0].min(), 1.0) * SPARE
    return result


def _along(chains: Sequence[Chain], wanted: Array) -> tuple[Array, EnergyOfLinks | None]:
    """About the largest u in proportion to these with M ≽ diag(u) at each corner, and what shows it."""
    problems = [energy_problem(chain, -1) for chain in chains]
    for margin in MARGINS:
        found = propose(problems, margin, wanted[:, None])
        if found is not None:
            least = np.array([float(_fraction(-x)) for x in found[0] * ROUNDED])
            forms = tuple(tuple(tuple(map(Fraction, map(float, row))) for row in rows) for rows in found[1])
            shown = Shown(tuple(-_fraction(x) for x in least), forms)
            if least.min() > 0 and shown.holds([problem.stages for problem in problems], 2):
                return least, EnergyOfLinks(tuple(chain.links for chain in chains), forms)
    return wanted, None


@dataclass
class _Program:
    """The convex program for one λ: what couples joints is shared out, what is left is definite.

    Args:
        statement: the loop.
        arm: its bounds.
        least: u of them.
        speed: that motions are to keep.
        reach: λ.
        weight: K_v + B, the unit of w².
    """

    statement: SampledFromRest
    arm: ArmBounds
    least: Array
    speed: float
    reach: float
    weight: Array

    def __post_init__(self) -> None:
        import cvxpy as cp

        self.n, self.d, self.T = n, d, T = len(self.least), self.statement.delay, float(self.statement.period)
        self.kp, self.kv = (np.array(row, dtype=float) for row in (self.statement.kp, self.statement.kv))
        self.mass, self.slope, self.symbols = (
            np.array(x, dtype=float) for x in (self.arm.mass, self.arm.slope, self.arm.symbols)
        )
        exact = vars(bounded_gains(self.statement, _row(self.least), _fraction(self.speed)))
        numbers: dict[str, Any] = {
            name: tuple(map(float, x)) if isinstance(x, tuple) else float(x) for name, x in exact.items()
        }
        self.gains = Gains(**numbers | {"delay": d})
        self.turning = np.array(self.arm.turning(_fraction(self.speed)), dtype=float)
        self.scale = np.sqrt(np.diag(self.mass))
        self.c, self.margin = cp.Variable(), cp.Variable()
        self.eps, self.slow, self.stiff, self.moved, self.mean = (cp.Variable(n) for _ in range(5))
        self.kept, self.late = cp.Variable((n, d + 1)), cp.Variable((n, max(d, 1)))
        self.pays: dict[str, list[Any]] = {letter: [0.0] * n for letter in "whyr"}
        self.unit = {"w": self.weight, "h": self.kp, "y": self.least / T, "r": self.weight / T**2}
        self.shares: dict[tuple[str, int, int], tuple[Any, Any, float]] = {}
        rho, rows = self.gains.rho, [(self.mass[i] * self.scale[i] / self.scale).sum() for i in range(n)]
        self.rules: list[Any] = [
            *(self.c >= LEAST_WEIGHT, self.c <= LARGEST_WEIGHT, self.margin <= 1),
            *(self.slow >= 0, self.slow <= self.eps, self.moved >= 0, self.mean >= 0),
            *(self.kept >= 0, self.late >= 0, self.stiff >= 0.5 * self.kp, self.stiff <= STIFFEST * self.kp),
            *(rho * cp.square(self.eps[i]) * rows[i] <= 0.999 * SHARE * self.stiff[i] for i in range(n)),
            *(cp.sum(self.kept[i]) <= 0.999999 * self.c * (self.reach - 1) for i in range(n)),
        ]
        for i, j in product(range(n), repeat=2):
            self._couple(i, j)

    def _couple(self, i: int, j: int) -> None:
        """What joint j does to joint i."""
        eps, c, turning, rho = self.eps[i], self.c, self.turning, self.gains.rho
        if i == j:
            self._pay("w", i, "w", i, rho * eps * self.mass[i, i], 1.0)
        else:
            self._split("mass", rho * self.mass[i, j] * eps, ("w", i), ("w", j), self.mass[i, j])
        slope = self.slope[i, j]
        self._split("gravity_w", slope, ("w", i), ("r", j), slope)
        self._split("gravity_h", slope * eps, ("h", i), ("r", j), slope)
        self._split("gravity_y", slope * c, ("y", i), ("r", j), slope)
        self._split("turning_h", turning[j, i] * self.slow[i], ("h", i), ("w", j), turning[j, i])
        self._split("turning_y", turning[i, j] * c, ("y", i), ("w", j), turning[i, j])
        self._pay("y", i, "y", j, c * turning[i, j] / 4, math.sqrt(self.least[i] / self.least[j]))
        for k in range(self.n):
            fast = self.gains.gamma * (eps - self.slow[i]) * self.symbols[j, i, k]
            self._pay("w", j, "w", k, fast, math.sqrt(self.weight[j] / self.weight[k]))

    def _pay(self, first: str, i: int, second: str, j: int, size: Any, by: float) -> None:
        self.pays[first][i] = self.pays[first][i] + size * (by / 2)
        self.pays[second][j] = self.pays[second][j] + size * (0.5 / by)

    def _split(
        self, name: str, size: Any, first: tuple[str, int], second: tuple[str, int], known: float
    ) -> None:
        """size·|x||y| ≤ a x² + b y² in their units, with 4ab ≥ size²."""
        import cvxpy as cp

        if known <= 0:
            return
        units = [self.unit[letter][k] for letter, k in (first, second)]
        a, b = cp.Variable(nonneg=True), cp.Variable(nonneg=True)
        self.rules.append(cp.SOC(a + b, cp.hstack([a - b, size / math.sqrt(units[0] * units[1])])))
        for (letter, k), part, own in zip((first, second), (a, b), units, strict=True):
            self.pays[letter][k] = self.pays[letter][k] + part * own
        self.shares[name, first[1], second[1]] = (a, b, units[0] / units[1])

    def _definite(self, i: int) -> None:
        """The form of one joint."""
        import cvxpy as cp

        d, T, u = self.d, self.T, self.least[i]
        known = [self.c, self.eps[i], self.stiff[i], self.moved[i], self.mean[i]]
        known += [*(self.kept[i, j] for j in range(d + 1)), *(self.late[i, j] for j in range(d))]
        known += [self.pays[letter][i] for letter in "whyr"]
        rate, step = 1 / math.sqrt(self.weight[i]), math.sqrt(T / u)
        size = [1 / math.sqrt(self.kp[i]), rate, step, rate, *[step] * (d + 1), *[rate] * d, step]
        gains, friction = self.gains, set(map(float, self.statement.viscous[i]))
        slopes, sectors = (gains.least_slope, gains.rho), {gains.sector[i], gains.L}
        # sums of many terms are named, since CVXPY walks through them at each use
        unknown, scale, unit = cp.Variable(len(known) + 1), np.outer(size, size), np.eye(len(size))
        self.rules.append(unknown == cp.hstack([*known, self.margin]))
        for at in product(map(float, sectors), map(float, slopes), friction):
            for constant, *parts in _controls(i, self.n, d, self.reach, self.least, gains, at, len(known)):
                rows = np.stack([*(scale * part for part in parts), -unit]).reshape(len(known) + 1, -1)
                form = scale * constant + cp.reshape(rows.T @ unknown, unit.shape, order="C")
                self.rules.append(form >> 0)

    def proof(self) -> FallingEnergy | None:
        """What the solver comes to, rounded."""
        for i in range(self.n):
            self._definite(i)
        wanted = [self.c, self.eps, self.stiff, self.moved, self.kept, self.mean, self.late, self.slow]
        found = solved(self.margin, self.rules, [self.margin, *wanted])
        if found.ended is Ended.FAILED or float(found.values[0]) <= 0:
            return None
        c, eps, stiff, moved, kept, mean, late, slow = (np.maximum(x, 0.0) for x in found.values[1:])
        portion = np.clip(slow / np.maximum(eps, TINY), 0, 1)
        ones = np.ones((self.n, self.n))
        coupled = ("mass", "gravity_w", "gravity_h", "gravity_y", "turning_h", "turning_y")
        splits = Splits(
            **{name: self._square(name, ones) for name in coupled},
            turning_yy=self._square("", np.sqrt(np.outer(self.least, 1 / self.least))),
            turning_w=self._square("", np.sqrt(np.outer(self.weight, 1 / self.weight))),
        )
        energy = SampledEnergy(
            *(_fraction(c), _fraction(self.reach), _row(eps), _row(stiff), _row(moved)),
            *(
                tuple(map(_row, kept)),
                _row(mean),
                tuple(_row(x[: self.d]) for x in late),
                _row(portion),
                splits,
            ),
        )
        return FallingEnergy(
            _row(self.least), _fraction(self.speed), _fraction(SHARE), _row(self.scale), energy
        )

    def _square(self, name: str, usual: Array) -> tuple[tuple[Fraction, ...], ...]:
        rows = usual.copy()
        for (own, i, j), (a, b, ratio) in self.shares.items():
            if own == name:
                rows[i, j] = math.sqrt(max(float(a.value), TINY) / max(float(b.value), TINY) * ratio)
        return tuple(map(_row, rows))


def _row(x: Array) -> tuple[Fraction, ...]:
    return tuple(map(_fraction, x))


def _controls(
    i: int, n: int, d: int, reach: float, least: Array, gains: Gains, at: tuple[float, ...], count: int
) -> list[list[Array]]:
    """For each coefficient of Bernstein's form its constant part and those of the unknowns.

    By the checker's own form, of which every unknown is a factor.
    """
    zero = np.zeros(n)

    def form(z: float, which: int) -> Array:
        x = np.zeros(count)
        if which >= 0:
            x[which] = 1.0
        own = [np.where(np.arange(n) == i, value, 0.0) for value in x[1:5]]
        kept, late = np.tile(x[5 : 6 + d], (n, 1)), np.tile(x[6 + d : 6 + 2 * d], (n, 1))
        V = SampledEnergy(x[0], reach, own[0], own[1], own[2], kept, own[3], late, zero, None)  # type: ignore[arg-type]
        pays = dict(zip("whyr", x[6 + 2 * d :], strict=True))
        return np.array(form_of(i, V, least[i], pays, gains, (z, *at)), dtype=float)  # type: ignore[arg-type]

    places = [k / PIECES / reach for k in range(PIECES + 1)]
    result = []
    for which in range(-1, count):
        ends = [form(z, which) for z in places]
        middles = [
            2 * form((a + b) / 2, which) - (ends[k] + ends[k + 1]) / 2
            for k, (a, b) in enumerate(pairwise(places))
        ]
        result.append(ends + middles)
    constant = result[0]
    return [[constant[k], *(part[k] - constant[k] for part in result[1:])] for k in range(len(constant))]
