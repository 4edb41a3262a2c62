"""Finding an arm by the name of a built-in one or by the path of a file."""

from __future__ import annotations

from difflib import get_close_matches
from functools import lru_cache
from importlib import resources
from pathlib import Path

from lyapcheck.errors import argument_error
from lyapcheck.robots.armfile import read_arm
from lyapcheck.robots.model import RobotModel


def names() -> tuple[str, ...]:
    """The built-in arms, sorted: one for each file in ``arms/``."""
    return tuple(sorted(path.stem for path in _arms().iterdir() if path.suffix == ".toml"))


def load(name_or_path: str | Path) -> RobotModel:
    """The built-in arm of that name, or the arm in that ``.toml`` file.

    Raises:
        InputError: no such arm or file, or the file does not describe an arm (all problems at once).
    """
    if str(name_or_path) in names():
        return _builtin(str(name_or_path))
    path = Path(name_or_path)
    if not path.suffix and not path.exists():
        raise argument_error(
            "robot", name_or_path, "is neither a built-in arm nor a file", _advice(str(name_or_path))
        )
    return read_arm(path)


def _advice(name: str) -> str:
    near = get_close_matches(name, names(), n=1)
    guess = f"did you mean {near[0]}? " if near else ""
    return f"{guess}built-in arms: {', '.join(names())}; or give the path of an arm file (.toml)"


@lru_cache(maxsize=64)
def _builtin(name: str) -> RobotModel:
    return read_arm(_arms() / f"{name}.toml", f"{name}.toml")


def _arms() -> Path:
    return Path(str(resources.files("lyapcheck.robots"))) / "arms"
