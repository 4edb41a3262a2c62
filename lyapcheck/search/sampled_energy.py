"""The numbers of an energy that falls along the loop on a computer, by a convex program; only proposed.

References: ``lyapcheck.check.loop.sampled_energy``.
"""

from __future__ import annotations

import math
from fractions import Fraction
from itertools import pairwise, product
from typing import Any

import numpy as np

from lyapcheck._types import SEED, Array
from lyapcheck.check.kinds.sampled_from_rest import FallingEnergy, SampledFromRest, arm_bounds
from lyapcheck.check.loop.sampled_energy import PIECES, ArmBounds, Gains, SampledEnergy, Splits, form_of
from lyapcheck.control.judgement import proves
from lyapcheck.convex import Ended, solved
from lyapcheck.robots.numeric import NumericModel
from lyapcheck.search.sampled import corners, plant_of

SAMPLES, WORST = 3000, 40
SPARE, SHARE, SPEED = 0.98, 0.2, 1.001
REACHES = (2.0, 1.5, 3.0)
KEPT_LEAST, LARGEST_WEIGHT = 1e-4, 50.0


def falling_energy(statement: SampledFromRest) -> FallingEnergy | None:
    """A proof that the checker accepts; ``None`` where none is found.

    Soundness: ``lyapcheck.check.verify`` has accepted it.
    """
    kp, kv = (np.array(row, dtype=float) for row in (statement.kp, statement.kv))
    friction = np.array(statement.viscous, dtype=float)
    weight = kv + friction[:, 1]
    least = _least(statement, kv + 0.02 * friction[:, 1] + 1e-3 * kp)
    arm = arm_bounds(statement, tuple(map(_fraction, least)))
    angle = math.radians(float(statement.within))
    speed = SPEED * math.sqrt(2 * 1.1 * kp.sum() * math.log(math.cosh(angle)) / (1 - SHARE))
    for reach in REACHES:
        proof = _proposed(statement, arm, least, speed, reach, weight)
        if proof is not None and proves(statement, proof):
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
    scale = np.sqrt(np.diag(mass.max(axis=0)))
    some = [m / np.outer(scale, scale) for m in mass[np.argsort(sizes)[:WORST]]]
    rules = [m - cp.diag(cp.multiply(u, 1 / scale**2)) >> 0 for m in some] + [u >= 0.85 * t * wanted]
    found = solved(cp.sum(cp.log(u)), rules, [u])
    least = found.values[0] if found.values else t * wanted
    worst = (
        1 / np.linalg.eigvals(np.linalg.solve(mass, np.broadcast_to(np.diag(least), mass.shape))).real.max()
    )
    return least * min(worst, 1.0) * SPARE


def _proposed(
    statement: SampledFromRest, arm: ArmBounds, least: Array, speed: float, reach: float, weight: Array
) -> FallingEnergy | None:
    import cvxpy as cp

    n, d, T = len(least), statement.delay, float(statement.period)
    kp, kv = (np.array(row, dtype=float) for row in (statement.kp, statement.kv))
    mass, slope, symbols = (np.array(x, dtype=float) for x in (arm.mass, arm.slope, arm.symbols))
    turning = np.array(arm.turning(_fraction(speed)), dtype=float)
    fastest = speed / np.sqrt(least)
    sector = 0.999999 * np.tanh(fastest) / fastest
    gains = Gains(*(tuple(x) for x in (kp, kv)), T, d, 1.0, 1.0, 1.0, tuple(sector))  # type: ignore[arg-type]
    c, margin = cp.Variable(), cp.Variable()
    eps, slow, stiff, moved, mean = (cp.Variable(n) for _ in range(5))
    kept, late = cp.Variable((n, d + 1)), cp.Variable((n, max(d, 1)))
    pays = {letter: [0.0] * n for letter in "whyr"}
    unit = {"w": weight, "h": kp, "y": least / T, "r": weight / T**2}
    rules = [c >= KEPT_LEAST, c <= LARGEST_WEIGHT, margin <= 1, slow >= 0, slow <= eps, stiff >= 0.5 * kp]
    rules += [stiff <= 1.1 * kp, moved >= 0, mean >= 0, kept >= 0, late >= 0]
    scale = np.sqrt(np.diag(mass))
    rows = np.array([(mass[i] * scale[i] / scale).sum() for i in range(n)])
    rules += [cp.square(eps[i]) * rows[i] <= 0.999 * SHARE * stiff[i] for i in range(n)]
    rules += [cp.sum(kept[i]) <= 0.999999 * c * (reach - 1) for i in range(n)]
    shares: dict[tuple[str, int, int], tuple[Any, Any, float]] = {}

    def split(name: str, i: int, j: int, size: float, of: Any, first: str, second: str) -> None:
        """size·of·|x_i||y_j|, each side in its unit."""
        if size <= 0:
            return
        unit_i, unit_j = unit[first][i], unit[second][j]
        a, b = cp.Variable(nonneg=True), cp.Variable(nonneg=True)
        half = size / 2 / math.sqrt(unit_i * unit_j)
        rules.append(cp.SOC(a + b, cp.hstack([a - b, 2 * half * of])))
        pays[first][i] = pays[first][i] + a * unit_i
        pays[second][j] = pays[second][j] + b * unit_j
        shares[name, i, j] = (a, b, unit_i / unit_j)

    for i, j in product(range(n), repeat=2):
        if i == j:
            pays["w"][i] = pays["w"][i] + eps[i] * mass[i, i]
        else:
            split("mass", i, j, mass[i, j], eps[i], "w", "w")
        split("gravity_w", i, j, slope[i, j], 1.0, "w", "r")
        split("gravity_h", i, j, slope[i, j], eps[i], "h", "r")
        split("gravity_y", i, j, slope[i, j], c, "y", "r")
        split("turning_h", i, j, turning[j, i], slow[i], "h", "w")
        split("turning_y", i, j, turning[i, j], c, "y", "w")
        even = math.sqrt(least[i] / least[j])
        pays["y"][i] = pays["y"][i] + c * turning[i, j] / 8 * even
        pays["y"][j] = pays["y"][j] + c * turning[i, j] / 8 / even
        for k in range(n):
            even = math.sqrt(weight[j] / weight[k])
            fast = (eps[i] - slow[i]) * symbols[j, i, k] / 2
            pays["w"][j] = pays["w"][j] + fast * even
            pays["w"][k] = pays["w"][k] + fast / even
    for i in range(n):
        known = [c, eps[i], stiff[i], moved[i], mean[i], *(kept[i, j] for j in range(d + 1))]
        known += [*(late[i, j] for j in range(d)), *(pays[letter][i] for letter in "whyr")]
        size = [
            1 / math.sqrt(kp[i]),
            1 / math.sqrt(weight[i]),
            math.sqrt(T / least[i]),
            1 / math.sqrt(weight[i]),
        ]
        size += (
            [math.sqrt(T / least[i])] * (d + 1) + [1 / math.sqrt(weight[i])] * d + [math.sqrt(T / least[i])]
        )
        for at in product({sector[i], 1.0}, (0.0, 1.0), set(map(float, statement.viscous[i]))):
            for parts in _controls(i, n, d, reach, least, gains, at, len(known)):
                scaled = [np.outer(size, size) * part for part in parts]
                form = scaled[0] + sum(
                    x * part for x, part in zip(known, scaled[1:], strict=True) if part.any()
                )
                rules.append(form - margin * np.eye(len(size)) >> 0)
    found = solved(margin, rules, [c, eps, slow, stiff, moved, mean, kept, late])
    if found.ended is Ended.FAILED or float(margin.value) <= 0:
        return None
    values = [np.maximum(value, 0.0) for value in found.values]

    def row(x: Array) -> tuple[Fraction, ...]:
        return tuple(map(_fraction, x))

    def square(name: str, usual: Array) -> tuple[tuple[Fraction, ...], ...]:
        rows = usual.copy()
        for (own, i, j), (a, b, ratio) in shares.items():
            if own == name:
                rows[i, j] = math.sqrt(max(float(a.value), 1e-9) / max(float(b.value), 1e-9) * ratio)
        return tuple(map(row, rows))

    ones = np.ones((n, n))
    splits = Splits(
        *(
            square(name, ones)
            for name in ("mass", "gravity_w", "gravity_h", "gravity_y", "turning_h", "turning_y")
        ),
        square("", np.sqrt(np.outer(least, 1 / least))),
        square("", np.sqrt(np.outer(weight, 1 / weight))),
    )
    weight_, eps_, slow_, stiff_, moved_, mean_, kept_, late_ = values
    portion = np.clip(slow_ / np.maximum(eps_, 1e-12), 0, 1)
    energy = SampledEnergy(
        _fraction(weight_), _fraction(reach), row(eps_), row(stiff_), row(moved_),
        tuple(map(row, kept_)), row(mean_), tuple(row(x[:d]) for x in late_), row(portion), splits,
    )  # fmt: skip
    return FallingEnergy(row(least), _fraction(speed), _fraction(SHARE), row(scale), energy)


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
