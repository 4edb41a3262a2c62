"""Arm files: one TOML file describes one arm, built-in or the user's own.

Every number is a plain decimal, read exactly, or a table that says more about it: value, unit, source, note,
whether it is assumed, and a range. A number with a range becomes a parameter of the model. Units are SI and
fixed by the key. M and the potential come from one of three:

- a **chain of links**, ``[[links]]``, one for each joint with the link that it moves, see
  `lyapcheck.robots.bodies`. All frames are parallel to the base frame at q = 0. An inertia about the centre
  of mass is one number when all axes are parallel, else a table of ixx, iyy, izz, ixy, ixz, iyz;
- a **printed model**, ``[model]`` with ``[[joints]]``, see `lyapcheck.robots.printed`. ``[printed]`` has
  C(q, q̇) or g(q) as printed, to be compared with what M and the potential give;
- a **URDF, xacro or MJCF file**, ``urdf = "…"``, see `lyapcheck.robots.formats`. ``[[joints]]`` has what it
  lacks.

``[loop]`` is the loop that a computer runs, see `lyapcheck.files.loop`. docs/file_keys.py has every key.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

from lyapcheck.errors import InputError, file_error, nearest
from lyapcheck.files.loop import read_loop
from lyapcheck.files.reader import ARM
from lyapcheck.files.toml import ARM as TOML_ARM
from lyapcheck.files.toml import open_document, require_kind
from lyapcheck.output.escapes import printable
from lyapcheck.robots.bodies import ChainPlan, impossible_state, read_chain
from lyapcheck.robots.choice import Choice
from lyapcheck.robots.fields import PARTS, ArmFields, ArmNotes, Number, Vary, of_joints, read_motor
from lyapcheck.robots.plant import RobotModel
from lyapcheck.robots.printed import PrintedPlan, read_model
from lyapcheck.robots.vary import MASSES, require_movable, varied, varied_numbers, with_bodies

EXACT = Fraction(0)


def read_arm(
    path: Path,
    shown: str | None = None,
    spread: Fraction = EXACT,
    vary: tuple[Vary, ...] = (),
    tested: bool = False,
    choice: Choice | None = None,
) -> RobotModel:
    """The arm that a file describes; ``shown`` is the name of the file in messages.

    Args:
        path: of the file.
        shown: its name in messages.
        spread: numbers of M, of the potential and of friction get value·(1 ± spread) if they have no range;
            of an arm that names a URDF file masses and friction.
        vary: ranges in place of those of the file.
        tested: leave out what finds slips in a file by sampling.
        choice: of an arm that names a file of a robot, before that of the file.

    Raises:
        InputError: the file cannot be read or describes no arm; carries every problem found.
    """
    name = str(path) if shown is None else shown
    if path.suffix.lower() != ".toml" and not path.is_dir():
        raise file_error(name, "is no arm file", "give the path of a .toml file")
    document = open_document(path, name, ARM)
    require_kind(document.name, document.data, TOML_ARM)
    source = document.data.get("source")
    notes = ArmNotes(document.name, document.line, source if isinstance(source, str) else "")
    top = ArmFields(document.data, (), notes)
    title, _ = top.text("title", required=True), top.text("source")
    remarks, loop = top.texts("remarks"), read_loop(top.table("loop"))
    if "urdf" in top.data:  # which also reports what was noted so far
        model = _overlay(path, title, remarks, top, choice or Choice())
        return replace(with_ranges(model, spread, vary), loop=loop)
    if choice:
        rule = "has no links to choose from: only an arm file that names a robot by urdf = … has"
        raise file_error(document.name, rule, "leave base, tip, fixed and xacro out")
    plan = _plan(top)
    top.close()
    if notes.problems or plan is None:
        raise InputError(notes.problems)
    numbers = {key: number.widened(spread) for key, number in plan.numbers.items()}
    numbers = varied_numbers(numbers, vary)
    parameters = {key: number for key, number in numbers.items() if number.ranged and key in plan.used}
    dynamics = plan.build(numbers, tuple(parameters))
    for joint in plan.joints:
        numbers |= joint.numbers()
    model = RobotModel(
        name=printable(path.stem),
        title=title,
        dynamics=dynamics,
        **of_joints(plan.joints, spread),
        numbers=numbers,
        parameters=parameters,
        remarks=remarks,
        printed=plan.torques,
        loop=loop,
    )
    model = varied(model, vary, links=False)
    if not tested and (broken := impossible_state(model)):
        repair = "every joint must move some inertia: check masses, inertias, signs and ranges"
        notes.fail((plan.place,), None, broken, repair)
        raise InputError(notes.problems)
    return model


def _plan(top: ArmFields) -> ChainPlan | PrintedPlan | None:
    """Links to derive M and the potential from, or what is printed of them; problems are noted."""
    links, joints = top.tables("links"), top.tables("joints")
    numbers, model, torques = top.table("numbers"), top.table("model"), top.table("printed")
    gravity = top.vector("gravity", "m/s²") if "links" in top.data or "gravity" in top.data else None
    if "links" in top.data:
        for key in ("joints", "numbers", "model", "printed"):
            if key in top.data:
                top.fail(
                    key,
                    "does not go together with [[links]]",
                    "keep the links or the printed model, not both",
                )
        return read_chain(top, links, gravity) if links else None
    if "model" in top.data and "gravity" in top.data:
        top.fail("gravity", "is already inside the printed potential", "remove it")
    if joints and model:
        return read_model(top, joints, numbers, model, torques)
    if "model" not in top.data and "joints" not in top.data:
        top.fail("links", "is missing", "describe the arm by [[links]], or by [model] and [[joints]]")
    elif "model" not in top.data or "joints" not in top.data:
        key, form = ("model", "[model]") if "joints" in top.data else ("joints", "[[joints]]")
        top.fail(key, "is missing", f"a printed model needs {form} as well")
    return None


def with_ranges(model: RobotModel, spread: Fraction, vary: tuple[Vary, ...]) -> RobotModel:
    """An arm of a URDF file with ranges for masses and friction.

    Raises:
        InputError: a range of another number.
    """
    require_movable(model, vary)
    names = (*MASSES, "viscous") if spread else ()
    return varied(model, (*(Vary(name, 1 - spread, 1 + spread, True) for name in names), *vary))


# --- Arm files that name a file of a robot: its links, with friction, limits and encoders given here.


def _overlay(path: Path, title: str, remarks: tuple[str, ...], top: ArmFields, choice: Choice) -> RobotModel:
    """The arm of the file that ``urdf`` names, with the numbers of ``[[joints]]`` in place of its own.

    A choice goes before that of the file.

    Raises:
        InputError: either file has a problem; those of the arm file come first.
    """
    from lyapcheck.robots.formats import read_robot

    file = top.text("urdf", required=True)
    fixed: dict[str, Fraction] = {}
    for joint, value in _pairs(top, "fixed").items():
        exact = top.decimal(("fixed", joint), value)
        fixed |= {} if exact is None else {joint: exact}
    xacro = {name: str(value) for name, value in _pairs(top, "xacro").items()}
    own = Choice(top.text("base"), top.text("tip"), fixed, xacro)
    gravity = top.vector("gravity", "m/s²") if "gravity" in top.data else None
    if gravity is not None and any(x.ranged for x in gravity):
        top.fail("gravity", "must be exact here", "give plain numbers")
    tables = top.tables("joints")
    motors = [read_motor(table.text("name", required=True), table, required=False) for table in tables]
    for i, (table, motor) in enumerate(zip(tables, motors, strict=True)):
        table.close()
        if motor.name in [other.name for other in motors[:i]]:
            table.fail("name", "is given twice", "give each joint one table")
    top.close()
    if file and Path(file).suffix.lower() == ".toml":
        top.fail("urdf", "must be the path of a file of a robot", 'write urdf = "arm.urdf"')
    if top.notes.problems:
        raise InputError(top.notes.problems)
    model = read_robot(path.parent / file, file, choice.over(own), gravity)
    for i, motor in enumerate(motors):
        if motor.name not in model.joints:
            repair = nearest(motor.name, model.joints, f"use one of: {', '.join(model.joints)}")
            top.notes.fail(("joints", i, "name"), motor.name, "is no joint of this chain", repair)
    if top.notes.problems:
        raise InputError(top.notes.problems)
    parts: dict[str, Any] = {key: list(getattr(model, key)) for key in PARTS}
    numbers, rotors = dict(model.numbers), dict[str, Number]()
    for motor in motors:
        numbers |= motor.numbers() | motor.rotors
        rotors |= motor.rotors
        for key in PARTS:
            value = getattr(motor, key)
            if value is not None:
                parts[key][model.joints.index(motor.name)] = value
    changed: dict[str, Any] = {key: tuple(values) for key, values in parts.items()}
    changed |= {"name": printable(path.stem), "title": title, "remarks": (*remarks, *model.remarks)}
    return with_bodies(replace(model, numbers=numbers, **changed), rotors)


def _pairs(top: ArmFields, key: str) -> dict[str, object]:
    value = top.raw(key)
    if value is None or isinstance(value, dict):
        return value or {}
    top.fail(key, "must be a table of names and values", f"write {key} = {{ NAME = VALUE }}")
    return {}
