"""Certificates as conditions of the gate: gains are accepted where some ε₀ > 0 is proved for the arm.

    scalar   dV/dt < 0 at every state but the origin, from norms of M and C alone
    global   the same by boxes or by bounds along the links, which prove a larger ε₀
    lasalle  M(q) ≻ 0, which is all that LaSalle's theorem asks of an arm, with or without friction

The first two are statements ``Decreasing``, M(q) ≻ 0 included, accepted where ``lyapcheck.check.verify``
proves them. A search that finds nothing refutes nothing: there is no ``rejected`` here.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import partial
from typing import TYPE_CHECKING

from lyapcheck._types import Progress, part, silent
from lyapcheck.answers.gate.folder import shown_by
from lyapcheck.answers.gate.otherwise import LASALLE, decided, friction_of, lasalle, small, unknown_function
from lyapcheck.asked import decreasing, viscous_of
from lyapcheck.check.kinds.chain_decreasing import ChainDecreasing
from lyapcheck.check.kinds.decreasing import Decreasing
from lyapcheck.check.statement import Ends
from lyapcheck.control.conditions import Check
from lyapcheck.control.gains import GainSet
from lyapcheck.control.judgement import judged_statement
from lyapcheck.errors import PACKAGES, installed, repair
from lyapcheck.robots import Number, RobotModel
from lyapcheck.robots.dynamics import FEW_JOINTS, Chain, TooManyTerms
from lyapcheck.search.controlled_arm import ChainProof, ControlledArm, DecreaseProof, unphysical
from lyapcheck.search.scalar_program import REFUSED, chain_epsilon, norm_epsilon

if TYPE_CHECKING:
    from lyapcheck.check.certificate import Certificate
    from lyapcheck.check.statement import Statement

MAX_BOXES = 5_000
"""For each attempt: any ε₀ will do, so the boxes of a second or two are enough."""
CEILINGS = (64, 16, 8, 4, 2)
"""Times the ε₀ of norms: where branch and bound begins, from above."""

GLOBAL = "global"
SEARCHES = ("numpy", "scipy", "casadi")
"""What the search for it asks; the other certificates are found without."""

_NOMINAL = "certificates are about the arm at its nominal numbers"
_RANGED = "certificates are about the arm for all values of its ranges"
_TOO_MANY = f"over ranges an arm of more than {FEW_JOINTS} joints has no certificate of this kind"
_TOO_LONG = "M(q) of these links is too long to be written out; --condition lasalle does without"
_NO_ARM = "needs the arm itself, and not only its limits; name one with robot = …"
_OTHER_FRICTION = (
    "[bounds] viscous_min replaces λmin(B), but the friction of every joint is needed; remove it"
)


class Prover:
    """The certificates of gain sets on one arm, at its nominal numbers or over its ranges.

    Args:
        model: the arm; ``None`` where the gain file gives its limits only.
        viscous_min: λmin(B) that replaces the arm's, N·m·s/rad.
        ranges: for all values of what is uncertain about the arm, and not for the nominal ones.
        kept: certificates that are judged before anything is searched.
    """

    def __init__(
        self,
        model: RobotModel | None,
        viscous_min: Fraction | None = None,
        ranges: bool = False,
        kept: Sequence[Certificate] = (),
    ) -> None:
        self.model, self.viscous_min, self.ranges, self.kept = model, viscous_min, ranges, kept

    def check(self, name: str, gains: GainSet, progress: Progress = silent) -> Check:
        """The check of one certificate: its value is the ε₀ proved.

        Args:
            name: of the certificate.
            gains: what it is about.
            progress: receives the share done; its notes follow a few words about what is looked for.

        Soundness: that of ``lyapcheck.check.verify``.
        """
        if self.model is None:
            return Check(name, reason=_NO_ARM)
        if name == GLOBAL:
            known = self._from_folder(name, gains, self.model)
            if known is not None:
                return known
        progress(0.0, "")
        controlled = ControlledArm(gains, self.model, self.ranges)
        if self.ranges and self.model.n > FEW_JOINTS and (name == LASALLE or not controlled.chains):
            return Check(name, reason=_TOO_MANY)
        nominal = self.model.fixed()
        along = name == LASALLE and not small(nominal) and nominal.chain is not None  # looks at M(q) itself
        reason = unknown_function(gains) or ("" if along else self._unphysical(controlled))
        proof: DecreaseProof | ChainProof | None = None
        if not reason and name == LASALLE:
            return lasalle(self.model, self.ranges)
        if reason == _TOO_LONG and controlled.ranged.chain is not None:
            viscous = viscous_of(self.model, self.viscous_min, nominal=not self.ranges)
            proof, reason = self._along_links(gains, controlled.ranged.chain, viscous)
        elif not reason:
            friction = friction_of(self.model, self.viscous_min, self.ranges)
            proof, reason = (
                norm_epsilon(controlled, friction)
                if name == "scalar"
                else self._global(controlled, self.model.viscous, progress)
            )
        if proof is None:
            return Check(name, reason=reason)
        judged = judged_statement(proof.statement, [proof.certificate])
        return decided(name, gains, self.model, proof.eps0, judged, self.viscous_min, self.ranges)

    @property
    def assumptions(self) -> tuple[str, ...]:
        """What is taken for granted about the arm, and that its numbers are nominal."""
        if self.model is None:
            return ()
        return (_RANGED if self.ranges else _NOMINAL, *self.model.assumptions)

    def _from_folder(self, name: str, gains: GainSet, model: RobotModel) -> Check | None:
        """The largest ε₀ of the certificates at hand; with neither these nor a search why there is none."""
        found = [
            Check(name, judgement=judged, value=judged.statement.eps0, promise=promise)  # type: ignore[attr-defined]
            for promise, judged in shown_by(self.kept, partial(self._asked, gains, model))
        ]
        lacking = next((one for one in SEARCHES if not installed(one)), None)
        if not found and lacking is not None:
            found = [
                Check(name, reason=f"needs {PACKAGES[lacking]}, which is not installed; {repair(lacking)}")
            ]
        return max(found, key=lambda check: check.value or 0, default=None)

    def _asked(self, gains: GainSet, model: RobotModel, stated: Statement) -> Statement | None:
        """That V falls for these gains, with the ε₀ and the weights of a statement."""
        if not isinstance(stated, Decreasing | ChainDecreasing):
            return None
        weights = stated.coupling if isinstance(stated, Decreasing) else ()
        try:
            asked = decreasing(gains, model, stated.eps0, weights, nominal=not self.ranges)
        except TooManyTerms:
            return None
        return replace(asked, viscous=viscous_of(model, self.viscous_min, nominal=not self.ranges))

    def _unphysical(self, controlled: ControlledArm) -> str:
        """Why there is nothing to prove on this arm, looked at once."""
        if self._fault is None:
            try:
                self._fault = unphysical(controlled)
            except TooManyTerms:
                self._fault = _TOO_LONG
        return self._fault

    _fault: str | None = None

    @staticmethod
    def _along_links(
        gains: GainSet, chain: Chain, viscous: tuple[Ends, ...]
    ) -> tuple[ChainProof | None, str]:
        """Scalar and global alike, by bounds along the links."""
        lacking = next((one for one in ("numpy", "scipy", "clarabel") if not installed(one)), None)
        if lacking is not None:
            return None, f"needs {PACKAGES[lacking]}, which is not installed; {repair(lacking)}"
        return chain_epsilon(gains, chain, viscous)

    def _global(
        self, controlled: ControlledArm, viscous: Sequence[Number], progress: Progress
    ) -> tuple[DecreaseProof | None, str]:
        if self.viscous_min not in (None, min(number.value for number in viscous)):
            return None, _OTHER_FRICTION
        coarse, reason = norm_epsilon(controlled)
        if coarse is None:
            return None, reason
        return next(_proofs(controlled, coarse, progress), None), REFUSED


def _proofs(controlled: ControlledArm, coarse: DecreaseProof, progress: Progress) -> Iterator[DecreaseProof]:
    """Proofs that the checker has accepted, of the largest ε₀ that can be hoped for first."""
    from lyapcheck.search.certified import certified_epsilon

    step = 1 / len(CEILINGS)
    for number, ceiling in enumerate(CEILINGS):
        advance = part(progress, number * step, (number + 1) * step, ", ")
        result = certified_epsilon(controlled, ceiling * coarse.loop.eps0, MAX_BOXES, on_progress=advance)
        if result.proof is not None:
            yield result.proof
    yield coarse
