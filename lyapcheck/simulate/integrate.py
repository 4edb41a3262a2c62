"""Integration of an initial value problem on a grid of times; what was reached is never lost."""

from __future__ import annotations

import warnings
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
            failure, before = None, solver.t
            with warnings.catch_warnings(record=True) as heard:  # by which LSODA says why it fails
                warnings.simplefilter("always")
                message = solver.step()
            if solver.status == "failed":
                said = "; ".join([message or "", *(str(w.message) for w in heard)]).strip("; ")
                failure = f"the integrator gave up at t = {before:.6g} s: {said or 'no reason given'}"
            elif not np.all(np.isfinite(solver.y)):
                failure = f"the state is no longer finite at t = {before:.6g} s"
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


# --- A solution at the times at which something of it is largest or smallest, between samples too.


PARTS = 4
"""Of each step of the integrator, at the ends of which extremes are looked for."""
CUTS = 8
"""Of the interval that holds an extreme, in each round; two of them hold it in the next."""
ROUNDS = 7
"""Then the interval is 4⁷ times shorter, and a smooth signal off its extreme by 4⁻¹⁴ of what it was."""
Signals = Callable[[Trajectory], Array]
"""A solution at N times to (N, k) numbers of which the extremes matter."""


def with_extremes(path: Trajectory, signals: Signals) -> Trajectory:
    """The solution at its samples, between the integrator's steps, and where a signal has a local extreme.

    Args:
        path: a solution.
        signals: smooth numbers of a state.

    Soundness: floating point; an extreme that begins and ends within a quarter of one step is not seen.
    """
    steps = path.steps
    parts = steps[:-1] + np.diff(steps) * np.linspace(0.0, 1.0, PARTS, endpoint=False)[:, None]
    t = np.unique(np.concatenate((path.t, parts.ravel(), steps)))
    slopes = np.sign(np.diff(signals(path.at(t)), axis=0))
    turns, column = np.nonzero(slopes[:-1] * slopes[1:] < 0)
    if not turns.size:
        return path.at(t)
    low, high, sign = t[turns], t[turns + 2], slopes[turns, column]
    for _ in range(ROUNDS):
        times = np.linspace(low, high, CUTS + 1)
        every, places = np.unique(times, return_inverse=True)
        values = signals(path.at(every))[places.reshape(times.shape), column] * sign
        top = np.clip(np.argmax(values, axis=0), 1, CUTS - 1)
        low, high = (np.take_along_axis(times, (top + k)[None], axis=0)[0] for k in (-1, 1))
    return path.at(np.unique(np.concatenate((t, (low + high) / 2))))


def turns(t: Array, q: Array, w: Array) -> Array:
    """(N − 1, n) where each angle turns between two samples, by the cubic of both; else its later value.

    Args:
        t: (N,) times in s.
        q: (N, n) angles in rad.
        w: (N, n) their rates in rad/s.

    Soundness: floating point; exact to the fourth order in the distance of samples.
    """
    h = np.diff(t)[:, None]
    rise, first, last = np.diff(q, axis=0), h * w[:-1], h * w[1:]
    square, middle = 3.0 * (first + last - 2.0 * rise), 3.0 * rise - 2.0 * first - last
    with np.errstate(all="ignore"):
        # the root of first + 2 middle s + square s² between 0 and 1, written so that nothing cancels
        root = np.sqrt(np.maximum(middle * middle - square * first, 0.0))
        s = first / (np.copysign(root, first) - middle)
    value = q[:-1] + s * (first + s * (middle + s * square / 3.0))
    return np.asarray(np.where((first * last < 0.0) & (s > 0.0) & (s < 1.0), value, q[1:]))


# --- CasADi functions called without the cost of its argument conversions.


class Compiled:
    """A CasADi function of vectors with one dense output, evaluated on buffers in microseconds.

    The answer is a fresh array each time, (rows, columns), or (rows,) when there is a single column.
    """

    def __init__(self, function: Any) -> None:
        self._buffer, self._evaluate = function.buffer()
        self._inputs = [np.zeros(function.nnz_in(i)) for i in range(function.n_in())]
        rows, columns = function.size_out(0)
        self._shape = (rows,) if columns == 1 else (columns, rows)
        self._output = np.zeros(rows * columns)
        for i, values in enumerate(self._inputs):
            self._buffer.set_arg(i, memoryview(values.data))
        self._buffer.set_res(0, memoryview(self._output.data))

    def __call__(self, *values: Array) -> Array:
        """The output at the given inputs, in the order of the function's arguments."""
        for held, given in zip(self._inputs, values, strict=True):
            held[:] = given
        self._evaluate()
        return self._output.reshape(self._shape).T.copy()
