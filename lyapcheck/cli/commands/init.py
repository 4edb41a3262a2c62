"""``lyapcheck init``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from lyapcheck.cli.show import open_folder, write_whole
from lyapcheck.errors import InputError, Problem, argument_error
from lyapcheck.verdicts import Exit

if TYPE_CHECKING:
    from lyapcheck.cli.parser import Parser

GAINS, ARM = "gains.toml", "arm.toml"
GAIN_TEXT = """\
# Gains for lyapcheck gate. Every decimal is read exactly.
robot = "arm.toml"              # arm file or URDF file, or the name of an arm, for example ur5

[[gains]]
name = "first"
m = 1                           # order of h_m, where h_1 is tanh
kp = [22, 10]                   # N·m, one per joint
kv = [12, 3]                    # N·m
condition = ["10p", "scalar"]   # conditions: torque limits, and a stability proof for this arm
# Gains for your arm: lyapcheck tune arm.toml --m 1 --overshoot 5 --settle 2.5 --rest-error 3 --out tuned.toml
"""
ARM_TEXT = """\
# Two-joint arm in a vertical plane. Edit the numbers. Mark a number that no data sheet has:
#   viscous = { value = 0.3, assumed = true, low = 0.2, high = 0.5, note = "why" }
# Have a URDF file? Run lyapcheck robot arm.urdf --export arm.toml instead.
title = "My arm"
gravity = [0, 0, -9.81]         # m/s², in the base frame

[[links]]                       # one for each joint and the link that it moves, base first
name = "shoulder"
axis = [0, 1, 0]                # axis of rotation
origin = [0, 0, 0]              # position of the joint, seen from the previous joint or the base, m
mass = 6                        # kg
com = [0, 0, -0.1]              # centre of mass, seen from the joint, m
inertia = 0.12                  # about the centre of mass, kg·m². If axes are not parallel, a table:
#   inertia = { ixx = 0.12, iyy = 0.12, izz = 0.02 }   and ixy, ixz, iyz if not zero
viscous = 0.5                   # viscous friction, N·m·s/rad
coulomb = 1                     # dry friction, N·m, optional
torque_limit = 80               # motor limit, N·m, optional

[[links]]
name = "elbow"
axis = [0, 1, 0]
origin = [0, 0, -0.3]
mass = 2
com = [0, 0, -0.05]
inertia = 0.02
viscous = 0.3
coulomb = 0.4
torque_limit = 20
"""


def arguments(parser: Parser) -> None:
    """What the command takes."""
    about = "Folder for the files. Default: this folder."
    parser.add_argument("folder", metavar="DIR", nargs="?", type=Path, default=Path(), help=about)
    about = "Convert the gains in this YAML (ros2_control), JSON or CSV file with a header."
    parser.add_argument("--from", metavar="FILE", type=Path, dest="source", help=about)
    parser.add_argument("--arm", metavar="ROBOT", dest="robot", help="Arm of these gains, by name or file.")
    parser.add_choice_of_arm()


def run(folder: Path, source: Path | None, robot: str | None) -> Exit:
    """Write a gain file and an arm file to edit, gains.toml and arm.toml.

    Existing files stay as they are. With --from and --arm the command writes a gain file only. Its gains have
    the slope of the other program's gains at the goal, reduced to (10p).

    Exit code 0: the files are written, 2: a file exists already, or the folder cannot be written.

    Examples:
      lyapcheck init bench && lyapcheck gate bench/gains.toml
      lyapcheck tune arm.urdf --out gains.toml    instead, for a URDF file
      lyapcheck init --from pid.yaml --arm arm.urdf
    """
    if (source is None) != (robot is None):
        missing = "--arm" if robot is None else "--from"
        repair = "write --from pid.yaml --arm arm.urdf"
        raise argument_error(missing, "", "is missing: gains are brought over for an arm", repair)
    place = open_folder("DIR", folder)
    texts = {GAINS: GAIN_TEXT, ARM: ARM_TEXT}
    if source is not None and robot is not None:
        from lyapcheck.answers.tune.gain_file import brought_file

        texts = {GAINS: brought_file(source, robot, place)}
    there = [name for name in texts if (place / name).exists()]
    if there:
        rule, repair = "is there already", "name another folder, or move it away"
        raise InputError([Problem("argument", None, str(place / name), "", rule, repair) for name in there])
    for name, text in texts.items():
        write_whole(place / name, text)
        print(f"{place / name}")
    print(f"next: lyapcheck gate {place / GAINS}")
    return Exit.PROVED
