"""The gate's results in the formats that people, scripts and CI systems read; one renderer a file."""

from __future__ import annotations

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from lyapcheck.gating.gate import GateResult

FORMATS = ("text", "json", "markdown", "junit", "sarif", "github")


def renderer(name: str) -> Callable[[Sequence[GateResult]], str]:
    """The function ``render`` of the format's own file."""
    # importlib, which would do the same, takes a thirtieth of the gate's time to load
    render: Callable[[Sequence[GateResult]], str] = __import__(
        f"{__name__}.{name}", fromlist=["render"]
    ).render
    return render
