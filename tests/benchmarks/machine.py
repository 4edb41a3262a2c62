"""The machine, as far as it explains the numbers."""

from __future__ import annotations

import os
import platform
from importlib.metadata import version

PACKAGES = ("lyapcheck", "numpy", "scipy", "casadi", "python-flint", "sympy", "mpmath", "cvxpy", "clarabel")


def description() -> list[str]:
    """A line a fact: the interpreter, the processors, the versions."""
    packages = ", ".join(f"{name} {version(name)}" for name in PACKAGES)
    return [
        f"{platform.python_implementation()} {platform.python_version()} on {platform.system()}, "
        f"{platform.machine()}, {os.cpu_count()} processors",
        packages,
    ]
