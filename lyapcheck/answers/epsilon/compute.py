"""The four ε₀ of one gain set on one arm: published, scalar, certified and falsified.

    published   the end of (18), which claims dV/dt < 0 for every smaller ε₀
    scalar      the largest ε₀ with Θ' ≻ 0, a number from norms in floating point that may lack a certificate
    certified   the largest ε₀ for which the checker accepted a proof of M ≻ 0 and dV/dt < 0 at every state
    falsified   the smallest ε₀ for which a state with dV/dt > 0 was proved

References: ``reyes2019family`` (12), (16), (18).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lyapcheck import asked
from lyapcheck._types import SEED, Progress, part, silent
from lyapcheck.answers.epsilon.forms import by_forms, proof_of
from lyapcheck.answers.epsilon.four import Refutation, findings, require_consistent
from lyapcheck.answers.epsilon.options import Options
from lyapcheck.answers.epsilon.result import EpsilonResult
from lyapcheck.check.kinds.decreasing import BoxTree
from lyapcheck.computing import computing_time
from lyapcheck.control.gains import one_gain_set
from lyapcheck.promise import Promise, promised
from lyapcheck.robots.dynamics import FEW_JOINTS
from lyapcheck.robots.registry import arm_of
from lyapcheck.search.certified import (
    MAX_BOXES,
    RESERVE,
    CertifiedEpsilon,
    certified_epsilon,
    linked_otherwise,
    links_follow,
)
from lyapcheck.search.controlled_arm import ChainProof, ControlledArm, DecreaseProof, unphysical
from lyapcheck.search.falsify import STARTS, RisingState, falsify, falsify_corners
from lyapcheck.search.scalar_program import chain_epsilon, norm_epsilon
from lyapcheck.search.weights import Effort, Weighted, usual_effort, weighted_epsilon

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots import RobotModel
    from lyapcheck.robots.plant import Plant


# --- What was found about a gain set, put together with all that follows from it.


def put_together(
    controlled: ControlledArm,
    at: ControlledArm,
    witness: RisingState | None,
    *,
    published: Fraction | None,
    scalar: Fraction | None,
    proof: DecreaseProof | ChainProof | None,
    scalar_proof: DecreaseProof | ChainProof | None,
    weighted: Weighted | None,
    reasons: Mapping[str, str],
    **more: Any,
) -> EpsilonResult:
    """What was found about a gain set, with all that follows from it.

    Args:
        controlled: gains and arm.
        at: the arm, within its ranges, that the witness is about.
        witness: of ``at``.
        published, scalar: of `EpsilonResult`.
        proof, scalar_proof, weighted: as they were found; only what answers the question is kept.
        reasons: why a number is missing, and why one of these is not kept.
        more: what else it takes that does not follow from these.

    Raises:
        Contradiction: the witness refutes a certificate.
    """
    question = controlled.gains, controlled.model, controlled.ranges
    reasons, kinds = (
        dict(reasons),
        {"certified": proof, "weighted": None if weighted is None else weighted.proof},
    )
    promises: dict[str, Promise | None] = {}
    for name, one in kinds.items():
        promises[name], why = answers(one, *question)
        reasons |= {name: why} if why else {}
    promise, by_norms = promises["certified"], answers(scalar_proof, *question)[0]
    certified = None if promise is None or proof is None else proof.eps0
    require_consistent(at, witness, {"scalar": scalar, "certified": certified})
    return EpsilonResult(
        gains=controlled.gains,
        robot=controlled.model.name,
        published=published,
        scalar=scalar,
        promise=promise,
        falsified=None if witness is None else witness.eps0,
        witness=witness,
        proof=None if promise is None else proof,
        scalar_proof=None if by_norms is None else scalar_proof,
        weighted=None if promises["weighted"] is None else weighted,
        weighted_promise=promises["weighted"],
        reasons=reasons,
        against=_refutation(controlled, at, witness),
        ranges=controlled.ranges,
        uncertain=any(x.ranged for x in (*controlled.model.parameters.values(), *controlled.model.viscous)),
        corner=_corner(at) if controlled.ranges else {},
        findings=tuple(findings(published, certified, witness)),
        **more,
    )


def answers(
    proof: DecreaseProof | ChainProof | None, gains: GainSet, model: Plant, ranges: bool
) -> tuple[Promise | None, str]:
    """The promise that V falls with the ε₀ and the weights of a proof, or why it is none.

    The question is about the arm as it was given: with all its ranges, or at its nominal numbers.
    """
    if proof is None or proof.judged is None:
        return None, ""
    question = asked.decreasing(gains, model, proof.eps0, proof.coupling, nominal=not ranges)
    return promised(question, proof.judged)


def _refutation(
    controlled: ControlledArm, at: ControlledArm, witness: RisingState | None
) -> Refutation | None:
    """What the witness refutes; ``None`` for an unbounded h, of which there are no such certificates."""
    if witness is None or not controlled.family.bounded:
        return None
    values = tuple(number.value for number in at.model.parameters.values()) if controlled.ranges else ()
    return Refutation(controlled.loop(witness.eps0), at.arm.viscous, values)


def _corner(controlled: ControlledArm) -> dict[str, Fraction]:
    """The values of everything about the arm that has a range."""
    joints = zip(controlled.model.joints, controlled.model.viscous, strict=True)
    friction = {f"viscous friction of {joint}": number for joint, number in joints}
    numbers = {**controlled.model.parameters, **friction}
    return {name: number.value for name, number in numbers.items() if number.ranged}


NEARLY = Fraction(98, 100)
"""The share of the falsified ε₀ from which slow states are not asked."""


def epsilon(
    gain_set: GainSet | str | Path,
    model: RobotModel | str | Path,
    *,
    max_boxes: int = MAX_BOXES,
    jobs: int = 1,
    ranges: bool = False,
    weights: bool | None = None,
    seconds: float | None = None,
    starts: int = STARTS,
    seed: int = SEED,
    on_progress: Progress | None = None,
) -> EpsilonResult:
    """All four ε₀ of a gain set.

    Args:
        gain_set: the controller, or the path of a gain file with one gain set.
        model: the arm, its name or its file.
        max_boxes: budget of branch and bound.
        jobs: processes for the checker of its boxes.
        ranges: for all values of the arm's uncertain parameters and friction, not only the nominal ones.
        seconds: computing time for branch and bound; without it numbers are the same anywhere.
        weights: look for weights Λ as well, joint by joint: with all boxes, with a few if ``None``, or not.
        starts: starts of each optimised program of the falsifier.
        seed: of its random states.
        on_progress: receives the fraction done and a few words.

    Raises:
        InputError: the gains are for another number of joints.
        Contradiction: the witness refutes a certificate.

    Soundness: ``certified`` rests on ``proof``, which ``lyapcheck.check.verify`` accepted, ``falsified`` on
        the witness alone; ``published`` is what (18) claims, ``scalar`` a number unless it has a proof.
    """
    options = Options(max_boxes, jobs, ranges, weights, seconds, starts, seed)
    return four(one_gain_set(gain_set), arm_of(model), options, on_progress or silent)


def four(gain_set: GainSet, model: RobotModel, options: Options, progress: Progress) -> EpsilonResult:
    """As :func:`epsilon`."""
    controlled = ControlledArm(gain_set, model, options.ranges)
    controlled.require_friction()
    progress(0.0, "scalar form")
    published, scalar, reasons = by_forms(controlled)
    if controlled.too_long and (chain := controlled.ranged.chain) is not None:
        viscous = asked.viscous_of(model, nominal=not controlled.ranges)
        linked, reasons["certified"] = chain_epsilon(gain_set, chain, viscous)
        reasons["falsified"] = "M(q) of these links is too long to be written out, and no state is searched"
        return put_together(
            controlled,
            controlled,
            None,
            published=published,
            scalar=scalar.eps0,
            proof=linked,
            scalar_proof=linked if linked is not None and linked.eps0 == scalar.eps0 else None,
            weighted=None,
            boxes=0,
            certified_by="bounds along the links",
            reasons={name: reason for name, reason in reasons.items() if reason},
            assumptions=model.assumptions,
            seed=options.seed,
        )
    by = ""
    proof: DecreaseProof | None = None
    scalar_proof: DecreaseProof | None = None
    reasons["certified"] = unphysical(controlled)
    sought = options.weights is not False and model.n > 1
    main = 0.9 if sought else 1.0
    search = _Search(
        controlled,
        10 * (scalar.eps0 or Fraction(1)),
        replace(options, max_boxes=0) if reasons["certified"] else options,
        part(progress, 0, main),
    )
    at, witness, result = search.run()
    if witness is None:
        reasons["falsified"] = "no state with dV/dt > 0 was confirmed; try more starts"
    if not reasons["certified"]:
        proof, by, reasons["certified"] = _best(controlled, result)
        scalar_proof = proof_of(controlled, scalar.eps0)
    weighted = None
    if sought and proof is not None:
        effort = (
            Effort(boxes=options.max_boxes) if options.weights else usual_effort(model.n, options.max_boxes)
        )
        progress = part(progress, main, 1)
        weighted = weighted_epsilon(controlled, proof, effort, options.jobs, on_progress=progress)
        more = "" if options.weights else "; epsilon --weights looks at more"
        reasons["weighted"] = f"{weighted.reason}{more}" if weighted.reason else ""
    return put_together(
        controlled,
        at,
        witness,
        published=published,
        scalar=scalar.eps0,
        proof=proof,
        scalar_proof=scalar_proof,
        weighted=weighted,
        boxes=result.looked_at,
        certified_by=by,
        reasons={name: reason for name, reason in reasons.items() if reason},
        assumptions=model.assumptions,
        seed=options.seed,
    )


@dataclass(frozen=True)
class _Search:
    """The search for the witness of the smallest ε₀ and for the proof of the largest, both of one gain set.

    Args:
        guess: the ceiling where nothing is falsified.
        options: with no boxes where nothing can be proved.
    """

    controlled: ControlledArm
    guess: Fraction
    options: Options
    progress: Progress

    def run(self) -> tuple[ControlledArm, RisingState | None, CertifiedEpsilon]:
        """The arm that the witness is about, the witness, and what was proved, in one way or the other."""
        if not self.options.max_boxes or not links_follow(self.controlled):
            return self.by_boxes()
        kept, began = int(RESERVE * self.options.max_boxes), computing_time()
        first = replace(
            self,
            options=replace(self.options, max_boxes=self.options.max_boxes - kept),
            progress=part(self.progress, 0.0, 0.9),
        )
        at, witness, result = first.by_boxes()
        if witness is None:
            return at, witness, result
        seconds = None if self.options.seconds is None else self.options.seconds - (computing_time() - began)
        progress = part(self.progress, 0.9, 1.0)
        return at, witness, linked_otherwise(self.controlled, witness.eps0, result, kept, seconds, progress)

    def by_boxes(self) -> tuple[ControlledArm, RisingState | None, CertifiedEpsilon]:
        """The same by boxes, for few joints.

        Fast states are looked at first: where nearly all of the ε₀ that they refute is proved, slow states
        refute hardly less, and are left alone.
        """
        before, first, max_boxes = None, CertifiedEpsilon(None, 0, ""), self.options.max_boxes
        if max_boxes and not self.controlled.ranges and self.controlled.n <= FEW_JOINTS:
            before = self._falsify(self.controlled, part(self.progress, 0.0, 0.1), quick=True)
        if before is not None:
            first = self._certified(before, max_boxes, 0.1, 0.5)
            if first.eps0 is not None and first.eps0 >= NEARLY * before.eps0:
                return self.controlled, before, first
        at, witness = self._falsified(part(self.progress, 0.5, 0.7))
        if before is not None and (witness is None or before.eps0 <= witness.eps0):
            return self.controlled, before, first
        if not max_boxes:
            return at, witness, first
        result = self._certified(witness, max(0, max_boxes - first.looked_at), 0.7, 1.0)
        better = max((result, first), key=lambda one: one.eps0 or 0)
        return at, witness, replace(better, looked_at=first.looked_at + result.looked_at)

    def _falsified(self, progress: Progress) -> tuple[ControlledArm, RisingState | None]:
        if self.controlled.ranges:
            return falsify_corners(self.controlled, self._falsify, progress)
        return self.controlled, self._falsify(self.controlled, progress)

    def _falsify(self, arm: ControlledArm, progress: Progress, quick: bool = False) -> RisingState | None:
        starts, seed = self.options.starts, self.options.seed
        return falsify(arm, starts, seed=seed, on_progress=progress, quick=quick)

    def _certified(
        self, witness: RisingState | None, max_boxes: int, low: float, high: float
    ) -> CertifiedEpsilon:
        ceiling = self.guess if witness is None else witness.eps0
        jobs, seconds, progress = self.options.jobs, self.options.seconds, part(self.progress, low, high)
        return certified_epsilon(self.controlled, ceiling, max_boxes, jobs, seconds, progress)


def _best(controlled: ControlledArm, result: CertifiedEpsilon) -> tuple[DecreaseProof | None, str, str]:
    """The proof of the larger ε₀, what it is called, and what more could be tried."""
    if result.proof is not None:
        boxes = isinstance(result.proof.by, BoxTree)
        return result.proof, "branch and bound" if boxes else "bounds along the links", result.reason
    norm, reason = norm_epsilon(controlled)
    if norm is None:
        return None, "", reason
    return norm, "norms alone", result.reason
