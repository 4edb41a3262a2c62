"""How large the torque of gravity is: sizes of harmonics, else a posture against it, else boxes of angles."""

from __future__ import annotations

from fractions import Fraction

import numpy as np

from lyapcheck._types import SEED
from lyapcheck.check.kinds.gravity import GravityBelow
from lyapcheck.check.kinds.inertia import Bisection, HarmonicSizes, PostureWitness
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
from lyapcheck.control.judgement import proves, refutes

METHOD = "gravity"
SAMPLES = 400


@procedure(GravityBelow)
def find_gravity_below(statement: GravityBelow) -> SearchResult:
    """A bound of the sizes of harmonics, a posture that refutes it, or boxes."""
    if proves(statement, HarmonicSizes()):
        return shown(HarmonicSizes(), f"{METHOD}: {HarmonicSizes.rule}")
    worst = max((_sampled(statement, k) for k in range(SAMPLES)), key=lambda row: row[0])
    if refutes(statement, worst[1]):
        point = entries(q=worst[1].q, p=worst[1].parameters)
        witness = failing(point, between(Fraction(worst[0]), 6), "<=", statement.high)
        return broken(worst[1], f"{METHOD}: a posture", witness)
    if proves(statement, Bisection()):
        return shown(Bisection(), f"{METHOD}: {Bisection.rule}")
    return still_open("it is not shown, and no posture breaks it; take a larger bound", METHOD)


def _sampled(statement: GravityBelow, k: int) -> tuple[float, PostureWitness]:
    random = np.random.default_rng(SEED + k)
    q = tuple(Fraction(int(step), 64) for step in random.integers(-201, 202, statement.joints))
    ends = tuple(pair[int(random.integers(2))] for pair in statement.parameters)
    values = [float(value) for value in statement.at(q, ends)]
    return float(np.linalg.norm(values)), PostureWitness(q, ends, ())
