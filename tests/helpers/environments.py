"""Environments in which some of the libraries are missing, as they are where nobody has installed them."""

import os
import subprocess
import sys
import venv
from pathlib import Path

ROOT = Path(__file__).parents[2]
FLINT = ("flint", "python_flint")


def _packages():
    """What is installed here."""
    places = [Path(path) for path in sys.path if path.endswith(("site-packages", "dist-packages"))]
    return [
        entry for place in places for entry in place.iterdir() if entry.suffix not in (".pth", ".egg-link")
    ]


def _is(entry, names):
    """Whether an entry of a folder of packages belongs to one of some packages."""
    start = entry.name.lower().replace("-", "_")
    return any(start == name or start.startswith((f"{name}.", f"{name}_", f"{name}-")) for name in names)


def environment(home, *, only=(), without=()):
    """The Python of a new environment with this checkout, and some of what is installed here.

    Args:
        home: a folder that is not there yet.
        only: the packages that it has; all if missing.
        without: those that it lacks.
    """
    venv.create(home, symlinks=True, with_pip=False)
    (site,) = home.glob("lib/python*/site-packages")
    for entry in _packages():
        if (
            (not only or _is(entry, (*only, "lyapcheck")))
            and not _is(entry, without)
            and not (site / entry.name).exists()
        ):
            (site / entry.name).symlink_to(entry)
    (site / "checkout.pth").write_text(f"{ROOT}\n", encoding="utf-8")
    return home / "bin" / "python"


def run(python, *words, folder):
    """``lyapcheck`` of an environment, in a folder; nothing is taken from the store."""
    variables = {key: value for key, value in os.environ.items() if not key.startswith("PYTHON")}
    variables |= {"XDG_CACHE_HOME": str(folder / ".cache")}
    command = [str(python), "-c", "from lyapcheck.cli.main import main; main()", *words]
    return subprocess.run(
        command, cwd=folder, env=variables, capture_output=True, text=True, check=False, timeout=600
    )
