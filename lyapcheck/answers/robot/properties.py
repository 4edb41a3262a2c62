"""Properties 2.1–2.8 of an arm, decided by the claims of the paper's own proof script."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from lyapcheck.answers.check import ProofResult
from lyapcheck.answers.check.run import ProposedProof, proposed_proof
from lyapcheck.certificate import Certificate
from lyapcheck.claims.decision import Decision, undecided
from lyapcheck.robots import RobotModel
from lyapcheck.verdicts import Verdict

IDS = tuple(f"2.{k}" for k in range(1, 9))
_STATE_IT = "state it in an arm file that names this URDF"


@dataclass(frozen=True)
class PropertyResult:
    """One property with what was found out about it."""

    id: str
    statement: str
    finding: Decision

    @property
    def verdict(self) -> Verdict:
        """The verdict."""
        return self.finding.verdict


def proposed_properties(model: RobotModel) -> ProposedProof:
    """What searches propose for the eight properties."""
    return proposed_proof("published.py", [1], model, only=IDS)


def properties(
    model: RobotModel, result: ProofResult
) -> tuple[tuple[PropertyResult, ...], Mapping[str, Certificate]]:
    """The eight properties as they are decided, and their certificates by file name.

    Friction that nobody has stated is not 0: then 2.7 is open, whatever follows for 0.
    """
    rows = {row.id: PropertyResult(row.id, row.statement, row.decision) for row in result.claims}
    made = dict(result.certificates)
    missing = _without_friction(model, assumed=True)
    if missing:
        finding = undecided(f"no viscous friction is known of {missing}; {_STATE_IT}", "reading of the file")
        rows["2.7"] = PropertyResult("2.7", rows["2.7"].statement, finding)
        made.pop("2.7.json", None)
    elif none := _without_friction(model, assumed=False):
        reason = f"the viscous friction of {none} is 0 in the file; where that means unknown, {_STATE_IT}"
        rows["2.7"] = replace(rows["2.7"], finding=replace(rows["2.7"].finding, reason=reason))
    return tuple(rows[name] for name in IDS), made


def _without_friction(model: RobotModel, assumed: bool) -> str:
    """The joints whose viscous friction is 0 because nobody stated it, or because the file says so."""
    rows = zip(model.joints, model.viscous, strict=True)
    return ", ".join(joint for joint, number in rows if number.value == 0 and number.assumed is assumed)
