"""Tuned gains in the formats that people, scripts and the gate read; one renderer a file."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module

from lyapcheck.tune.results import Tuning

FORMATS = ("text", "json", "markdown", "toml", "html")


def renderer(name: str) -> Callable[[Tuning], str]:
    """The function ``render`` of the format's own file."""
    render: Callable[[Tuning], str] = import_module(f"{__name__}.{name}").render
    return render
