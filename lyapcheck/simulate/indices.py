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


def settling_times(t: Array, e: Array, band: float | Array = SETTLING_BAND) -> Array:
    """Per joint the time after which |e_i| stays within ``band`` times its step; NaN if that is not reached.

    The step is |e_i(0)|; a joint that starts at its goal is measured by the largest step of the others. The
    crossing between two samples is interpolated linearly.

    Args:
        t: (N,) times in s.
        e: (…, N, n) position errors in rad.
        band: the half-width of the band as a fraction of the step; one, or (…, 1) of them.

    Returns:
        (…, n) times in s.
    """
    size, width = np.abs(e), bands(e[..., 0, :], band)
    outside = size > width[..., None, :]
    last = t.size - 1 - np.argmax(outside[..., ::-1, :], axis=-2)
    before = np.minimum(last, t.size - 2)
    a, b = (np.take_along_axis(size, (before + k)[..., None, :], axis=-2)[..., 0, :] for k in (0, 1))
    fall = np.where(a > b, a - b, 1.0)
    crossing = t[before] + (a - width) / fall * (t[before + 1] - t[before])
    settled = np.where(outside.any(axis=-2), np.where(last == t.size - 1, np.nan, crossing), t[0])
    return np.asarray(np.where(np.isnan(e[..., -1, :]), np.nan, settled))


def bands(step: Array, band: float | Array = SETTLING_BAND) -> Array:
    """The half-width of the band of each joint, rad, from the steps (…, n) in rad; see `settling_times`."""
    size = np.abs(step)
    return np.asarray(band * np.where(size > LEAST_STEP, size, np.max(size, axis=-1, keepdims=True)))


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
