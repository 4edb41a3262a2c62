"""The table of constants in the formats that people and scripts read; one renderer a file."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module

from lyapcheck.family.table import Table

FORMATS = ("text", "json", "csv", "markdown", "latex", "html")


def renderer(name: str) -> Callable[[Table], str]:
    """The function ``render`` of the format's own file."""
    render: Callable[[Table], str] = import_module(f"{__name__}.{name}").render
    return render
