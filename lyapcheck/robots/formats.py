"""A file of a robot in whatever format it is: the tag of its root decides, not its name."""

from __future__ import annotations

from pathlib import Path

from lyapcheck.errors import argument_error, file_error
from lyapcheck.files.reader import URDF, read_bytes
from lyapcheck.libraries import installed
from lyapcheck.robots.choice import FILES, Choice
from lyapcheck.robots.fields import Number
from lyapcheck.robots.plant import RobotModel
from lyapcheck.robots.urdf import read_urdf
from lyapcheck.robots.urdf.xml import Element, parse_xml

_READ = "give an arm file (.toml), or a robot as URDF, xacro or MJCF"
_SILENT = (
    "visual",
    "collision",
    "gazebo",
    "transmission",
    "material",
    "sensor",
    "ros2_control",
    "xacro:macro",
)
"""What has no influence on an arm, so that its macros need not be expanded."""
_DEFINED = ("xacro:property", "xacro:arg")


def read_robot(
    path: Path, shown: str, choice: Choice, gravity: tuple[Number, ...] | None = None
) -> RobotModel:
    """The arm in a file of a robot: URDF, xacro (expanded by xacro) or MJCF (compiled by MuJoCo).

    Args:
        path: the file.
        shown: its name in messages.
        choice: which of its chains, and the arguments of a xacro file.
        gravity: acceleration of free fall in the frame of the root, m/s²; that of the file, or of the earth.

    Raises:
        InputError: none of these, a package is missing, or the file describes no arm.
    """
    if path.suffix.lower() not in FILES and not path.exists():
        raise file_error(shown, "is no arm file", _READ)
    content = read_bytes(path, URDF, shown)
    if b"<" not in content[:2000] and path.suffix.lower() not in (".urdf", ".xacro", ".xml"):
        raise file_error(shown, "is no arm file", _READ)
    root, source = parse_xml(content, shown), ""
    if choice.xacro and not (root.tag == "robot" and has_macros(root)):
        names = ", ".join(choice.xacro)
        raise argument_error("xacro", names, f"{shown} is no xacro file", "leave the arguments out")
    if root.tag == "mujoco":
        from lyapcheck.robots.mjcf import read_mjcf

        compiled = read_mjcf(path, shown, root)
        fall, remarks = gravity or compiled.gravity, compiled.remarks
        return read_urdf(compiled.robot, path, shown, choice, fall, remarks, compiled.source)
    if root.tag == "sdf":
        new = path.with_suffix(".urdf").name
        repair = f"convert it: pip install rod && rod -f {path.name} -o {new}"
        raise file_error(shown, "is SDF, which is not read here", repair)
    if root.tag != "robot":
        raise file_error(shown, f"is XML with the root <{root.tag[:40]}>, and no robot", _READ)
    remarks = ()
    if has_macros(root):
        root = parse_xml(expanded(path, shown, choice), shown)
        source = f"{path.name} expanded by xacro"
        remarks = ("Lines are those of the URDF that xacro writes",)
    return read_urdf(root, path, shown, choice, gravity, remarks, source)


def has_macros(element: Element) -> bool:
    """Whether an arm of this file depends on what xacro makes of it; properties that nothing uses do not."""
    for child in element.children:
        if child.tag in (*_SILENT, *_DEFINED):
            continue
        used = any(mark in text for text in child.attributes.values() for mark in ("${", "$("))
        if child.tag.startswith("xacro:") or used or has_macros(child):
            return True
    return False


def expanded(path: Path, shown: str, choice: Choice) -> bytes:
    """The URDF of a xacro file, by the package xacrodoc or xacro.

    Raises:
        InputError: neither is installed, or the file cannot be expanded.
    """
    new = path.name.removesuffix(".xacro").removesuffix(".urdf") + ".urdf"
    by_hand = f"run xacro on it: xacro {path.name} -o {new}"
    if not (installed("xacrodoc") or installed("xacro")):
        rule = "is a xacro file, and no package that expands it is installed"
        raise file_error(shown, rule, f'pip install "lyapcheck[xacro]", or {by_hand}')
    try:
        if installed("xacrodoc"):
            from xacrodoc import XacroDoc

            return str(XacroDoc.from_file(str(path), subargs=dict(choice.xacro)).to_urdf_string()).encode()
        import xacro

        return bytes(xacro.process_file(str(path), mappings=dict(choice.xacro)).toxml(encoding="utf-8"))
    except (Exception, SystemExit) as error:  # whatever its macros do
        said = " ".join(str(error).split())[:200] or type(error).__name__
        repair = f"give its arguments by --xacro NAME:=VALUE, or {by_hand}"
        raise file_error(shown, f"is a xacro file that cannot be expanded ({said})", repair) from None
