"""Robot models: exact trigonometric polynomials with the provenance of every number.

Adding an arm is adding one file to ``arms/``; see `lyapcheck.robots.armfile` for its form. Indices of
joints count from 0 in Python and from 1 in names (s1, M11), q is in rad, and angles are measured as the
arm file says, from the downward vertical in the built-in arms.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable
from dataclasses import replace
from fractions import Fraction
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

from lyapcheck.errors import argument_error, nearest
from lyapcheck.extensions import folders, shipped
from lyapcheck.files.decimals import decimal_text
from lyapcheck.files.toml import open_document
from lyapcheck.robots.armfile import EXACT, read_arm, with_ranges
from lyapcheck.robots.choice import Choice, split
from lyapcheck.robots.fields import Number, Vary
from lyapcheck.robots.plant import RobotModel
from lyapcheck.robots.vary import require_known

if TYPE_CHECKING:
    from lyapcheck.robots.fields import Number


ArmLike = RobotModel | str | Path
"""An arm, its name or the path of its file."""
OWN = Path(__file__).parent / "arms"
"""The arms of lyapcheck itself."""


def names() -> tuple[str, ...]:
    """List the names of the built-in arms, sorted, with arms in folders of the user."""
    return tuple(sorted(_arms()))


def arm_of(model: ArmLike) -> RobotModel:
    """An arm as it is, or the one of that name or file, as `load` finds it."""
    return model if isinstance(model, RobotModel) else load(model)


def load(
    name_or_path: str | Path,
    tip: str | None = None,
    spread: Fraction = EXACT,
    vary: Iterable[Vary | str] = (),
) -> RobotModel:
    """Load a built-in arm by name, or an arm file.

    Args:
        name_or_path: the arm. A robot file can have a choice of joints, as in ``arm.urdf#tip=hand``. See
            `lyapcheck.robots.choice`.
        tip: the last link of the arm. Default: the longest run of revolute joints.
        spread: gives numbers without a range the range value·(1 ± spread), 0 ≤ spread < 1. In a URDF file
            these are masses and friction.
        vary: ranges of some numbers, such as ``"payload=0..3"``, which replace the ranges in the file.

    Raises:
        InputError: no such arm or file, or the file does not describe an arm (all problems at once).
    """
    name, own = split(str(name_or_path))
    path, choice = arm_file(name), Choice(tip=tip or "").over(own)
    texts = [vary] if isinstance(vary, str) else vary
    varies = tuple(one if isinstance(one, Vary) else Vary.parsed(one) for one in texts)
    if name in names():
        if choice:
            rule = f"{name} is built in, and has no links to choose from"
            raise argument_error("robot", choice.of(name), rule, "leave base, tip, fixed and xacro out")
        result = _builtin(name, spread, varies)
    elif path.suffix.lower() == ".toml" or path.is_dir():
        result = read_arm(path, spread=spread, vary=varies, choice=choice)
    elif path.suffix or path.exists():
        from lyapcheck.robots.formats import read_robot

        result = with_ranges(read_robot(path, str(path), choice), spread, varies)
    else:
        known = f"built-in arms: {', '.join(names())}; examples: {', '.join(sorted(_examples()))}"
        guess = nearest(name, [*names(), *_examples()])
        repair = f"{guess} {known}; or give the path of an arm file (.toml, .urdf, .xacro, MJCF)".lstrip()
        raise argument_error("robot", name, "is neither a built-in arm nor a file", repair)
    require_known(result, varies)
    return result if result.source else replace(result, source=str(name_or_path), varies=varies)


def arm_file(name_or_path: str | Path) -> Path:
    """The file of an arm: that of a built-in one or of an example, or the path itself."""
    known, name = _arms() | _examples(), split(str(name_or_path))[0]
    return known.get(name, known.get(name.lower(), Path(name)))


@lru_cache(maxsize=64)
def _builtin(name: str, spread: Fraction, vary: tuple[Vary, ...]) -> RobotModel:
    path = _arms()[name]
    own = path.parent == OWN and not spread and not vary  # tests/robots look at those
    return replace(read_arm(path, f"{name}.toml", spread, vary, tested=own), source=name, varies=vary)


def _examples() -> dict[str, Path]:
    """Arm files of the examples by name, which travel with lyapcheck."""
    files = shipped("examples").glob("*.toml")
    return {file.stem: file for file in files if not file.stem.endswith(("_gains", "_plan"))}


def _arms() -> dict[str, Path]:
    """The files of the arms by name; lyapcheck's own before others of that name."""
    places = (*map(Path, folders("lyapcheck.robots.arms")), OWN)
    files = [file for place in places for file in place.glob("*.toml")]
    return {file.stem: file for file in files}


# --- An arm as a file that can be edited.


_URDF = re.compile(r'^(urdf\s*=\s*")([^"]*)(")', re.MULTILINE)


def arm_text(name_or_path: str, folder: Path) -> str:
    """The arm file of an arm as it would stand in a folder.

    Args:
        name_or_path: a built-in arm or an arm file, whose text is kept; or another file of a robot, which the
            new file names, with what is chosen of it and what it says of friction and limits.
        folder: where the file will stand.

    Raises:
        InputError: no such arm, or a file that describes none.
    """
    model, choice = load(name_or_path), split(name_or_path)[1]
    path = arm_file(name_or_path)
    if path.suffix.lower() != ".toml":
        return _overlay(model, path, folder, choice)
    text = open_document(path).text

    def beside(result: re.Match[str]) -> str:
        return f"{result[1]}{_from(path.parent / result[2], folder)}{result[3]}"

    return _URDF.sub(beside, text)


def _overlay(model: RobotModel, path: Path, folder: Path, choice: Choice) -> str:
    lines = [f'title = "{model.title}"', f'urdf = "{_from(path, folder)}"', *choice.lines]
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


__all__ = ["Number", "RobotModel", "load", "names"]
