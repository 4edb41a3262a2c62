"""Properties 2.1–2.8 of an arm, decided by the claims of the paper's own proof script."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from lyapcheck.answers.check import ClaimResult, ProofResult
from lyapcheck.answers.check.run import ProposedProof, proposed_proof
from lyapcheck.answers.robot.judged import about_ranges
from lyapcheck.certificate import Certificate
from lyapcheck.claims.decision import Decision, undecided
from lyapcheck.promise import Promise
from lyapcheck.robots import RobotModel
from lyapcheck.verdicts import Verdict

IDS = tuple(f"2.{k}" for k in range(1, 9))
FRICTION = "2.7"
"""The property of B, whose statement has no ranges; the others are about M, C and g."""
_STATE_IT = "state it in an arm file that names this URDF"


@dataclass(frozen=True)
class PropertyResult:
    """One property with what was found out about it.

    Args:
        over: the promise that it holds for all values of the ranges; none where that is not shown.
    """

    id: str
    statement: str
    finding: Decision
    over: Promise | None = None

    @property
    def verdict(self) -> Verdict:
        """The verdict."""
        return self.finding.verdict

    @property
    def word(self) -> str:
        """The verdict as answers say it."""
        return self.finding.word


def proposed_properties(model: RobotModel) -> ProposedProof:
    """What searches propose for the eight properties."""
    return proposed_proof("published.py", [1], model, only=IDS)


def properties(
    model: RobotModel, result: ProofResult
) -> tuple[tuple[PropertyResult, ...], Mapping[str, Certificate]]:
    """The eight properties as they are decided, and their certificates by file name.

    Friction that nobody has stated is not 0: then 2.7 is open, whatever follows for 0.
    """
    rows = {
        row.id: PropertyResult(row.id, row.statement, row.decision, _over(row, model))
        for row in result.claims
    }
    made = dict(result.certificates)
    missing = _without_friction(model, assumed=True)
    if missing:
        finding = undecided(f"no viscous friction is known of {missing}; {_STATE_IT}", "reading of the file")
        rows[FRICTION] = PropertyResult(FRICTION, rows[FRICTION].statement, finding)
        made.pop("2.7.json", None)
    elif none := _without_friction(model, assumed=False):
        reason = f"the viscous friction of {none} is 0 in the file; where that means unknown, {_STATE_IT}"
        rows[FRICTION] = replace(rows[FRICTION], finding=replace(rows[FRICTION].finding, reason=reason))
    return tuple(rows[name] for name in IDS), made


def _over(row: ClaimResult, model: RobotModel) -> Promise | None:
    numbers = model.viscous if row.id == FRICTION else model.parameters.values()
    return about_ranges(row.stated, row.decision, numbers, model)


def _without_friction(model: RobotModel, assumed: bool) -> str:
    """The joints whose viscous friction is 0 because nobody stated it, or because the file says so."""
    rows = zip(model.joints, model.viscous, strict=True)
    return ", ".join(joint for joint, number in rows if number.value == 0 and number.assumed is assumed)
