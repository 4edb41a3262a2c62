"""What an engineer asks of gains at the bench: overshoot, settling, torque, rest under dry friction."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from lyapcheck.errors import InputError, Problem
from lyapcheck.output.digits import at_most

if TYPE_CHECKING:
    from lyapcheck.simulate.task import Task

NAMES = {
    "overshoot": "overshoot",
    "settle": "settling time",
    "peak_share": "peak torque",
    "rest_error": "rest error",
}
"""The wishes in words."""
BY_19, BY_PROOF = "19", "proof"
MOST = 1e6
"""Per cent, s and degrees; who asks for more asks for nothing."""
WAYS = (BY_19, BY_PROOF)
"""How stability is to be shown: by (19), or by a proof for the arm that does without."""


@dataclass(frozen=True)
class Wishes:
    """Upper bounds that hold for every joint and every motion; ``None`` where nothing is asked.

    Args:
        overshoot: per cent of the joint's step.
        settle: s until the joint stays within 2 % of its step.
        peak_share: of the motor's torque limit, in (0, 1].
        rest_error: degrees from the goal at which dry friction may hold the joint.
    """

    overshoot: float | None = None
    settle: float | None = None
    peak_share: float | None = None
    rest_error: float | None = None

    def __post_init__(self) -> None:
        problems = []
        for name, value in self.given.items():
            top = 1.0 if name == "peak_share" else MOST
            if not 0 < value <= top:
                rule = f"must be above 0, up to {top:g}"
                option = "--" + name.replace("_", "-")
                problems.append(Problem("argument", None, option, f"{value:g}", rule, "correct the value"))
        if problems:
            raise InputError(problems)

    @property
    def given(self) -> dict[str, float]:
        """What is asked, by name."""
        result = {name: getattr(self, name) for name in NAMES}
        return {name: value for name, value in result.items() if value is not None}

    def text(self) -> str:
        """What is asked, in one line."""
        forms = {
            "overshoot": "overshoot ≤ {} %",
            "settle": "settled (2 %) within {} s",
            "peak_share": "≤ {} of each torque limit",
            "rest_error": "dry friction leaves ≤ {}°",
        }
        return "; ".join(forms[name].format(at_most(value, 6)) for name, value in self.given.items())


@dataclass(frozen=True)
class Trials:
    """What gains are tried on: motions from rest to rest, and how stability is to be shown."""

    wishes: Wishes
    tasks: tuple[Task, ...]
    ways: tuple[str, ...] = WAYS
    digits: int = 3
