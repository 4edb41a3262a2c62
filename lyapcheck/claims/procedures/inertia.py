"""How small and how large M(q), the Coriolis matrix, gravity and other polynomials of one arm are.

M ≻ 0 by its links where they are known, else by boxes of angles that are cut until each shows it; upper
bounds by the sizes of harmonics; against any of them the worst of many random postures.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
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
from lyapcheck.check.numbers.balls import to_arb
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
from lyapcheck.constants import extreme
from lyapcheck.constants.storage import storage_proof
from lyapcheck.control.judgement import proves, refutes
from lyapcheck.robots.dynamics import Chain
from lyapcheck.robots.fields import Number
from lyapcheck.robots.numeric import NumericModel
from lyapcheck.robots.plant import RobotModel
from lyapcheck.search.controlled_arm import mass_proof
from lyapcheck.search.sampled import arm_of_terms

INERTIA, GRAVITY = "inertia", "gravity"
SAMPLES = 400
MOST_BOXES_JOINTS = 4
OfArm = MassAbove | MassBelow | CoriolisBelow | GravityBelow
Place = tuple[tuple[Fraction, ...], tuple[Fraction, ...]]
"""Angles and parameters."""
Posture = tuple[float, PostureWitness]
"""What a bound is about there, and the witness with its vectors."""


@procedure(MassAbove)
def find_mass_above(statement: MassAbove) -> SearchResult:
    """The links, else a posture that refutes it, else boxes."""
    known = mass_proof(statement.mass) if statement.low == 0 and not statement.parameters else Bisection()
    quick: list[Proof] = [known] if isinstance(known, Links) else []
    return _found(statement, quick, INERTIA, "take a smaller bound, or name an arm whose links are known")


@procedure(MassBelow, CoriolisBelow, GravityBelow)
def find_upper(statement: MassBelow | CoriolisBelow | GravityBelow) -> SearchResult:
    """The sizes of harmonics, else a posture that refutes it, else boxes."""
    method = GRAVITY if isinstance(statement, GravityBelow) else INERTIA
    return _found(statement, [HarmonicSizes()], method, "take a larger bound")


def _found(statement: OfArm, quick: list[Proof], method: str, advice: str) -> SearchResult:
    """Boxes come last: where the statement is false they end only with their budget."""
    for proof in quick:
        if proves(statement, proof):
            return shown(proof, f"{method}: {proof.rule}")
    random = np.random.default_rng(SEED)
    drawn: Iterable[Place] = (_drawn(statement, random) for _ in range(SAMPLES))
    if isinstance(statement, MassAbove | MassBelow) and not statement.parameters:
        drawn = [_worst(statement, list(drawn))]
    value, against = max((_at(statement, *place, random) for place in drawn), key=lambda row: row[0])
    if refutes(statement, against):
        point = entries(q=against.q, x=against.x, y=against.y, p=against.parameters)
        if isinstance(statement, MassAbove):
            witness = failing(point, statement.low, "<", between(-Fraction(value), 6))
        else:
            witness = failing(point, between(Fraction(value), 6), "<=", statement.high)
        return broken(against, f"{method}: a posture", witness)
    few = isinstance(statement, GravityBelow) or len(statement.mass) <= MOST_BOXES_JOINTS
    if few and proves(statement, Bisection()):
        return shown(Bisection(), f"{method}: {Bisection.rule}")
    return still_open(f"it is not shown, and no posture breaks it; {advice}", method)


def _drawn(statement: OfArm, random: np.random.Generator) -> Place:
    """A random posture, at a corner of the ranges."""
    n = statement.joints if isinstance(statement, GravityBelow) else len(statement.mass)
    q = tuple(Fraction(int(k), 64) for k in random.integers(-201, 202, n))
    return q, tuple(pair[int(random.integers(2))] for pair in statement.parameters)


def _worst(statement: MassAbove | MassBelow, drawn: Sequence[Place]) -> Place:
    """The posture of the least or largest M, in floating point: balls take minutes for seven joints."""
    arm = NumericModel(arm_of_terms(statement.mass, ()))
    values = np.linalg.eigvalsh(arm.mass(np.array([q for q, _ in drawn], dtype=float)))
    return drawn[int(values[:, 0].argmin() if isinstance(statement, MassAbove) else values[:, -1].argmax())]


def _at(
    statement: OfArm, q: tuple[Fraction, ...], parameters: tuple[Fraction, ...], random: np.random.Generator
) -> Posture:
    """A posture with the vectors at which it breaks the bound most."""
    n = len(q)
    if isinstance(statement, GravityBelow):
        torques = [float(value) for value in statement.at(q, parameters)]
        return float(np.linalg.norm(torques)), PostureWitness(q, parameters, ())
    if isinstance(statement, CoriolisBelow):
        drawn = (tuple(Fraction(int(k), 8) for k in random.integers(-8, 9, n)) for _ in range(2))
        x, y = (v if any(v) else (Fraction(1),) * n for v in drawn)
        balls = [list(map(to_arb, v)) for v in (x, y)]
        turned = [float(c) for c in statement.inertia.coriolis(q, parameters, *balls)]
        size = math.hypot(*turned) / (math.hypot(*x) * math.hypot(*y))
        return size, PostureWitness(q, parameters, x, y)
    rows = [[float(c) for c in row] for row in statement.inertia.at(q, parameters)]
    values, vectors = np.linalg.eigh(np.array(rows))
    sign, place = (-1, 0) if isinstance(statement, MassAbove) else (1, -1)
    x = tuple(Fraction(float(c)).limit_denominator(10**6) for c in vectors[:, place])
    return float(sign * values[place]), PostureWitness(q, parameters, x)


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
    viscous = (Number(Fraction(0)),) * chain.n
    plant = RobotModel(name="chain", joints=joints, dynamics=chain, viscous=viscous)
    at, reached = extreme(plant, name)
    if reached > statement.high:
        witness = failing(entries(q=at.q, x=at.x), reached, "<=", statement.high)
        return broken(at, f"{LINKS}: a posture", witness)
    result = storage_proof(chain, name)
    if result is None or result.bound > statement.high:
        least = "none" if result is None else f"{float(result.bound):.6g}"
        return still_open(
            f"{float(reached):.6g} is reached, and the least bound that forms show is {least}; take a "
            "larger one",
            LINKS,
        )
    return shown(result.proof, f"{LINKS}: {result.proof.rule}")
