"""An arm as a file that can be edited."""

from __future__ import annotations

import json
import os
import re
from pathlib import Path
from typing import TYPE_CHECKING

from lyapcheck.files.decimals import decimal_text
from lyapcheck.files.toml import open_document
from lyapcheck.robots.registry import arm_file, load

if TYPE_CHECKING:
    from lyapcheck.robots.model import RobotModel
    from lyapcheck.robots.number import Number

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
