"""The report of an arm for people and for scripts; one renderer a file."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module

from lyapcheck.robot_report.build import RobotReport

FORMATS = ("text", "json", "markdown")


def renderer(name: str) -> Callable[[RobotReport], str]:
    """The function ``render`` of the format's own file."""
    render: Callable[[RobotReport], str] = import_module(f"{__name__}.{name}").render
    return render
