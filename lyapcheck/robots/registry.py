"""Finding an arm by the name of a built-in one or by the path of a file."""

from __future__ import annotations

import json
import os
import re
from fractions import Fraction
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

from lyapcheck.errors import argument_error, nearest
from lyapcheck.extensions import folders
from lyapcheck.files.decimals import decimal_text
from lyapcheck.files.toml import open_document
from lyapcheck.robots.armfile import EXACT, read_arm, with_ranges
from lyapcheck.robots.plant import RobotModel
from lyapcheck.robots.vary import Vary, require_known

if TYPE_CHECKING:
    from lyapcheck.robots.fields import Number

OWN = Path(__file__).parent / "arms"
"""The arms of lyapcheck itself."""


def names() -> tuple[str, ...]:
    """The built-in arms, sorted: one for each file in ``arms/``, here or in a folder of the user's own."""
    return tuple(sorted(_arms()))


def arm_of(model: RobotModel | str | Path) -> RobotModel:
    """An arm as it is, or the one of that name or file, as `load` finds it."""
    return model if isinstance(model, RobotModel) else load(model)


def load(
    name_or_path: str | Path,
    tip: str | None = None,
    spread: Fraction = EXACT,
    vary: tuple[Vary, ...] = (),
) -> RobotModel:
    """The built-in arm of that name, or the arm in that ``.toml`` or ``.urdf`` file.

    Args:
        name_or_path: the arm.
        tip: for a URDF file, the link that ends the chain; by default that of the most joints.
        spread: numbers of an arm file that have no range of their own get value·(1 ± spread), 0 ≤ spread < 1;
            of a URDF file masses and friction.
        vary: ranges of some numbers, in place of those of the file.

    Raises:
        InputError: no such arm or file, or the file does not describe an arm (all problems at once).
    """
    if tip is not None and not str(name_or_path).lower().endswith(".urdf"):
        raise argument_error("tip", tip, f"{name_or_path} is no URDF file", "leave it out")
    result = _loaded(name_or_path, tip, spread, vary)
    require_known(result, vary)
    return result


def arm_file(name_or_path: str | Path) -> Path:
    """The file of an arm: that of a built-in one or of an example, or the path itself."""
    known = _arms() | _examples()
    return known.get(str(name_or_path), known.get(str(name_or_path).lower(), Path(name_or_path)))


def _loaded(
    name_or_path: str | Path, tip: str | None, spread: Fraction, vary: tuple[Vary, ...]
) -> RobotModel:
    if str(name_or_path) in names():
        return _builtin(str(name_or_path), spread, vary)
    path = arm_file(name_or_path)
    if path.suffix.lower() == ".urdf":
        from lyapcheck.robots.urdf import read_urdf

        return with_ranges(read_urdf(path, tip=tip), spread, vary)
    if not path.suffix and not path.exists():
        raise argument_error(
            "robot", name_or_path, "is neither a built-in arm nor a file", _advice(str(name_or_path))
        )
    return read_arm(path, spread=spread, vary=vary)


def _advice(name: str) -> str:
    known = f"built-in arms: {', '.join(names())}; examples: {', '.join(sorted(_examples()))}"
    guess = nearest(name, [*names(), *_examples()])
    return f"{guess} {known}; or give the path of an arm file (.toml, .urdf)".lstrip()


@lru_cache(maxsize=64)
def _builtin(name: str, spread: Fraction, vary: tuple[Vary, ...]) -> RobotModel:
    path = _arms()[name]
    own = path.parent == OWN and not spread and not vary  # tests/robots look at those
    return read_arm(path, f"{name}.toml", spread, vary, tested=own)


def _examples() -> dict[str, Path]:
    """Arm files of the examples by name, which travel with lyapcheck."""
    package = Path(__file__).parents[1]
    inside = package / "examples"
    folder = inside if inside.is_dir() else package.parent / "examples"
    return {file.stem: file for file in folder.glob("*.toml") if not file.stem.endswith(("_gains", "_plan"))}


def _arms() -> dict[str, Path]:
    """The files of the arms by name; lyapcheck's own before others of that name."""
    places = (*map(Path, folders("lyapcheck.robots.arms")), OWN)
    files = [file for place in places for file in place.glob("*.toml")]
    return {file.stem: file for file in files}


# --- An arm as a file that can be edited.


_URDF = re.compile(r'^(urdf\s*=\s*")([^"]*)(")', re.MULTILINE)


def arm_text(name_or_path: str, folder: Path, tip: str | None = None) -> str:
    """The arm file of an arm as it would stand in a folder.

    Args:
        name_or_path: a built-in arm or an arm file, whose text is kept; or a URDF file, which the new file
            names, with what it says of friction and limits.
        folder: where the file will stand.
        tip: for a URDF file, the link that ends the chain; by default that of the most joints.

    Raises:
        InputError: no such arm, or a file that describes none.
    """
    model = load(name_or_path, tip)
    path = arm_file(name_or_path)
    if path.suffix.lower() == ".urdf":
        return _overlay(model, path, folder, tip)
    text = open_document(path).text

    def beside(result: re.Match[str]) -> str:
        return f"{result[1]}{_from(path.parent / result[2], folder)}{result[3]}"

    return _URDF.sub(beside, text)


def _overlay(model: RobotModel, path: Path, folder: Path, tip: str | None) -> str:
    lines = [f'title = "{model.title}"', f'urdf = "{_from(path, folder)}"']
    if tip is not None:
        lines.append(f"tip = {json.dumps(tip, ensure_ascii=False)}  # the link that ends the chain")
    for i, joint in enumerate(model.joints):
        lines += ["", "[[joints]]", f'name = "{joint}"']
        for key in ("viscous", "coulomb", "torque_limit"):
            number: Number | None = getattr(model, key)[i]
            known = number is not None and number.value > 0
            value = decimal_text(number.value) if number is not None and known else "…"
            unit = "N·m·s/rad" if key == "viscous" else "N·m"
            lines.append(f"{'' if known else '# '}{key} = {value}  # {unit}")
    return "\n".join(lines) + "\n"


def _from(file: Path, folder: Path) -> str:
    return Path(os.path.relpath(file, folder)).as_posix()
