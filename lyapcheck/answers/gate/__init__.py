"""Which gains hold the conditions that must hold: the gate."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from lyapcheck.answers.gate.answer import GateAnswer
from lyapcheck.answers.gate.judge import GateResult, judged_sets
from lyapcheck.control.gains import DECIDING, GainFile, gain_file_of
from lyapcheck.control.limits import Limits
from lyapcheck.files.loop import NOTHING, LoopEntry

if TYPE_CHECKING:
    from lyapcheck._types import Progress

__all__ = ["DECIDING", "GateAnswer", "GateResult", "gate"]


def gate(
    gain_file: GainFile | str | Path,
    robot: str | None = None,
    deciding: Sequence[str] | None = None,
    strict: bool = False,
    arms: dict[str, Limits] | None = None,
    on_progress: Progress | None = None,
    loop: LoopEntry = NOTHING,
) -> GateAnswer:
    """Decide (10), (10p) and (19) for every gain set of a file, and the certificates that are asked for.

    Args:
        gain_file: a gain file or its path.
        robot: an arm that replaces the arm of the file.
        deciding: the conditions that must hold. Default: the conditions of each set, else (10p) and (19).
        strict: True counts undecided as a failure.
        arms: arms already read, by name, for many files on one arm. Arms that are read now are added.
        on_progress: receives the fraction done, and the certificate in search.
        loop: the sampled loop, which replaces the loop in the files.

    Raises:
        InputError: no arm to judge the gains by, or an unknown condition.

    Soundness: ``lyapcheck.check.verify`` makes every verdict, on a statement with a proof.
        ``lyapcheck.answers.gate.certificates`` writes both as a certificate. Without a proof the verdict is
        ``undecided``.

    References: (10), (19) and Section 4 of reyes2019family.

    Example:
        >>> from lyapcheck import paper_gain_file
        >>> [result.verdict for result in gate(paper_gain_file("table2"))]
        ['accepted', 'rejected', 'rejected']
    """
    file = gain_file_of(gain_file)
    return GateAnswer(judged_sets(file, robot, deciding, strict, arms, on_progress=on_progress, loop=loop))
