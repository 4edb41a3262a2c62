"""The closed loop in motion: the reference simulation of (11), the bench experiment, performance indices."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from lyapcheck.simulate.batch import simulate_many
    from lyapcheck.simulate.batch_runs import Runs
    from lyapcheck.simulate.bench import Bench
    from lyapcheck.simulate.closed_loop import simulate
    from lyapcheck.simulate.printed import Printed, printed_for
    from lyapcheck.simulate.run import Indices, PromiseBroken, Promises, Run, SimulationFailed
    from lyapcheck.simulate.task import PAPER_TASK, Task
    from lyapcheck.simulate.trial import experiment

_HOME = {
    "PAPER_TASK": "task",
    "Bench": "bench",
    "Indices": "run",
    "Printed": "printed",
    "PromiseBroken": "run",
    "Promises": "run",
    "Run": "run",
    "Runs": "batch_runs",
    "SimulationFailed": "run",
    "Task": "task",
    "experiment": "trial",
    "printed_for": "printed",
    "simulate": "closed_loop",
    "simulate_many": "batch",
}

__all__ = [
    "PAPER_TASK",
    "Bench",
    "Indices",
    "Printed",
    "PromiseBroken",
    "Promises",
    "Run",
    "Runs",
    "SimulationFailed",
    "Task",
    "experiment",
    "printed_for",
    "simulate",
    "simulate_many",
]


def __getattr__(name: str) -> Any:
    """Import a public name when it is first asked for: a help page needs no NumPy."""
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOME[name]}"), name)
