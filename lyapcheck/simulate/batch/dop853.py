"""The method of Dormand and Prince of order 8(5, 3) with values of order 7 between steps, as SciPy has it.

References: ``hairer1993solving``, Section II.5 and the code DOP853 of its authors.
"""

from __future__ import annotations

from collections.abc import Iterable

from scipy.integrate import DOP853

Weights = dict[int, float]
"""Weights of stages by their number; all others are zero."""


def _weights(row: Iterable[float]) -> Weights:
    return {stage: float(weight) for stage, weight in enumerate(row) if weight}


STAGES: tuple[Weights, ...] = tuple(map(_weights, DOP853.A[1:]))
"""Stage i + 1 is the rate at y + h Σ_j weight_j k_j, i = 0 … 10; k_0 is the rate at y."""

STEP: Weights = _weights(DOP853.B)
"""The step y + h Σ weight_j k_j of order 8; k_12 is the rate there, and k_0 of the next step."""

EXTRA: tuple[Weights, ...] = tuple(map(_weights, DOP853.A_EXTRA))
"""Stages 13, 14, 15, which only the values between steps need."""

ERROR_5: Weights = _weights(DOP853.E5)
"""The difference to the embedded formula of order 5, without the factor h."""

ERROR_3: Weights = _weights(DOP853.E3)
"""The difference to an embedded formula of order 3, without the factor h."""

DENSE: tuple[Weights, ...] = tuple(map(_weights, DOP853.D))
"""The upper four coefficients of the polynomial of degree 7 between steps, without the factor h."""
