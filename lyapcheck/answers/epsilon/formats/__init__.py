"""The four ε₀ in the formats that people and scripts read; one renderer a file."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from lyapcheck.admissible import EpsilonResult

FORMATS = ("text", "json", "markdown")

Renderer = Callable[["Sequence[EpsilonResult]", "Sequence[float] | None"], str]
"""Takes the results and, if they were asked for, the seconds that each took."""


def renderer(name: str) -> Renderer:
    """The function ``render`` of the format's own file."""
    render: Renderer = import_module(f"{__name__}.{name}").render
    return render
