"""Arm files: one TOML file describes one arm, built-in or the user's own.

Every number is a plain decimal, read exactly, or a table that says more about it::

    mass = { value = 23.902, unit = "kg", source = "…", assumed = true, low = 23, high = 25, note = "why" }

An assumed number needs a reason (``note`` or ``source``). One with ``low`` and ``high`` may have any value
between them: it becomes a parameter of the model. Units are SI and fixed by the key. An arm has as
many joints as ``links`` or ``joints`` tables: at most twelve links, or nine joints of a printed model.

A **chain of links** gives M and the potential by derivation. All frames are parallel to the base frame at
q = 0, lengths in m. An inertia about the centre of mass is one number when all axes are parallel, else a
table of ixx, iyy, izz and, where they are not zero, ixy, ixz, iyz::

    title = "Pendulum"                  # one line for reports
    source = "a textbook"               # optional: where the plain numbers are printed
    remarks = ["The rod is rigid."]     # optional: what else is taken for granted, in sentences
    gravity = [0, 0, -9.81]             # m/s², in the base frame

    [[links]]                           # one for each joint with the link that it moves, base first
    name = "pivot"
    axis = [0, 1, 0]                    # of a rational length, as [3, 4, 0] is
    origin = [0, 0, 0]                  # of the joint, from the joint before (or the base)
    mass = 23.902                       # kg
    com = [0, 0, -0.091]                # centre of mass, from the joint
    inertia = 1.266                     # kg·m²
    viscous = 2.288                     # N·m·s/rad
    coulomb = 7.17                      # N·m; this and the following are optional
    rotor_inertia = 0.8                 # kg·m² at the joint; or { rotor = 5e-5, gear = 100 }, times gear²
    torque_limit = 150                  # N·m
    encoder = 1024000                   # counts per turn
    gravity_bound = 40.28               # N·m, k_gi where a source prints it

A **printed model** gives M on and above the diagonal (kg·m²) and the potential energy (J) as terms, see
`lyapcheck.robots.printed`, and the motors in ``[[joints]]``::

    title = "Two-joint arm as printed"

    [numbers]                           # optional: numbers that the terms name
    b = 0.084

    [model]
    M11 = [[2.351, ""], [2, "b c2"]]
    M12 = [[0.102, ""], [1, "b c2"]]
    M22 = [[0.102, ""]]
    potential = [[-38.46501, "c1"], [-1.82466, "c12"]]

    [[joints]]                          # name, viscous and the optional keys of a link after it
    name = "shoulder"
    viscous = 2.288

    [[joints]]
    name = "elbow"
    viscous = 0.175

A **printed C(q, q̇) or g(q)** goes into ``[printed]`` beside ``[model]``, to be compared with what M and the
potential give, see `lyapcheck.robots.printed`.

A **loop** that a computer runs goes into ``[loop]``, see `lyapcheck.files.loop`.

A **URDF, xacro or MJCF file** gives the links, and this file what it lacks, see `lyapcheck.robots.formats`::

    title = "UR5 with friction"
    urdf = "ur5_robot.urdf"             # beside this file, or a path from here
    base = "base_link"                  # optional: the link that the chain begins at
    tip = "ee_link"                     # optional: the link that ends it
    fixed = { lift_joint = 0.2 }        # optional: joints that are held, rad or m
    xacro = { tool = "gripper" }        # optional: arguments of a xacro file
    gravity = [0, 0, -9.81]             # optional

    [[joints]]                          # optional: numbers that replace those of the URDF file
    name = "elbow_joint"
    viscous = { value = 0.5, assumed = true, note = "a guess" }
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
from lyapcheck.robots.bodies import ChainPlan, check_positive_definite, read_chain
from lyapcheck.robots.choice import Choice
from lyapcheck.robots.fields import PARTS, ArmFields, ArmNotes, JointEntry, Number, of_joints, read_motor
from lyapcheck.robots.plant import RobotModel
from lyapcheck.robots.printed import PrintedPlan, read_model
from lyapcheck.robots.vary import (
    MASSES,
    MOTOR,
    PAYLOAD,
    Vary,
    require_movable,
    varied,
    varied_numbers,
    with_rotors,
)

EXACT = Fraction(0)
Plan = ChainPlan | PrintedPlan
"""A checked description of M and the potential: links to derive them from, or printed polynomials."""


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
        model = read_overlay(path, title, remarks, top, choice or Choice())
        return replace(with_ranges(model, spread, vary), loop=loop)
    if choice:
        rule = "has no links to choose from: only an arm file that names a robot by urdf = … has"
        raise file_error(document.name, rule, "leave base, tip, fixed and xacro out")
    plan = _plan(top)
    top.close()
    if notes.problems or plan is None:
        raise InputError(notes.problems)
    model = _model(printable(path.stem), title, remarks, plan, spread, vary)
    model = varied(model, vary, (*MOTOR, PAYLOAD))
    if not tested:
        check_positive_definite(model, plan.place, notes)
    if notes.problems:
        raise InputError(notes.problems)
    return replace(model, loop=loop)


def _plan(top: ArmFields) -> Plan | None:
    """The model of an arm file, ``None`` when it has none that can be built; problems are noted."""
    links, joints = top.tables("links"), top.tables("joints")
    numbers, model, torques = top.table("numbers"), top.table("model"), top.table("printed")
    gravity = top.vector("gravity", "m/s²") if "links" in top.data or "gravity" in top.data else None
    for key in ("joints", "numbers", "model", "printed"):
        if "links" in top.data and key in top.data:
            top.fail(
                key, "does not go together with [[links]]", "keep the links or the printed model, not both"
            )
    if "model" in top.data and "links" not in top.data and "gravity" in top.data:
        top.fail("gravity", "is already inside the printed potential", "remove it")
    if links:
        return read_chain(top, links, gravity)
    if joints and model:
        return read_model(top, joints, numbers, model, torques)
    _note_missing(top)
    return None


def _note_missing(top: ArmFields) -> None:
    if "links" in top.data:
        return
    if "model" not in top.data and "joints" not in top.data:
        top.fail("links", "is missing", "describe the arm by [[links]], or by [model] and [[joints]]")
    for key, form in (("model", "[model]"), ("joints", "[[joints]]")):
        if key not in top.data and ("model" in top.data or "joints" in top.data):
            top.fail(key, "is missing", f"a printed model needs {form} as well")


def with_ranges(model: RobotModel, spread: Fraction, vary: tuple[Vary, ...]) -> RobotModel:
    """An arm of a URDF file with ranges for masses and friction.

    Raises:
        InputError: a range of another number.
    """
    require_movable(model, vary)
    all_of_it = (
        tuple(Vary(name, 1 - spread, 1 + spread, True) for name in (*MASSES, "viscous")) if spread else ()
    )
    return varied(model, (*all_of_it, *vary))


def _model(
    name: str,
    title: str,
    remarks: tuple[str, ...],
    plan: Plan,
    spread: Fraction,
    vary: tuple[Vary, ...],
) -> RobotModel:
    joints = plan.joints
    numbers = {key: number.widened(spread) for key, number in plan.numbers().items()}
    numbers = varied_numbers(numbers, vary)
    parameters = {key: number for key, number in numbers.items() if number.ranged and key in plan.used()}
    dynamics = plan.build(numbers, tuple(parameters))
    for joint in joints:
        numbers |= joint.numbers()
    return RobotModel(
        name=name,
        title=title,
        dynamics=dynamics,
        **of_joints(joints, spread),
        numbers=numbers,
        parameters=parameters,
        remarks=remarks,
        printed=plan.torques,
    )


# --- Arm files that name a file of a robot: its links, with friction, limits and encoders given here.


def read_overlay(
    path: Path, title: str, remarks: tuple[str, ...], top: ArmFields, choice: Choice
) -> RobotModel:
    """The arm of the file that ``urdf`` names, with the numbers of ``[[joints]]`` in place of its own.

    A choice goes before that of the file.

    Raises:
        InputError: either file has a problem; those of the arm file come first.
    """
    from lyapcheck.robots.formats import read_robot

    file, own = top.text("urdf", required=True), _choice(top)
    gravity = top.vector("gravity", "m/s²") if "gravity" in top.data else None
    if gravity is not None and any(x.ranged for x in gravity):
        top.fail("gravity", "must be exact here", "give plain numbers")
    motors = _read_motors(top)
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
    return _completed(
        replace(model, name=printable(path.stem), title=title, remarks=(*remarks, *model.remarks)), motors
    )


def _choice(top: ArmFields) -> Choice:
    fixed: dict[str, Fraction] = {}
    for joint, value in _pairs(top, "fixed").items():
        exact = top.decimal(("fixed", joint), value)
        fixed |= {} if exact is None else {joint: exact}
    xacro = {name: str(value) for name, value in _pairs(top, "xacro").items()}
    return Choice(top.text("base"), top.text("tip"), fixed, xacro)


def _pairs(top: ArmFields, key: str) -> dict[str, object]:
    value = top.raw(key)
    if value is None or isinstance(value, dict):
        return value or {}
    top.fail(key, "must be a table of names and values", f"write {key} = {{ NAME = VALUE }}")
    return {}


def _read_motors(top: ArmFields) -> list[JointEntry]:
    tables = top.tables("joints")
    motors = [read_motor(table.text("name", required=True), table, required=False) for table in tables]
    for i, (table, motor) in enumerate(zip(tables, motors, strict=True)):
        table.close()
        if motor.name in [other.name for other in motors[:i]]:
            table.fail("name", "is given twice", "give each joint one table")
    return motors


def _completed(model: RobotModel, motors: list[JointEntry]) -> RobotModel:
    parts: dict[str, list[Any]] = {key: list(getattr(model, key)) for key in PARTS}
    numbers: dict[str, Number] = dict(model.numbers)
    for motor in motors:
        numbers |= motor.numbers()
        for key in PARTS:
            value = getattr(motor, key)
            if value is not None:
                parts[key][model.joints.index(motor.name)] = value
    changed: dict[str, Any] = {key: tuple(values) for key, values in parts.items()}
    rotors = {name: number for motor in motors for name, number in motor.rotors.items()}
    return with_rotors(replace(model, numbers=numbers | rotors, **changed), rotors)
