"""Which gains hold the conditions that must hold: the gate."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lyapcheck.answers.gate.answer import GateAnswer
from lyapcheck.answers.gate.judge import GateResult, judged_sets
from lyapcheck.control.gains import DECIDING, GainFile, gain_file_of
from lyapcheck.control.limits import ArmLimits
from lyapcheck.files.loop import NOTHING, LoopEntry

if TYPE_CHECKING:
    from lyapcheck._types import Progress

__all__ = ["DECIDING", "GateAnswer", "GateResult", "gate"]


def gate(
    gain_file: GainFile | str | Path,
    robot: str | None = None,
    deciding: Sequence[str] | None = None,
    gamma: str = "true",
    strict: bool = False,
    arms: dict[str, ArmLimits] | None = None,
    on_progress: Progress | None = None,
    loop: LoopEntry = NOTHING,
    within: Fraction | None = None,
) -> GateAnswer:
    """Decide (10), (10p) and (19) for every gain set of a file, and the certificates that are asked for.

    Args:
        gain_file: what ``read_gain_file`` returned, or the path of a gain file.
        robot: an arm that replaces the one the file names.
        deciding: the conditions that must hold; if missing those of each set, else (10p) and (19).
        gamma: ``true`` or ``printed`` (the paper's rounded γ, two of which are too small).
        strict: whether what is undecided counts as a failure.
        arms: arms that need not be read again, by name, for many files on one arm; those read now are added.
        on_progress: receives the share done of the certificates that are asked for, and which is looked for.
        loop: how a computer runs the gains, before what their file and that of the arm say of it.
        within: look, where no period is shown, for a proof from rest within so many degrees at the one asked.

    Raises:
        InputError: no arm to judge the gains by, no printed γ for an m, or an unknown condition.

    Soundness: every verdict is that of ``lyapcheck.check.verify`` on a statement with a proof, which
        ``lyapcheck.answers.gate.certificates`` writes as a certificate; where there is no proof it is
        ``undecided``.

    References: (10), (19) and Section 4 of reyes2019family.

    Example:
        >>> from lyapcheck import paper_gain_file
        >>> [result.verdict for result in gate(paper_gain_file("table2"))]
        ['accepted', 'rejected', 'rejected']
    """
    file = gain_file_of(gain_file)
    more: dict[str, Any] = {"on_progress": on_progress, "loop": loop, "within": within}
    return GateAnswer(judged_sets(file, robot, deciding, gamma, strict, arms, **more))
