"""The certificates of bounds: how far from the goal dry friction lets an arm rest."""

from __future__ import annotations

from typing import TYPE_CHECKING

from lyapcheck.certificate import Certificate
from lyapcheck.check.certificate import About
from lyapcheck.check.kinds.resting import AtBounds
from lyapcheck.files.names import file_stem

if TYPE_CHECKING:
    from lyapcheck.answers.bounds.compare import BoundsComparison

PROOF = "bounds"


def certificates(result: BoundsComparison) -> dict[str, Certificate]:
    """The certificate by its file name; none where nothing was accepted."""
    if result.promise is None:
        return {}
    name, gains = f"{result.gains.name}.resting", result.gains
    says = f"how far from the goal it can rest: {gains.name} on {result.robot}"
    about = About(name, says, gains.m, len(result.joints), PROOF)
    made = Certificate(about, result.promise.shown.statement, "proved", "enclosure", AtBounds())
    return {f"{file_stem(gains.name)}.resting.json": made}
