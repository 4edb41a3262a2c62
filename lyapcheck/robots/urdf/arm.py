"""From a URDF file to a robot model."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path

from lyapcheck.check.loop.chain import RigidLink
from lyapcheck.errors import InputError
from lyapcheck.output.escapes import printable
from lyapcheck.robots.bodies import impossible_state
from lyapcheck.robots.dynamics import Chain
from lyapcheck.robots.fields import Number
from lyapcheck.robots.plant import RobotModel
from lyapcheck.robots.urdf.numbers import gravity_numbers, joint_numbers, link_numbers, motor_of
from lyapcheck.robots.urdf.parts import Triple, UrdfJoint, UrdfNotes, read_parts
from lyapcheck.robots.urdf.rotations import Roundings
from lyapcheck.robots.urdf.tree import (
    Tree,
    build_tree,
    check_bodies,
    choose_chain,
    held,
    impossible,
    moved_bodies,
    moved_links,
)
from lyapcheck.robots.urdf.xml import Element, read_xml

EARTH: Triple = (Fraction(0), Fraction(0), Fraction("-9.81"))
"""URDF says nothing of gravity; its base frame has z upwards by custom."""


def read_urdf(
    path: Path, shown: str | None = None, tip: str | None = None, gravity: tuple[Number, ...] | None = None
) -> RobotModel:
    """The arm of a URDF file: M, C and g of the revolute joints between its root and one tip.

    Decimals are exact; rotations are exactly orthogonal and rounded as ``remarks`` of the model says. Links
    that fixed joints connect are one body. A joint that is not of the chain is held at its zero position.

    Args:
        path: the file.
        shown: its name in messages.
        tip: the link that ends the chain; by default the end of the chain with the most joints.
        gravity: acceleration of free fall in the frame of the root, m/s²; (0, 0, −9.81) by default.

    Raises:
        InputError: the file is no URDF, or not of a serial chain of revolute joints; carries every problem.
    """
    name = str(path) if shown is None else shown
    notes = UrdfNotes(name)
    root = read_xml(path, name)
    tree, chain = _chain(root, tip, notes)
    check_bodies(moved_links(tree, chain), notes)
    if notes.problems:
        raise InputError(notes.problems)
    roundings = Roundings()
    bodies = moved_bodies(tree, chain, roundings)
    remarks = (*roundings.sentences(), *_remarks(tree, chain))
    model = _model(_Read(path, root, tree, chain, bodies, remarks), gravity or gravity_numbers(EARTH))
    broken = impossible_state(model)
    if broken:
        repair = "every joint must move some inertia: check masses and inertias"
        notes.fail(root, "robot", "", broken, repair)
        raise InputError(notes.problems)
    return model


def _chain(root: Element, tip: str | None, notes: UrdfNotes) -> tuple[Tree, tuple[UrdfJoint, ...]]:
    links, joints = read_parts(root, notes)
    if notes.problems:
        raise InputError(notes.problems)
    tree = build_tree(links, joints, root, notes)
    chain = () if tree is None else choose_chain(tree, tip, root, notes)
    if tree is None or notes.problems:
        raise InputError(notes.problems)
    return tree, chain


@dataclass(frozen=True)
class _Read:
    path: Path
    root: Element
    tree: Tree
    chain: tuple[UrdfJoint, ...]
    bodies: tuple[RigidLink, ...]
    remarks: tuple[str, ...]


def _model(read: _Read, gravity: tuple[Number, ...]) -> RobotModel:
    file, stem = printable(read.path.name), printable(read.path.stem)
    motors = [motor_of(joint, file) for joint in read.chain]
    numbers = {f"gravity_{letter}": x for letter, x in zip("xyz", gravity, strict=True) if x.value}
    numbers |= link_numbers(read.tree, file) | joint_numbers(read.tree, read.chain, motors, file)
    nothing = (None,) * len(read.chain)
    return RobotModel(
        name=stem,
        title=f"{read.root.attributes.get('name', stem)[:80]} (URDF)",
        joints=tuple(joint.name for joint in read.chain),
        dynamics=Chain(read.bodies, tuple(entry.value for entry in gravity)),
        viscous=tuple(motor.viscous for motor in motors),
        coulomb=tuple(motor.coulomb for motor in motors),
        torque_limit=tuple(motor.torque_limit for motor in motors),
        encoder=nothing,
        gravity_bound=nothing,
        numbers=numbers,
        remarks=read.remarks,
    )


def _remarks(tree: Tree, chain: tuple[UrdfJoint, ...]) -> tuple[str, ...]:
    """What was decided that the file does not say."""
    result = []
    still = held(tree, chain)
    if still:
        names = ", ".join(f"{joint.name} ({joint.kind})" for joint in still)
        result.append(f"Joints that are not of the chain are held at their zero position: {names}")
    unlimited = [joint.name for joint in chain if joint.effort is None]
    if unlimited:
        result.append(f"No torque limit is known where the file has none or 0: {', '.join(unlimited)}")
    moved = moved_links(tree, chain)
    strange = impossible(moved)
    if strange:
        result.append(
            "No body has the inertia that the file gives, a principal moment above the sum of the others: "
            f"{', '.join(strange)}"
        )
    massless = [link.name for link in moved if link.mass == 0 and any(link.inertia)]
    if massless:
        result.append(f"No body has an inertia and no mass, as the file gives: {', '.join(massless)}")
    return tuple(result)
