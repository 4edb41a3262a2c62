"""The machine, as far as it explains the numbers."""

from __future__ import annotations

import os
import platform
from importlib.metadata import PackageNotFoundError, version

PACKAGES = (
    "lyapcheck",
    "numpy",
    "scipy",
    "casadi",
    "python-flint",
    "sympy",
    "mpmath",
    "cvxpy",
    "clarabel",
    "numba",
    "diffrax",
)


def description() -> list[str]:
    """A line a fact: the interpreter, the processors, the versions."""
    packages = ", ".join(filter(None, map(_package, PACKAGES)))
    return [
        f"{platform.python_implementation()} {platform.python_version()} on {platform.system()}, "
        f"{platform.machine()}, {os.cpu_count()} processors, load {os.getloadavg()[1]:.1f} when it ended",
        packages,
    ]


def _package(name: str) -> str:
    try:
        return f"{name} {version(name)}"
    except PackageNotFoundError:
        return ""
