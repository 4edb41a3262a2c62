"""What a tracking run is asked to do, once all of it is known to be possible."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from lyapcheck.errors import InputError, Problem
from lyapcheck.simulate.task import FASTEST, task_for
from lyapcheck.tracking.reference import Reference
from lyapcheck.tracking.reference.base import SECONDS

POINTS = 2001
"""Samples of a run."""

BAND = math.radians(1.0)
"""rad: close enough to the reference."""


@dataclass(frozen=True)
class TrackingRequest:
    """Start, duration and samples of a run."""

    q0: tuple[float, ...]
    """rad"""
    velocity: tuple[float, ...]
    """q̇(0), rad/s"""
    T: float
    eps0: float | None
    band: float
    """rad"""
    points: int


def request_for(
    n: int,
    reference: Reference | None,
    q0: Sequence[float] | None,
    velocity: Sequence[float] | None,
    T: float | None,
    *,
    eps0: float | None,
    band: float = BAND,
    points: int = POINTS,
) -> TrackingRequest:
    """The request to an arm of ``n`` joints.

    Without a reference, because it could not be read, the rest is looked at all the same.

    Raises:
        InputError: all that is wrong with it at once.
    """
    problems: list[Problem] = []
    natural = SECONDS if reference is None else reference.duration
    seconds = natural if T is None else T
    zeros = (0.0,) * n
    try:
        task = task_for(n, zeros, q0, velocity, seconds, eps0=eps0, points=points)
    except InputError as error:
        problems += error.problems
    if not 0.0 < band <= math.pi:
        problems.append(_problem("band", f"{math.degrees(band):g}", "must be more than 0 and at most 180°"))
    if reference is not None:
        problems += _reference_problems(n, reference, seconds)
    if problems:
        raise InputError(problems)
    return TrackingRequest(task.q0, task.w0, task.T, eps0, band, points)


def _reference_problems(n: int, reference: Reference, T: float) -> list[Problem]:
    result = []
    if reference.n != n:
        result.append(
            _problem("reference", reference.kind, f"moves {reference.n} joints, but the arm has {n}")
        )
    if reference.span is not None and reference.span < T:
        rule = f"is longer than the recording, which ends at {reference.span:.6g} s"
        result.append(_problem("T", f"{T:g}", rule))
    if reference.suprema().speed > FASTEST:
        speed = float(reference.suprema().speed)
        result.append(
            _problem("reference", reference.kind, f"moves at {speed:.3g} rad/s, more than {FASTEST:g} rad/s")
        )
    return result


def _problem(key: str, value: str, rule: str) -> Problem:
    return Problem("argument", None, key, value, rule, _REPAIRS[key])


_REPAIRS = {
    "band": "give degrees, for instance 1",
    "reference": "write another reference file",
    "T": "give a shorter time",
}
