"""The gate's results in the formats that people, scripts and CI systems read; one renderer a file."""

from __future__ import annotations

from importlib import import_module

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from lyapcheck.control.gate import GateResult

FORMATS = ("text", "json", "markdown", "junit", "sarif", "github")


def renderer(name: str) -> Callable[[Sequence[GateResult]], str]:
    """The function ``render`` of the format's own file."""
    render: Callable[[Sequence[GateResult]], str] = import_module(f"{__name__}.{name}").render
    return render
