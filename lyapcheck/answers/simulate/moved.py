"""The loop behind all simulations: each gain set moves the arm, and the arm at other values."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from lyapcheck._types import Progress, silent
from lyapcheck.answers.simulate import Unfinished
from lyapcheck.check.numbers.polynomials import Enclosure
from lyapcheck.simulate.many import Sweep
from lyapcheck.simulate.run import PromiseBroken, SimulationFailed

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots import RobotModel

MAX_BOXES = 100_000
"""Budget of branch and bound for one gain set; ``lyapcheck epsilon`` goes further."""


def on_arms(
    gains: Iterable[GainSet], model: RobotModel, others: Iterable[tuple[str, RobotModel]] = ()
) -> list[tuple[GainSet, RobotModel]]:
    """Each gain set on the arm, then on the arm at other values, which its name then says."""
    named = [("", model), *((f": {what}" if what else "", arm) for what, arm in others)]
    return [(replace(one, name=one.name + what), arm) for one in gains for what, arm in named]


def moved(
    cases: Sequence[tuple[GainSet, RobotModel]],
    move: Callable[..., Any],
    eps0: float | None = None,
    certified_on: RobotModel | None = None,
    on_progress: Progress = silent,
) -> tuple[list[Any], list[Unfinished]]:
    """What came of each case, a run that was cut short as far as it came, and what was not finished.

    Args:
        cases: gain sets on arms.
        move: simulates a gain set on an arm with ``eps0`` and ``on_progress``.
        eps0: with which V is watched.
        certified_on: the arm for which the ε₀ of each gain set is certified first, instead of ``eps0``.
        on_progress: receives the share of all cases that is done.
    """
    results, unfinished = [], []
    for done, (gains, arm) in enumerate(cases):

        def told(fraction: float, note: str, done: int = done, name: str = gains.name) -> None:
            on_progress((done + fraction) / len(cases), note or name)

        if certified_on is not None:
            from lyapcheck.answers.epsilon.compute import epsilon

            told(0.0, f"{gains.name}: what ε₀ is certified")
            found = epsilon(gains, certified_on, max_boxes=MAX_BOXES, weights=False).certified
            eps0 = 0.0 if found is None else Enclosure(found, found).float_lower
            if found is None:
                lack = f"{gains.name} on {certified_on.name}: no ε₀ is certified, V is watched with ε₀ = 0"
                unfinished.append(Unfinished(gains.name, lack))
        try:
            results.append(move(gains, arm, eps0=eps0, on_progress=told))
            if isinstance(results[-1], Sweep) and (left := results[-1].starts.count - results[-1].finished):
                lack = f"{gains.name} on {arm.name}: {left} of {results[-1].starts.count} runs"
                unfinished.append(Unfinished(gains.name, lack))
        except SimulationFailed as failure:
            results.append(failure.partial)
            if not isinstance(failure, PromiseBroken):
                unfinished.append(Unfinished(gains.name, failure.reason))
    return results, unfinished
