"""Arm files that name a file of a robot: its links, with friction, limits and encoders given here."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

from lyapcheck.errors import InputError, nearest
from lyapcheck.output.escapes import printable
from lyapcheck.robots.choice import Choice
from lyapcheck.robots.fields import ArmFields, Number
from lyapcheck.robots.formats import read_robot
from lyapcheck.robots.joints import JointEntry, read_motor
from lyapcheck.robots.plant import RobotModel
from lyapcheck.robots.vary import with_rotors

_PARTS = ("viscous", "coulomb", "torque_limit", "encoder", "gravity_bound")


def read_overlay(
    path: Path, title: str, remarks: tuple[str, ...], top: ArmFields, choice: Choice
) -> RobotModel:
    """The arm of the file that ``urdf`` names, with the numbers of ``[[joints]]`` in place of its own.

    A choice goes before that of the file.

    Raises:
        InputError: either file has a problem; those of the arm file come first.
    """
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
    parts: dict[str, list[Any]] = {key: list(getattr(model, key)) for key in _PARTS}
    numbers: dict[str, Number] = dict(model.numbers)
    for motor in motors:
        numbers |= motor.numbers()
        for key in _PARTS:
            value = getattr(motor, key)
            if value is not None:
                parts[key][model.joints.index(motor.name)] = value
    changed: dict[str, Any] = {key: tuple(values) for key, values in parts.items()}
    rotors = {name: number for motor in motors for name, number in motor.rotors.items()}
    return with_rotors(replace(model, numbers=numbers | rotors, **changed), rotors)
