"""How small and how large M(q), the Coriolis matrix and gravity of one arm are.

M ≻ 0 by its links where they are known, else by boxes of angles that are cut until each shows it; upper
bounds by the sizes of harmonics; against any of them the worst of many random postures.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from fractions import Fraction

import numpy as np

from lyapcheck._types import SEED
from lyapcheck.check.kinds.chain import ChainBelow, ChainCoriolisBelow, ChainGravityBelow
from lyapcheck.check.kinds.coriolis import CoriolisBelow
from lyapcheck.check.kinds.gravity import GravityBelow
from lyapcheck.check.kinds.inertia import (
    Bisection,
    HarmonicSizes,
    Links,
    MassAbove,
    MassBelow,
    PostureWitness,
)
from lyapcheck.check.loop.inertia import Inertia
from lyapcheck.check.statement import Proof
from lyapcheck.claims.search_result import (
    SearchResult,
    between,
    broken,
    entries,
    failing,
    procedure,
    shown,
    still_open,
)
from lyapcheck.constants.arm import extreme
from lyapcheck.constants.storage import storage_proof
from lyapcheck.control.judgement import proves, refutes
from lyapcheck.robots.dynamics import Chain
from lyapcheck.robots.fields import Number
from lyapcheck.robots.plant import RobotModel
from lyapcheck.search.controlled_arm import mass_proof

METHOD = "inertia"
SAMPLES = 400
MOST_BOXES_JOINTS = 4
OfArm = MassAbove | MassBelow | CoriolisBelow


@procedure(MassAbove)
def find_mass_above(statement: MassAbove) -> SearchResult:
    """The links, else a posture that refutes it, else boxes."""
    known = mass_proof(statement.mass) if statement.low == 0 and not statement.parameters else Bisection()
    quick: list[Proof] = [known] if isinstance(known, Links) else []
    advice = "take a smaller bound, or name an arm whose links are known"
    return _found(statement, quick, advice)


@procedure(MassBelow, CoriolisBelow)
def find_upper(statement: MassBelow | CoriolisBelow) -> SearchResult:
    """The sizes of harmonics, else a posture that refutes it, else boxes."""
    return _found(statement, [HarmonicSizes()], "take a larger bound")


def _found(statement: OfArm, quick: list[Proof], advice: str) -> SearchResult:
    """Boxes come last: where the statement is false they end only with their budget."""
    for proof in quick:
        if proves(statement, proof):
            return shown(proof, f"{METHOD}: {proof.rule}")
    for against in _postures(statement):
        if refutes(statement, against):
            return broken(against, f"{METHOD}: a posture", _witness(statement, against))
    if len(statement.mass) <= MOST_BOXES_JOINTS and proves(statement, Bisection()):
        return shown(Bisection(), f"{METHOD}: {Bisection.rule}")
    return still_open(f"it is not shown, and no posture breaks it; {advice}", METHOD)


def _postures(statement: OfArm) -> Iterator[PostureWitness]:
    """The worst of many random postures, in double precision."""
    random, inertia, n = np.random.default_rng(SEED), statement.inertia, len(statement.mass)
    worst: tuple[float, PostureWitness] | None = None
    for _ in range(SAMPLES):
        q = tuple(Fraction(int(k), 64) for k in random.integers(-201, 202, n))
        shares = [Fraction(int(k), 8) for k in random.integers(0, 9, len(statement.parameters))]
        parameters = tuple(
            low + (high - low) * share
            for (low, high), share in zip(statement.parameters, shares, strict=True)
        )
        value, proof = _at(statement, inertia, q, parameters, random)
        if worst is None or value > worst[0]:
            worst = value, proof
    if worst is not None:
        yield worst[1]


def _at(
    statement: OfArm,
    inertia: Inertia,
    q: tuple[Fraction, ...],
    parameters: tuple[Fraction, ...],
    random: np.random.Generator,
) -> tuple[float, PostureWitness]:
    """How far a posture breaks the bound, and the witness with its worst vectors."""
    n = inertia.n
    if isinstance(statement, CoriolisBelow):
        x, y = (tuple(Fraction(int(k), 8) for k in random.integers(-8, 9, n)) or None for _ in range(2))
        x, y = (v if v is not None and any(v) else (Fraction(1),) * n for v in (x, y))
        turned = np.array([float(c) for c in inertia.coriolis(q, parameters, _balls(x), _balls(y))])
        size = float(np.linalg.norm(turned)) / (_norm(x) * _norm(y))
        return size - float(statement.high), PostureWitness(q, parameters, x, y)
    rows = np.array([[float(c) for c in row] for row in inertia.at(q, parameters)])
    values, vectors = np.linalg.eigh(rows)
    low = isinstance(statement, MassAbove)
    x = tuple(Fraction(float(c)).limit_denominator(10**6) for c in vectors[:, 0 if low else -1])
    gap = (
        float(statement.low) - values[0]
        if isinstance(statement, MassAbove)
        else values[-1] - float(statement.high)
    )
    return float(gap), PostureWitness(q, parameters, x)


def _balls(x: tuple[Fraction, ...]) -> list[object]:
    from lyapcheck.check.numbers.balls import to_arb

    return [to_arb(value) for value in x]


def _norm(x: tuple[Fraction, ...]) -> float:
    return math.sqrt(sum(value * value for value in x))


def _witness(statement: OfArm, proof: PostureWitness) -> dict[str, object]:
    point = entries(q=proof.q, x=proof.x, y=proof.y, p=proof.parameters)
    value, _ = _at(statement, statement.inertia, proof.q, proof.parameters, np.random.default_rng(SEED))
    if isinstance(statement, MassAbove):
        return failing(point, statement.low, "<", between(statement.low - Fraction(value), 6))
    return failing(point, between(Fraction(value) + statement.high, 6), "<=", statement.high)


# --- How large the torque of gravity is: sizes of harmonics, else a posture against it, else boxes of angles.


GRAVITY = "gravity"


@procedure(GravityBelow)
def find_gravity_below(statement: GravityBelow) -> SearchResult:
    """A bound of the sizes of harmonics, a posture that refutes it, or boxes."""
    if proves(statement, HarmonicSizes()):
        return shown(HarmonicSizes(), f"{GRAVITY}: {HarmonicSizes.rule}")
    worst = max((_sampled(statement, k) for k in range(SAMPLES)), key=lambda row: row[0])
    if refutes(statement, worst[1]):
        point = entries(q=worst[1].q, p=worst[1].parameters)
        witness = failing(point, between(Fraction(worst[0]), 6), "<=", statement.high)
        return broken(worst[1], f"{GRAVITY}: a posture", witness)
    if proves(statement, Bisection()):
        return shown(Bisection(), f"{GRAVITY}: {Bisection.rule}")
    return still_open("it is not shown, and no posture breaks it; take a larger bound", GRAVITY)


def _sampled(statement: GravityBelow, k: int) -> tuple[float, PostureWitness]:
    random = np.random.default_rng(SEED + k)
    q = tuple(Fraction(int(step), 64) for step in random.integers(-201, 202, statement.joints))
    ends = tuple(pair[int(random.integers(2))] for pair in statement.parameters)
    values = [float(value) for value in statement.at(q, ends)]
    return float(np.linalg.norm(values)), PostureWitness(q, ends, ())


# --- Bounds along a chain of links: forms that show them, else the posture at which the bound fails.

LINKS = "links"


@procedure(ChainBelow, ChainGravityBelow, ChainCoriolisBelow)
def find_chain_bound(statement: ChainBelow | ChainGravityBelow | ChainCoriolisBelow) -> SearchResult:
    """The posture at which local searches end, where it breaks the bound; else forms that show it."""
    chain, name = Chain(statement.links, (Fraction(0),) * 3), "lambda_max"
    if isinstance(statement, ChainCoriolisBelow):
        name = "k_c"
    elif isinstance(statement, ChainGravityBelow):
        chain, name = Chain(statement.links, statement.fall), "k_g"
        if len(statement.joints) < len(statement.links):
            if len(statement.joints) > 1:
                return still_open("bounds are looked for of one torque or of all", LINKS)
            name = f"k_g{statement.joints[0]}"
    joints = tuple(f"joint {i + 1}" for i in range(chain.n))
    reached = extreme(
        RobotModel(name="chain", joints=joints, dynamics=chain, viscous=(Number(Fraction(0)),) * chain.n),
        name,
    )
    if reached.value > statement.high:
        witness = failing(entries(q=reached.q, x=reached.x), reached.value, "<=", statement.high)
        return broken(PostureWitness(reached.q, (), reached.x), f"{LINKS}: a posture", witness)
    result = storage_proof(chain, name)
    if result is None or result.bound > statement.high:
        least = "none" if result is None else f"{float(result.bound):.6g}"
        return still_open(
            f"{float(reached.value):.6g} is reached, and the least bound that forms show is {least}; take a "
            "larger one",
            LINKS,
        )
    return shown(result.proof, f"{LINKS}: {result.proof.rule}")
