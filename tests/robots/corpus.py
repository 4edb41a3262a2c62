"""Every URDF file of example-robot-data: the share that loads, and M and g against Pinocchio.

``make test-robots`` runs it, which writes ``reports/robots.md``. A file counts where it loads as it is, or by
what the message about it advises.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pinocchio as pin

from lyapcheck import robots
from lyapcheck.errors import InputError
from lyapcheck.robots.numeric import NumericModel
from tests.robots.against_pinocchio import configuration, data_folder, with_right_angles

SHARE, TOLERANCE, STATES, STEPS = 0.9, 1e-9, 5, 3
TABLE = Path(__file__).parents[2] / "reports" / "robots.md"
HEAD = "| file | joints | how | largest difference of M and g |\n|---|---|---|---|\n"
ADVICE = re.compile(r"((?:--(?:base|tip|fixed) \S+ )+)\(in an arm file")


def test_robots_of_the_corpus_load_and_move_as_pinocchio_says() -> None:
    rows, loaded, known, wrong = [], 0, 0, []
    for path in sorted(data_folder().rglob("*.urdf")):
        other = _pinocchio(path)
        arm, how = _loaded(path)
        known += other is not None
        loaded += arm is not None and other is not None
        gap = None if arm is None or other is None else difference(arm, other)
        wrong += [path.name] if gap is not None and gap > TOLERANCE else []
        other_numbers = [] if arm is None or other is None else numbers_that_differ(arm, other)
        wrong += [f"{path.name} {name}" for name in other_numbers]
        joints = "" if arm is None else str(arm.n)
        rows.append(f"| {path.name} | {joints} | {how} | {'' if gap is None else f'{gap:.0e}'} |\n")
    share = (
        f"{loaded} of the {known} files load that Pinocchio reads and that have masses. "
        "Torque limits, damping and dry friction are equal in all of them.\n\n"
    )
    TABLE.write_text(f"# Arms of example-robot-data\n\n{share}{HEAD}{''.join(rows)}", encoding="utf-8")
    assert wrong == []
    assert loaded >= SHARE * known


def _pinocchio(path: Path) -> pin.Model | None:
    try:
        model = pin.buildModelFromXML(with_right_angles(path.read_text(encoding="utf-8", errors="replace")))
    except ValueError:
        return None
    return model if any(inertia.mass > 0 for inertia in list(model.inertias)[1:]) else None


def _loaded(path: Path) -> tuple[robots.RobotModel | None, str]:
    choice, said = "", ""
    for step in range(STEPS):
        try:
            return robots.load(f"{path}{choice}"), f"as advised: `{said}`" if step else "as it is"
        except InputError as error:
            advice = ADVICE.search(str(error))
            if advice is None:
                return None, str(error).rpartition(path.name)[2].replace("|", "/")
            said = advice[1].strip()
            words = re.findall(r"--(base|tip|fixed) (\S+)", said)
            choice = "#" + "&".join(f"fixed.{x}" if key == "fixed" else f"{key}={x}" for key, x in words)
    return None, f"not by `{said}`"


def difference(arm: robots.RobotModel, model: pin.Model) -> float:
    """The largest of M and g at some states, by the largest entry of M; other joints stand at zero."""
    data, mine, rng = model.createData(), NumericModel(arm), np.random.default_rng(1)
    joints = [model.joints[model.getJointId(name)] for name in arm.joints]
    order, worst = [joint.idx_v for joint in joints], 0.0
    for q in rng.uniform(-2, 2, (STATES, arm.n)):
        there = configuration(model, joints, q)
        upper = np.triu(pin.crba(model, data, there))
        mass = (upper + np.triu(upper, 1).T)[np.ix_(order, order)]
        gravity = pin.computeGeneralizedGravity(model, data, there)[order]
        gaps = np.max(np.abs(mine.mass(q) - mass)), np.max(np.abs(mine.gravity(q) - gravity))
        worst = max(worst, *(float(gap / np.max(np.abs(mass))) for gap in gaps))
    return worst


def numbers_that_differ(arm: robots.RobotModel, model: pin.Model) -> list[str]:
    """Torque limits, damping and dry friction that are not those of Pinocchio, by joint; none is 0 there."""
    wrong = []
    for k, name in enumerate(arm.joints):
        place = model.joints[model.getJointId(name)].idx_v
        limit, dry = arm.torque_limit[k], arm.coulomb[k]
        theirs = model.effortLimit[place], model.damping[place], model.friction[place]
        known = 0 < theirs[0] < np.finfo(float).max  # no effort, or an endless one, is no limit
        ours = (0.0 if limit is None else float(limit.value), float(arm.viscous[k].value))
        ours = (*ours, 0.0 if dry is None else float(dry.value))
        if ours != (theirs[0] if known else 0.0, *theirs[1:]):
            wrong.append(f"{name}: {ours} is not {theirs}")
    return wrong
