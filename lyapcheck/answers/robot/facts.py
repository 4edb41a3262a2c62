"""What was decided and certified about an arm, as data."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from lyapcheck.answers.robot.certified import CertifiedBounds
    from lyapcheck.answers.robot.properties import PropertyResult
    from lyapcheck.certificate import Certificate
    from lyapcheck.constants import ConstantResult
    from lyapcheck.robots import RobotModel


@dataclass(frozen=True)
class ArmFacts:
    """An arm with what was decided and certified about it; ``extent`` says for which of its values.

    Args:
        model: the arm.
        properties: 2.1 to 2.8.
        constants: from both sides, in floating point.
        prints: claims about C and g as the source prints them; they do not touch the arm, whose C and g
            follow from M and the potential.
        certified: by the name of a constant its ends that a certificate shows.
        certificates: of all that is decided, by file name.
        path: of the file that describes the arm; empty for a built-in one.
    """

    model: RobotModel
    properties: tuple[PropertyResult, ...]
    constants: tuple[ConstantResult, ...]
    prints: tuple[PropertyResult, ...] = ()
    certified: Mapping[str, CertifiedBounds] = field(default_factory=dict)
    certificates: Mapping[str, Certificate] = field(default_factory=dict)
    path: str = ""
