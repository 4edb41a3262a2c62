"""Performance indices of a run: L2 norm, settling time, overshoot, peak torque, final error."""

from __future__ import annotations

import math

import numpy as np

from lyapcheck._types import Array

SETTLING_BAND = 0.02
"""Settled means within 2 % of the step; the paper prints settling times but not its band."""

LEAST_STEP = 1e-9
"""rad: a smaller initial error is no step, and nothing is measured by it."""


def l2_index(t: Array, e: Array) -> float:
    """The root-mean-square position error L2 = √((1/T) ∫₀ᵀ ‖e‖² dt) in degrees, by the trapezoidal rule.

    Args:
        t: (N,) times in s, increasing.
        e: (N, n) position errors in rad.

    References: (20) of ``reyes2019family``.
    """
    squares = np.sum(e * e, axis=1)
    return math.degrees(math.sqrt(float(np.trapezoid(squares, t)) / float(t[-1] - t[0])))


def settling_times(t: Array, e: Array, band: float = SETTLING_BAND) -> Array:
    """Per joint the time after which |e_i| stays within ``band`` times its step; NaN if that is not reached.

    The step is |e_i(0)|; a joint that starts at its goal is measured by the largest step of the others. The
    crossing between two samples is interpolated linearly.

    Args:
        t: (N,) times in s.
        e: (N, n) position errors in rad.
        band: the half-width of the band as a fraction of the step.

    Returns:
        (n,) times in s.
    """
    start = np.abs(e[0])
    width = band * np.where(start > LEAST_STEP, start, start.max())
    return np.array([_settled(t, np.abs(e[:, i]), float(width[i])) for i in range(e.shape[1])])


def _settled(t: Array, size: Array, width: float) -> float:
    outside = np.flatnonzero(size > width)
    if outside.size == 0:
        return float(t[0])
    last = int(outside[-1])
    if last == size.size - 1:
        return math.nan
    share = (size[last] - width) / (size[last] - size[last + 1])
    return float(t[last] + share * (t[last + 1] - t[last]))


def overshoots(e: Array) -> Array:
    """Per joint how far it runs past its goal, in per cent of its step |e_i(0)|; NaN without a step.

    Args:
        e: (N, n) position errors in rad.
    """
    start = e[0]
    beyond = np.maximum(np.max(-np.sign(start) * e, axis=0), 0.0)
    size = np.abs(start)
    share = np.divide(beyond, size, out=np.full_like(size, np.nan), where=size > LEAST_STEP)
    return np.asarray(100.0 * share)


def peak_torques(tau: Array) -> Array:
    """Per joint the largest |τ_i| of the samples in N·m; ``tau`` is (N, n)."""
    return np.asarray(np.max(np.abs(tau), axis=0))


def final_errors(e: Array) -> Array:
    """Per joint the position error at the end of the run in degrees; ``e`` is (N, n) in rad.

    This is what the paper calls the error in steady state; it is one only if the run has come to rest.
    """
    return np.asarray(np.degrees(e[-1]))
