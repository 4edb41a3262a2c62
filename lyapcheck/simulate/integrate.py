"""Integration of an initial value problem on a grid of times; what was reached is never lost."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from lyapcheck._types import Array

Field = Callable[[float, Array], Array]

MAX_STEPS = 200_000
"""Steps of one integration; the paper's runs take about 500."""


@dataclass(frozen=True)
class Trajectory:
    """A solution at the times asked for, or as many of them as were reached."""

    t: Array
    """(N,)"""
    y: Array
    """(N, d)"""
    failure: str | None = None
    """Why the integration stopped early; none if it reached the end."""


def integrate(
    rate: Field,
    jacobian: Field,
    y0: Array,
    t: Array,
    tolerance: float | Array,
    *,
    on_time: Callable[[float], None] | None = None,
    max_steps: int = MAX_STEPS,
) -> Trajectory:
    """Solve ẏ = rate(t, y), y(t₀) = y0 at the times ``t`` with LSODA, which turns stiff (BDF) by itself.

    Args:
        rate: the right-hand side, (d,) to (d,).
        jacobian: ∂rate/∂y, (d, d).
        y0: (d,) the state at ``t[0]``.
        t: (N,) increasing times; the values between steps come from the method's own dense output.
        tolerance: relative error allowed per step, for all components or (d,) for each; the absolute one is
            a hundredth of it.
        on_time: told now and then how far the solution has come.
        max_steps: a budget, after which the solution is cut short.

    Soundness: an error estimate per step is not a bound: compare with a run at a smaller tolerance.
    """
    from scipy.integrate import LSODA

    grid = _Grid(t, y0)
    with np.errstate(all="ignore"):
        solver = LSODA(rate, t[0], y0, t[-1], rtol=tolerance, atol=tolerance / 100, jac=jacobian)
        failure = _march(solver, grid, on_time or _silent, max_steps)
    return Trajectory(t[: grid.reached], grid.y[: grid.reached], failure)


class _Grid:
    """The rows of the answer that are filled so far."""

    def __init__(self, t: Array, y0: Array) -> None:
        self.t = t
        self.y = np.empty((t.size, y0.size))
        self.y[0] = y0
        self.reached = 1

    def fill(self, until: float, dense: Callable[[Array], Array]) -> None:
        stop = int(np.searchsorted(self.t, until, side="right"))
        if stop > self.reached:
            self.y[self.reached : stop] = dense(self.t[self.reached : stop]).T
            self.reached = stop


def _march(solver: Any, grid: _Grid, on_time: Callable[[float], None], max_steps: int) -> str | None:
    for count in range(max_steps):
        if solver.status != "running":
            return None
        failure = _step(solver)
        if failure is not None:
            return failure
        grid.fill(solver.t, solver.dense_output())
        if count % 64 == 0:
            on_time(solver.t)
    return (
        None
        if solver.status == "finished"
        else f"{max_steps} steps were not enough, t = {solver.t:.6g} s was reached"
    )


def _step(solver: Any) -> str | None:
    """One step; the reason if it failed. LSODA speaks through warnings, which are turned into that reason."""
    import warnings

    before = solver.t
    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always")
        message = solver.step()
    if solver.status == "failed":
        said = "; ".join([message or "", *(str(w.message) for w in heard)]).strip("; ")
        return f"the integrator gave up at t = {before:.6g} s: {said or 'no reason given'}"
    if not np.all(np.isfinite(solver.y)):
        return f"the state is no longer finite at t = {before:.6g} s"
    return None


def _silent(time: float) -> None:
    pass
