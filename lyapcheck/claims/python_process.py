"""Fresh Python processes that import the lyapcheck that runs here, and nothing from the working directory."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import lyapcheck


def command(module: str, *arguments: str) -> list[str]:
    """The words that run a module; ``-P`` because a script may have written modules where it was started."""
    return [sys.executable, "-P", "-m", module, *arguments]


def environment() -> dict[str, str]:
    """The variables of this process, with the folder that this lyapcheck was imported from."""
    folder = str(Path(lyapcheck.__file__).resolve().parents[1])
    given = [os.path.abspath(path) for path in os.environ.get("PYTHONPATH", "").split(os.pathsep) if path]
    return os.environ | {"PYTHONPATH": os.pathsep.join([*given, folder])}
