"""Proofs of stability as conditions of the gate: gains are accepted where one is proved for the arm.

    scalar   dV/dt < 0 at every state but the origin with some ε₀ > 0, from norms of M and C alone
    global   the same by boxes or by bounds along the links, which prove a larger ε₀
    lasalle  M(q) ≻ 0. With the energy as V, dV/dt = −wᵀK_v h(w) − wᵀB w ≤ 0, and where it stays 0 the arm
             rests, so K_p h(e) = 0 and e = 0: the origin is globally asymptotically stable for all positive
             gains, with or without friction

``lyapcheck.check.verify`` makes each verdict. A search that finds nothing refutes nothing: there is no
``rejected`` here. Scalar and lasalle cost milliseconds on most arms and load nothing heavy.

References: (11)-(15) of reyes2019family; LaSalle's theorem, khalil2002nonlinear, corollary 4.2.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache, partial
from typing import TYPE_CHECKING

from lyapcheck._types import Progress, part, silent
from lyapcheck.asked import decreasing, definite, viscous_of
from lyapcheck.control.conditions import ACCEPTED, Check
from lyapcheck.control.judgement import JudgedStatement, judged_statement, shown_by
from lyapcheck.errors import InputError, without
from lyapcheck.family.base import named
from lyapcheck.promise import promised
from lyapcheck.robots.dynamics import FEW_JOINTS, TooManyTerms

if TYPE_CHECKING:
    from fractions import Fraction

    from lyapcheck.check.certificate import Certificate
    from lyapcheck.check.statement import Statement
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots import RobotModel
    from lyapcheck.search.controlled_arm import ChainProof, ControlledArm, DecreaseProof

SCALAR, GLOBAL, LASALLE = "scalar", "global", "lasalle"
MOST_TERMS = 2000
"""Terms of M(q): the proof for an arm with more takes seconds, and is left to those who ask for it."""
MAX_BOXES = 5_000
"""For each attempt: any ε₀ will do, so the boxes of a second or two are enough."""
CEILINGS = (64, 16, 8, 4, 2)
"""Times the ε₀ of norms: where branch and bound begins, from above."""
SEARCHES = ("numpy", "scipy", "casadi")
"""What the search for the global proof asks; the others are found without."""

_NOMINAL = "certificates are about the arm at its nominal numbers"
_RANGED = "certificates are about the arm for all values of its ranges"
_TOO_MANY = f"over ranges an arm of more than {FEW_JOINTS} joints has no certificate of this kind"
_TOO_LONG = "M(q) of these links is too long to be written out; --condition lasalle does without"
_NO_ARM = "needs the arm itself, not only its limits; name one with robot = …"
_OTHER_FRICTION = (
    "[bounds] viscous_min replaces λmin(B), but the friction of every joint is needed; remove it"
)


def unknown_function(gains: GainSet) -> str:
    """Why nothing is known of the h of a gain set, as that x h(x) > 0; empty where the checker knows h."""
    family = named(gains.family, gains.m)
    if not family.bounded:  # PD: h(x) = x
        return "" if family.name == "linear" else f"the checker knows no function {family.name!r}"
    try:
        _ = family.checked
    except InputError as error:
        return str(error)
    return ""


def small(fixed: RobotModel) -> bool:
    """Whether M(q) of an arm without parameters is short enough for what must cost next to nothing."""
    try:
        return sum(len(entry) for row in fixed.mass for entry in row) <= MOST_TERMS
    except TooManyTerms:
        return False


@lru_cache(maxsize=8)
def positive(arm: RobotModel) -> JudgedStatement:
    """What the checker says of M(q) ≻ 0."""
    from lyapcheck.check.kinds.chain import OwnMoments
    from lyapcheck.check.kinds.inertia import MassAbove
    from lyapcheck.search.controlled_arm import mass_proof, remember

    asked = definite(arm)
    if not isinstance(asked, MassAbove):
        return judged_statement(asked, [OwnMoments()])
    remember(arm)
    return judged_statement(asked, [mass_proof(asked.mass)])


class Prover:
    """The proofs of stability of gain sets on one arm, at its nominal numbers or over its ranges.

    Args:
        model: the arm; ``None`` where the gain file gives its limits only.
        viscous_min: λmin(B) that replaces the arm's, N·m·s/rad.
        ranges: for all values of what is uncertain about the arm, and not for the nominal ones.
        kept: certificates that are judged before anything is searched.

    Soundness: that of ``lyapcheck.check.verify``; that M(q) ≻ 0 is enough is LaSalle's theorem, cited.
    """

    def __init__(
        self,
        model: RobotModel | None,
        viscous_min: Fraction | None = None,
        ranges: bool = False,
        kept: Sequence[Certificate] = (),
    ) -> None:
        self.model, self.viscous_min, self.ranges, self.kept = model, viscous_min, ranges, kept
        self._fault: str | None = None

    @property
    def assumptions(self) -> tuple[str, ...]:
        """What is taken for granted about the arm, and that its numbers are nominal."""
        if self.model is None:
            return ()
        return (_RANGED if self.ranges else _NOMINAL, *self.model.assumptions)

    def check(self, name: str, gains: GainSet, progress: Progress = silent) -> Check:
        """The check of one condition: its value is the ε₀ proved.

        Args:
            name: of the condition.
            gains: what it is about.
            progress: receives the share done; its notes follow a few words about what is looked for.
        """
        from lyapcheck.search.controlled_arm import ControlledArm

        model = self.model
        if model is None:
            return Check(name, reason=_NO_ARM)
        if name == GLOBAL and (known := self._from_folder(gains, model)) is not None:
            return known
        progress(0.0, "")
        controlled, over = ControlledArm(gains, model, self.ranges), self.ranges and model.n > FEW_JOINTS
        reason = _TOO_MANY if over and (name == LASALLE or not controlled.chains) else unknown_function(gains)
        if reason:
            return Check(name, reason=reason)
        found = self.lasalle(model) if name == LASALLE else self._falls(name, controlled, progress)
        return found if found.verdict == ACCEPTED else self._at_fault(controlled, found)

    def otherwise(self, gains: GainSet) -> Check | None:
        """Scalar, else lasalle, of gains that break (19); ``None`` where neither is proved at little cost."""
        from lyapcheck.search.controlled_arm import ControlledArm

        model = self.model
        if model is None or unknown_function(gains) or (self.ranges and model.n > FEW_JOINTS):
            return None
        nominal = model.fixed()
        if small(nominal):
            found = self._falls(SCALAR, ControlledArm(gains, model, self.ranges), silent)
            if found.verdict == ACCEPTED:
                return found
        elif nominal.chain is None:
            return None
        found = self.lasalle(model)
        return found if found.verdict == ACCEPTED else None

    def lasalle(self, model: RobotModel) -> Check:
        """Whether M(q) ≻ 0 is proved of an arm, for all values of its parameters or for the nominal ones."""
        arm = model if self.ranges else model.fixed()
        judged = positive(arm)
        promise, reason = promised(definite(arm), judged)
        if promise is None:
            return Check(LASALLE, reason=judged.reason or reason)
        return Check(LASALLE, judgement=judged, promise=promise)

    def _falls(self, name: str, controlled: ControlledArm, progress: Progress) -> Check:
        """The check of a proof that V falls: accepted where it is about the arm that was asked about."""
        from lyapcheck.search.scalar_program import chain_epsilon, norm_epsilon

        gains, model = controlled.gains, self.model or controlled.model
        proof: DecreaseProof | ChainProof | None = None
        viscous = viscous_of(model, self.viscous_min, nominal=not self.ranges)
        if not controlled.too_long:
            proof, reason = (
                norm_epsilon(controlled, viscous) if name == SCALAR else self._global(controlled, progress)
            )
        elif (chain := controlled.ranged.chain) is None:
            reason = _TOO_LONG
        elif not (reason := without("needs", "numpy", "scipy", "clarabel")):
            proof, reason = chain_epsilon(gains, chain, viscous)
        if proof is None or proof.judged is None:
            return Check(name, reason=reason)
        asked = decreasing(gains, model, proof.eps0, nominal=not self.ranges, viscous_min=self.viscous_min)
        promise, reason = promised(asked, proof.judged)
        if promise is None:
            return Check(name, reason=reason)
        return Check(name, judgement=proof.judged, value=proof.eps0, promise=promise)

    def _at_fault(self, controlled: ControlledArm, found: Check) -> Check:
        """A check without a proof; where the arm itself is at fault that is why, looked at once."""
        from lyapcheck.search.controlled_arm import unphysical

        if self._fault is None:
            self._fault = "" if controlled.too_long else unphysical(controlled)
        return replace(found, reason=self._fault or found.reason)

    def _from_folder(self, gains: GainSet, model: RobotModel) -> Check | None:
        """The largest ε₀ of the certificates at hand; with neither these nor a search why there is none."""
        found = [
            Check(GLOBAL, judgement=judged, value=judged.statement.eps0, promise=promise)  # type: ignore[attr-defined]
            for promise, judged in shown_by(self.kept, partial(self._same_eps0, gains, model))
        ]
        if not found and (lack := without("needs", *SEARCHES)):
            return Check(GLOBAL, reason=lack)
        return max(found, key=lambda check: check.value or 0, default=None)

    def _same_eps0(self, gains: GainSet, model: RobotModel, stated: Statement) -> Statement | None:
        """The question with the ε₀ and the weights of a statement."""
        from lyapcheck.check.kinds.decreasing import Decreasing
        from lyapcheck.check.kinds.link_bounds import ChainDecreasing

        if not isinstance(stated, Decreasing | ChainDecreasing):
            return None
        own = gains, model, stated.eps0, getattr(stated, "coupling", ())
        try:
            return decreasing(*own, nominal=not self.ranges, viscous_min=self.viscous_min)
        except TooManyTerms:
            return None

    def _global(
        self, controlled: ControlledArm, progress: Progress
    ) -> tuple[DecreaseProof | ChainProof | None, str]:
        """A proof that the checker has accepted, of the largest ε₀ that can be hoped for."""
        from lyapcheck.search.certified import certified_epsilon
        from lyapcheck.search.scalar_program import REFUSED, norm_epsilon

        if self.viscous_min not in (None, min(number.value for number in controlled.model.viscous)):
            return None, _OTHER_FRICTION
        coarse, reason = norm_epsilon(controlled)
        if coarse is None:
            return None, reason
        step = 1 / len(CEILINGS)
        for number, ceiling in enumerate(CEILINGS):
            advance = part(progress, number * step, (number + 1) * step, ", ")
            result = certified_epsilon(controlled, ceiling * coarse.loop.eps0, MAX_BOXES, on_progress=advance)
            if result.proof is not None:
                return result.proof, REFUSED
        return coarse, REFUSED
