"""An arm as a file that can be edited."""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import TYPE_CHECKING

from lyapcheck.files.decimals import decimal_text
from lyapcheck.files.toml import open_document
from lyapcheck.robots.registry import arm_file, load

if TYPE_CHECKING:
    from lyapcheck.robots.number import Number

_URDF = re.compile(r'^(urdf\s*=\s*")([^"]*)(")', re.MULTILINE)


def arm_text(name_or_path: str, folder: Path) -> str:
    """The arm file of an arm as it would stand in a folder.

    Args:
        name_or_path: a built-in arm or an arm file, whose text is kept; or a URDF file, which the new file
            names, with what it says of friction and limits.
        folder: where the file will stand.

    Raises:
        InputError: no such arm, or a file that describes none.
    """
    load(name_or_path)
    path = arm_file(name_or_path)
    if path.suffix.lower() == ".urdf":
        return _overlay(path, folder)
    text = open_document(path).text

    def beside(result: re.Match[str]) -> str:
        return f"{result[1]}{_from(path.parent / result[2], folder)}{result[3]}"

    return _URDF.sub(beside, text)


def _overlay(path: Path, folder: Path) -> str:
    model = load(path)
    lines = [f'title = "{model.title}"', f'urdf = "{_from(path, folder)}"']
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
