"""Integration of an initial value problem on a grid of times; what was reached is never lost."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from lyapcheck._types import Array

Field = Callable[[float, Array], Array]

MAX_STEPS = 200_000
"""Steps of one integration; the paper's runs take about 500."""


@dataclass(frozen=True, eq=False)
class Trajectory:
    """A solution at the times asked for, or as many of them as were reached."""

    t: Array
    """(N,)"""
    y: Array
    """(N, d)"""
    steps: Array
    """(S,) the start and the ends of the method's steps."""
    dense: Callable[[Array], Array]
    """The solution (d, K) at any (K,) times that were reached, by the method's own dense output."""
    failure: str | None = None
    """Why the integration stopped early; none if it reached the end."""

    def at(self, times: Array) -> Trajectory:
        """The same solution at other (K,) times that were reached."""
        return replace(self, t=times, y=self.dense(times).T)

    def until(self, end: float) -> Trajectory:
        """The same solution as far as a time that was reached, which is its last."""
        return replace(self.at(np.append(self.t[self.t < end], end)), failure="stopped")


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
        on_time: called now and then with the time reached, s.
        max_steps: a budget, after which the solution is cut short.

    Soundness: an error estimate per step is not a bound: compare with a run at a smaller tolerance.
    """
    from scipy.integrate import LSODA, OdeSolution

    steps, pieces = [float(t[0])], []
    with np.errstate(all="ignore"):
        solver = LSODA(rate, t[0], y0, t[-1], rtol=tolerance, atol=tolerance / 100, jac=jacobian)
        for count in range(max_steps):
            failure = _step(solver)
            if failure is None and solver.t > steps[-1]:
                steps.append(solver.t)
                pieces.append(solver.dense_output())
            if failure is not None or solver.status != "running":
                break
            if on_time is not None and count % 64 == 0:
                on_time(solver.t)
        else:
            failure = f"{max_steps} steps were not enough, t = {solver.t:.6g} s was reached"
    solution = OdeSolution(steps, pieces, alt_segment=True) if pieces else None

    def dense(times: Array) -> Array:
        values = np.empty((y0.size, times.size)) if solution is None else solution(times)
        values[:, times <= t[0]] = y0[:, None]  # exactly, which the polynomial of the first step is not
        return values

    reached = t[t <= steps[-1]]
    return Trajectory(reached, dense(reached).T, np.array(steps), dense, failure)


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
