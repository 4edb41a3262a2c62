"""Certified bounds of a motion beside what a simulation of it shows; one renderer a file."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from lyapcheck.bounds.compare import Comparison

FORMATS = ("text", "json")


def renderer(name: str) -> Callable[[Sequence[Comparison]], str]:
    """The function ``render`` of the format's own file."""
    render: Callable[[Sequence[Comparison]], str] = import_module(f"{__name__}.{name}").render
    return render
