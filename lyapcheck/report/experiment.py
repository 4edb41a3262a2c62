"""What the study of the printed experiment found, for the gains and the arm of a report."""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import replace
from hashlib import sha256
from importlib import resources
from pathlib import Path
from typing import TYPE_CHECKING

from lyapcheck.report.plain import read
from lyapcheck.report.study import StudyRow
from lyapcheck.simulate.printed import PRINTED, printed_entry

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots import RobotModel


def printed_experiment(gain_sets: Iterable[GainSet], model: RobotModel) -> StudyRow | None:
    """The part of the study that is about these gains, under their names.

    Args:
        gain_sets: those of the report; what the paper did not run is left out.
        model: the arm.

    Returns:
        None where the paper ran none of the gains on this arm, or where the arm is another by now.
    """
    chosen = {entry.m: one.name for one in gain_sets if (entry := printed_entry(one, model))}
    if not chosen:
        return None
    written = json.loads(study_file("printed_experiment").read_text(encoding="utf-8"))
    if written.pop("arm") != arm_digest(model):
        return None
    study = read(StudyRow, written)
    sets = tuple(replace(one, name=chosen[one.m]) for one in study.sets if one.m in chosen)
    return replace(study, sets=sets, together=study.together if len(sets) == len(PRINTED) else None)


def arm_digest(model: RobotModel) -> str:
    """Of all numbers of an arm: a study of other numbers is one of another arm."""
    numbers = sorted((name, number.value, number.bounds) for name, number in model.numbers.items())
    return sha256(repr((model.name, model.joints, numbers)).encode()).hexdigest()


def study_file(name: str) -> Path:
    """The results of a study: in an installed package, or in a checkout."""
    package = Path(str(resources.files("lyapcheck")))
    inside = package / "report" / f"{name}.json"
    return inside if inside.is_file() else package.parent / "studies" / name / "results.json"
