"""Arm files: one TOML file describes one arm, built-in or the user's own.

Every number is a plain decimal, read exactly, or a table that says more about it::

    mass = 23.902
    mass = { value = 23.902, unit = "kg", source = "…", assumed = true, low = 23, high = 25, note = "why" }

An assumed number needs a reason (``note`` or ``source``); one with ``low`` and ``high`` may have any value
between them. Units are SI and fixed by the key. At the top of a file stand::

    title = "…"             one line for reports
    source = "…"            optional: where the plain numbers are printed
    remarks = ["…"]         optional: what else is taken for granted, one sentence each

Then comes one of two kinds of model. **Links**: a serial chain of revolute joints, from which M and the
potential are derived. All frames are parallel to the base frame at q = 0; lengths in m::

    gravity = [0, 0, -9.81]           m/s², in the base frame

    [[links]]                         one for each joint with the link that it moves, base first
    name = "shoulder"
    axis = [0, 0, 1]                  of length exactly 1
    origin = [0, 0, 0]                of the joint, from the joint before (or the base)
    mass = 23.902                     kg
    com = [0, -0.091, 0]              centre of mass, from the joint
    inertia = 1.266                   kg·m² about the centre of mass: one number when all axes are
                                      parallel, else a table of ixx, iyy, izz (ixy, ixz, iyz)
    viscous = 2.288                   N·m·s/rad
    coulomb = 7.17                    N·m, optional, as are the following
    torque_limit = 150                N·m
    encoder = 1024000                 counts per turn
    gravity_bound = 40.28             N·m, k_gi where a source prints it

**Printed**: M and the potential energy as a source prints them, as terms (`lyapcheck.robots.printed`), with
the motors in ``[[joints]]`` (the keys of a link from ``viscous`` on, and ``name``)::

    [numbers]
    b = 0.084

    [model]
    M11 = [[2.351, ""], [2, "b c2"]]
    M12 = [[0.102, ""], [1, "b c2"]]  on and above the diagonal
    M22 = [[0.102, ""]]
    potential = [[-38.46501, "c1"], [-1.82466, "c12"]]     J
"""

from __future__ import annotations

from pathlib import Path

from lyapcheck.errors import InputError
from lyapcheck.robots import trig
from lyapcheck.robots.document import open_arm
from lyapcheck.robots.fields import ArmFields, ArmNotes
from lyapcheck.robots.model import RobotModel
from lyapcheck.robots.physics import check_positive_definite
from lyapcheck.robots.plans import Plan, read_plan


def read_arm(path: Path, shown: str | None = None) -> RobotModel:
    """The arm that a file describes; ``shown`` is the name of the file in messages.

    Raises:
        InputError: the file cannot be read or describes no arm; carries every problem found.
    """
    document = open_arm(path, str(path) if shown is None else shown)
    source = document.data.get("source")
    notes = ArmNotes(document.name, document.line, source if isinstance(source, str) else "")
    top = ArmFields(document.data, (), notes)
    title, _ = top.text("title", required=True), top.text("source")
    remarks = top.texts("remarks")
    plan = read_plan(top)
    top.close()
    if notes.problems or plan is None:
        raise InputError(notes.problems)
    model = _model(path.stem, title, remarks, plan)
    check_positive_definite(model, plan.place, notes)
    if notes.problems:
        raise InputError(notes.problems)
    return model


def _model(name: str, title: str, remarks: tuple[str, ...], plan: Plan) -> RobotModel:
    numbers, joints = plan.numbers(), plan.joints
    parameters = {key: number for key, number in numbers.items() if number.ranged and key in plan.used()}
    ring = trig.trig_ring(len(joints), tuple(parameters))
    polys = {key: trig.constant(ring, number.value) for key, number in numbers.items()}
    polys |= dict(zip(parameters, ring.gens()[2 * len(joints) :], strict=True))
    mass, potential = plan.build(ring, polys)
    for joint in joints:
        numbers |= joint.numbers()
    return RobotModel(
        name=name,
        title=title,
        joints=tuple(joint.name for joint in joints),
        ring=ring,
        mass=mass,
        potential=potential,
        viscous=tuple(joint.viscous for joint in joints if joint.viscous is not None),
        coulomb=tuple(joint.coulomb for joint in joints),
        torque_limit=tuple(joint.torque_limit for joint in joints),
        encoder=tuple(joint.encoder for joint in joints),
        gravity_bound=tuple(joint.gravity_bound for joint in joints),
        numbers=numbers,
        parameters=parameters,
        remarks=remarks,
    )
