"""A file of a robot in whatever format it is: the tag of its root decides, not its name.

MJCF is taken as MuJoCo compiles it, written as the elements of a URDF file: bodies become links, hinges
revolute joints, slides prismatic ones, ball and free joints floating ones. Numbers are the shortest decimals
of MuJoCo's doubles. Gravity, damping, dry friction and the limits of the motors are those of the model.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import redirect_stderr
from fractions import Fraction
from io import StringIO
from pathlib import Path
from typing import Any

from lyapcheck.errors import argument_error, file_error, installed
from lyapcheck.files.reader import URDF, read_bytes
from lyapcheck.robots.choice import FILES, Choice
from lyapcheck.robots.fields import Number
from lyapcheck.robots.plant import RobotModel
from lyapcheck.robots.urdf import read_urdf
from lyapcheck.robots.urdf.xml import Element, parse_xml

_HERE = (1.0, 0.0, 0.0, 0.0)


def read_mjcf(path: Path, shown: str, root: Element) -> Compiled:
    """A file that MuJoCo compiles, with what it includes.

    Raises:
        InputError: MuJoCo is not installed, or refuses the file.
    """
    if not installed("mujoco"):
        repair = 'pip install "lyapcheck[mjcf]", or give the URDF of this robot'
        raise file_error(shown, "is MJCF, which MuJoCo compiles, and that is not installed", repair)
    import mujoco

    mujoco.set_mju_user_warning(lambda message: None)  # which else go to a file in the working directory
    try:
        model = mujoco.MjModel.from_xml_path(str(path))
    except ValueError as error:
        said = " ".join(str(error).split())[:300]
        raise file_error(shown, f"is MJCF that MuJoCo refuses: {said}", "correct that") from None
    lines: dict[str, int] = {}  # of each body and joint that this file itself names
    waiting = [root]
    while waiting:
        element = waiting.pop()
        if element.tag in ("body", "joint") and "name" in element.attributes:
            lines.setdefault(f"{element.tag} {element.attributes['name']}", element.line)
        waiting += element.children
    return Compiled(mujoco, model, path.name, lines)


class Compiled:
    """A compiled model, ``m`` of MuJoCo's, as URDF elements, with what URDF has no place for."""

    def __init__(self, mujoco: Any, m: Any, file: str, lines: dict[str, int]) -> None:
        self.mujoco, self.m, self.lines = mujoco, m, lines
        self.source = f"{file}, compiled by MuJoCo {mujoco.__version__}"
        self.bodies = [self._name("body", i) for i in range(m.nbody)]
        self.joints = [self._name("joint", i) for i in range(m.njnt)]

    def robot(self) -> Element:
        m = self.m
        name = str(m.names[: m.names.find(b"\0")], "utf-8", "replace") or "model"
        parts = [part for body in range(m.nbody) for part in self._body(body)]
        return Element("robot", {"name": name, "version": "1.1"}, 1, parts)

    def gravity(self) -> tuple[Number, ...]:
        return tuple(Number(Fraction(_text(x)), "m/s²", self.source) for x in self.m.opt.gravity)

    def _name(self, kind: str, index: int) -> str:
        of = getattr(self.mujoco.mjtObj, f"mjOBJ_{kind.upper()}")
        return self.mujoco.mj_id2name(self.m, of, index) or f"{kind}{index}"

    def _body(self, i: int) -> Iterator[Element]:
        """The link of a body, and the joints between it and its parent."""
        import numpy as np

        m, name = self.m, self.bodies[i]
        line = self.lines.get(f"body {name}", 1)
        moments = dict(zip(("ixx", "iyy", "izz"), map(_text, m.body_inertia[i]), strict=True))
        inertia = Element("inertia", {**moments, "ixy": "0", "ixz": "0", "iyz": "0"}, line)
        mass = Element("mass", {"value": _text(m.body_mass[i])}, line)
        origin = self._origin(line, m.body_ipos[i], m.body_iquat[i])
        parts = [Element("inertial", {}, line, [origin, mass, inertia])] if m.body_mass[i] else []
        yield Element("link", {"name": name}, line, parts)
        if i == 0:
            return
        above, place, turn = self.bodies[m.body_parentid[i]], m.body_pos[i], m.body_quat[i]
        first = m.body_jntadr[i]
        for j in range(first, first + m.body_jntnum[i]):
            below = f"{name}/{self.joints[j]}"
            # of a hinge back from the pose that the file describes to where its angle is 0
            back, moved, turned = np.array(_HERE), np.zeros(3), np.array(_HERE)
            if m.jnt_type[j] == self.mujoco.mjtJoint.mjJNT_HINGE:
                self.mujoco.mju_axisAngle2Quat(back, m.jnt_axis[j], -m.qpos0[m.jnt_qposadr[j]])
            self.mujoco.mju_rotVecQuat(moved, m.jnt_pos[j], turn)
            self.mujoco.mju_mulQuat(turned, turn, back)
            yield Element("link", {"name": below}, line)
            yield self._joint(j, above, below, place + moved, turned)
            above, place, turn = below, -m.jnt_pos[j], _HERE
        parts = self._ends(line, above, name, place, turn)
        yield Element("joint", {"name": f"{name}/body", "type": "fixed"}, line, parts)

    def _origin(self, line: int, place: Any, turn: Any) -> Element:
        w, x, y, z = turn
        words = {"xyz": " ".join(map(_text, place))}
        if any((x, y, z)):
            words["quat_xyzw"] = " ".join(map(_text, (x, y, z, w)))
        return Element("origin", words, line)

    def _ends(self, line: int, above: str, below: str, place: Any, turn: Any) -> list[Element]:
        parent, child = Element("parent", {"link": above}, line), Element("child", {"link": below}, line)
        return [parent, child, self._origin(line, place, turn)]

    def _joint(self, j: int, above: str, below: str, place: Any, turn: Any) -> Element:
        m, kinds = self.m, self.mujoco.mjtJoint
        line, degree = self.lines.get(f"joint {self.joints[j]}", 1), m.jnt_dofadr[j]
        names = {int(kinds.mjJNT_HINGE): "revolute", int(kinds.mjJNT_SLIDE): "prismatic"}
        kind = names.get(int(m.jnt_type[j]), "floating")
        parts = self._ends(line, above, below, place, turn)
        parts.append(Element("axis", {"xyz": " ".join(map(_text, m.jnt_axis[j]))}, line))
        friction = {"damping": m.dof_damping[degree], "friction": m.dof_frictionloss[degree]}
        parts.append(Element("dynamics", {key: _text(value) for key, value in friction.items()}, line))
        if m.dof_armature[degree]:
            parts.append(Element("armature", {"value": _text(m.dof_armature[degree])}, line))
        limits = []  # of what its motors can do in both directions, N·m
        if m.jnt_actfrclimited[j]:
            limits.append(min(abs(end) for end in m.jnt_actfrcrange[j]))
        forces: list[float | None] = [
            self._force(a)
            for a in range(m.nu)
            if m.actuator_trntype[a] == self.mujoco.mjtTrn.mjTRN_JOINT and m.actuator_trnid[a][0] == j
        ]
        if forces and None not in forces:
            limits.append(sum(force for force in forces if force is not None))
        parts.append(Element("limit", {"effort": _text(min(limits)) if limits else "0"}, line))
        return Element("joint", {"name": self.joints[j], "type": kind}, line, parts)

    def _force(self, a: int) -> float | None:
        """The largest force of an actuator in both directions, times its gear."""
        m, limits = self.m, []
        if m.actuator_forcelimited[a]:
            limits.append(min(abs(end) for end in m.actuator_forcerange[a]))
        direct = m.actuator_biastype[a] == self.mujoco.mjtBias.mjBIAS_NONE
        if m.actuator_ctrllimited[a] and direct:
            limits.append(min(abs(end) for end in m.actuator_ctrlrange[a]) * abs(m.actuator_gainprm[a][0]))
        return min(limits) * abs(m.actuator_gear[a][0]) if limits else None

    def remarks(self) -> Iterator[str]:
        m = self.m
        springs = [self.joints[j] for j in range(m.njnt) if m.jnt_stiffness[j].any()]
        if springs:
            yield f"Springs of joints are not part of the arm: {', '.join(springs)}"
        floating = [self.bodies[i] for i in range(m.nbody) if m.body_gravcomp[i]]
        if floating:
            yield f"Gravity counts for bodies that MuJoCo holds up (gravcomp): {', '.join(floating)}"
        for count, what in ((m.neq, "equality constraints"), (m.ntendon, "tendons")):
            if count:
                yield f"Not part of the arm: {count} {what} of the model"


def _text(value: float) -> str:
    return repr(float(value) + 0.0)


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
        compiled = read_mjcf(path, shown, root)
        fall, remarks = gravity or compiled.gravity(), tuple(compiled.remarks())
        return read_urdf(compiled.robot(), path, shown, choice, fall, remarks, compiled.source)
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
        with redirect_stderr(StringIO()):  # its warnings would be told at each reading of the file
            if installed("xacrodoc"):
                from xacrodoc import XacroDoc

                document = XacroDoc.from_file(str(path), subargs=dict(choice.xacro))
                return str(document.to_urdf_string()).encode()
            import xacro

            return bytes(xacro.process_file(str(path), mappings=dict(choice.xacro)).toxml(encoding="utf-8"))
    except (Exception, SystemExit) as error:  # whatever its macros do
        said = " ".join(str(error).split())[:200] or type(error).__name__
        repair = f"give its arguments by --xacro NAME:=VALUE, or {by_hand}"
        raise file_error(shown, f"is a xacro file that cannot be expanded ({said})", repair) from None
