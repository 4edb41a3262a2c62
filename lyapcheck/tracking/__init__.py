"""The tracking scheme (21): reference trajectories, simulation, and what theory promises of it."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from lyapcheck.tracking.reference import Reference, read_reference
    from lyapcheck.tracking.request import Request
    from lyapcheck.tracking.run import TrackingFailed, TrackingRun
    from lyapcheck.tracking.simulation import track, track_as_asked

_HOME = {
    "Reference": "reference",
    "Request": "request",
    "TrackingFailed": "run",
    "TrackingRun": "run",
    "read_reference": "reference",
    "track": "simulation",
    "track_as_asked": "simulation",
}

__all__ = [
    "Reference",
    "Request",
    "TrackingFailed",
    "TrackingRun",
    "read_reference",
    "track",
    "track_as_asked",
]


def __getattr__(name: str) -> Any:
    """Import a public name when it is first asked for: a help page needs no NumPy."""
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOME[name]}"), name)
