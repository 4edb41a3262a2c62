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
from lyapcheck.answers.epsilon import FINDINGS, EpsilonResult
from lyapcheck.check.kinds.decreasing import BoxTree, Decreasing, StateWitness, statement_of
from lyapcheck.check.loop import certifies
from lyapcheck.check.loop.states import confirms_positive
from lyapcheck.check.numbers.polynomials import root_above
from lyapcheck.computing import computing_time
from lyapcheck.constants import robot_bounds
from lyapcheck.control.gains import one_gain_set
from lyapcheck.files.decimals import decimal_text, significant_down
from lyapcheck.lyapunov.scalar import RobotBounds, published_limit, scalar_form, sharp_form
from lyapcheck.promise import Promise, promised
from lyapcheck.robots import arm_of
from lyapcheck.robots.dynamics import FEW_JOINTS
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
from lyapcheck.search.link_bounds import linked_proof
from lyapcheck.search.scalar_program import ScalarResult, chain_epsilon, norm_epsilon, scalar_epsilon
from lyapcheck.search.weights import Effort, Weighted, weighted_epsilon

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots import ArmLike, RobotModel

USUAL = 20_000
"""Boxes for weights that nobody has asked for by name."""
NEARLY = Fraction(98, 100)
"""The share of the falsified ε₀ from which slow states are not asked."""
DIGITS = 9
"""Of the end of (18)."""
ROUNDED = Fraction(1, 10**8)
"""More than the end of (18) loses where it is rounded down, as a share of it."""
Found = tuple[ControlledArm, RisingState | None, CertifiedEpsilon]
"""The arm that the witness is about, the witness, and what was proved, in one way or the other."""


@dataclass(frozen=True)
class Options:
    """See :func:`lyapcheck.epsilon`, of which these are the keywords."""

    max_boxes: int = MAX_BOXES
    jobs: int = 1
    ranges: bool = False
    weights: bool | None = None
    seconds: float | None = None
    starts: int = STARTS
    seed: int = SEED


class Contradiction(RuntimeError):
    """A proved state refutes a proved ε₀: one of the two proofs is wrong, and nothing may be reported."""


def epsilon(
    gain_set: GainSet | str | Path,
    model: ArmLike,
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
        weights: look for weights Λ as well, joint by joint: with all boxes, or not; if ``None`` with a few
            boxes for up to three joints.
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
    found: dict[str, Any] = {"model": model, "published": published, "scalar": scalar.eps0}
    if controlled.too_long and (chain := controlled.ranged.chain) is not None:
        viscous = asked.viscous_of(model, nominal=not controlled.ranges)
        linked, reasons["certified"] = chain_epsilon(gain_set, chain, viscous)
        reasons["falsified"] = "M(q) of these links is too long to be written out, and no state is searched"
        own = linked if linked is not None and linked.eps0 == scalar.eps0 else None
        found |= {"seed": options.seed, "boxes": 0, "certified_by": "bounds along the links"}
        return put_together(controlled, controlled, None, linked, own, None, reasons, **found)
    reasons["certified"] = unphysical(controlled)
    # boxes of the angles and errors of many joints are too many, unless somebody asks for them
    sought = model.n > 1 and (model.n <= FEW_JOINTS if options.weights is None else options.weights)
    main = 0.9 if sought else 1.0
    guess = 10 * (scalar.eps0 or Fraction(1))
    tried = replace(options, max_boxes=0) if reasons["certified"] else options
    at, witness, result = _searched(controlled, guess, tried, part(progress, 0, main))
    if witness is None:
        reasons["falsified"] = "no state with dV/dt > 0 was confirmed; try more starts"
    proof = scalar_proof = weighted = None
    found |= {"seed": options.seed, "boxes": result.looked_at, "certified_by": ""}
    if not reasons["certified"]:
        proof, found["certified_by"], reasons["certified"] = _best(controlled, result)
        scalar_proof = proof_of(controlled, scalar.eps0)
    if sought and proof is not None:
        effort = Effort(boxes=options.max_boxes if options.weights else min(options.max_boxes, USUAL))
        progress = part(progress, main, 1)
        weighted = weighted_epsilon(controlled, proof, effort, options.jobs, on_progress=progress)
        more = "" if options.weights else "; epsilon --weights looks at more"
        reasons["weighted"] = f"{weighted.reason}{more}" if weighted.reason else ""
    return put_together(controlled, at, witness, proof, scalar_proof, weighted, reasons, **found)


# --- The ε₀ that need no search: the end of (18), and that of the scalar form, from norms.


def by_forms(controlled: ControlledArm) -> tuple[Fraction | None, ScalarResult, dict[str, str]]:
    """The published ε₀, the scalar one, and why one of them is missing; no search.

    Over ranges both are about all arms in them, as what is certified is.
    """
    gain_set, constants = controlled.gains, controlled.family.constants()
    bounds, published = _bounds(controlled), None
    if constants.gamma is None:
        reason = "(18) needs a bounded h, and the linear one has no γ"
    elif (limit := published_limit(gain_set, constants, bounds)) is None:
        fails = "(19) fails in the ranges" if controlled.ranges else "(19) fails"
        reason = f"{fails}, so that (18) is empty; lower the gains k_v to below λmin(B)/(√n γ)"
    else:
        published, reason = significant_down(limit.lower, DIGITS), ""
    scalar = scalar_epsilon(sharp_form(gain_set, constants, bounds))
    # where h is bounded the checker's coarse form, over ranges the only one at hand
    if controlled.family.bounded and controlled.ranges:
        scalar = scalar_epsilon(controlled.loop(Fraction(1)).tail)
    elif controlled.family.bounded and (form := scalar_form(gain_set, constants, bounds)) is not None:
        scalar = scalar_epsilon(form)
    return published, scalar, {"published": reason, "scalar": scalar.reason}


def _bounds(controlled: ControlledArm) -> RobotBounds:
    """Bounds of the arm; over ranges those of all arms in them, the worst end of each.

    Where M itself ranges, these are the checker's coarse ones: sharp ones would be asked at every corner.
    """
    model = controlled.model
    if not controlled.ranges:
        return robot_bounds(model)
    ends = [number.bounds for number in model.viscous]
    low, high = min(low for low, _ in ends), max(high for _, high in ends)
    if any(number.ranged for number in model.parameters.values()):
        inertia = controlled.loop(Fraction(1)).inertia
        return RobotBounds(inertia.largest_row, root_above(inertia.squares_of_symbols), low, high)
    return replace(robot_bounds(model), viscous_min=low, viscous_max=high)


def proof_of(controlled: ControlledArm, eps0: Fraction | None) -> DecreaseProof | None:
    """The proof of the scalar ε₀ by norms alone or by bounds along the links, if the checker accepts it."""
    if eps0 is None or not controlled.family.bounded:
        return None
    loop = controlled.loop(eps0)
    by_norms = certifies(loop.tail, eps0)
    proof = controlled.proof(loop, BoxTree(".")) if by_norms else linked_proof(controlled, eps0)
    return None if proof is None else proof.accepted()


# --- The search for the witness of the smallest ε₀ and for the proof of the largest.


def _searched(controlled: ControlledArm, guess: Fraction, options: Options, progress: Progress) -> Found:
    """By boxes, and along the links with the boxes that are kept for them.

    Args:
        guess: the ceiling where nothing is falsified.
        options: with no boxes where nothing can be proved.
    """
    if not options.max_boxes or not links_follow(controlled):
        return _by_boxes(controlled, guess, options, progress)
    kept, began = int(RESERVE * options.max_boxes), computing_time()
    fewer = replace(options, max_boxes=options.max_boxes - kept)
    at, witness, result = _by_boxes(controlled, guess, fewer, part(progress, 0.0, 0.9))
    if witness is None:
        return at, witness, result
    seconds = None if options.seconds is None else options.seconds - (computing_time() - began)
    last = part(progress, 0.9, 1.0)
    return at, witness, linked_otherwise(controlled, witness.eps0, result, kept, seconds, last)


def _by_boxes(controlled: ControlledArm, guess: Fraction, options: Options, progress: Progress) -> Found:
    """By boxes, for few joints.

    Fast states are looked at first: where nearly all of the ε₀ that they refute is proved, slow states
    refute hardly less, and are left alone.
    """

    def state(arm: ControlledArm, progress: Progress, quick: bool = False) -> RisingState | None:
        return falsify(arm, options.starts, seed=options.seed, on_progress=progress, quick=quick)

    def proved(witness: RisingState | None, boxes: int, low: float, high: float) -> CertifiedEpsilon:
        ceiling, own = guess if witness is None else witness.eps0, part(progress, low, high)
        return certified_epsilon(controlled, ceiling, boxes, options.jobs, options.seconds, own)

    before, first, boxes = None, CertifiedEpsilon(None, 0, ""), options.max_boxes
    if boxes and not controlled.ranges and controlled.n <= FEW_JOINTS:
        before = state(controlled, part(progress, 0.0, 0.1), quick=True)
    if before is not None:
        first = proved(before, boxes, 0.1, 0.5)
        if first.eps0 is not None and first.eps0 >= NEARLY * before.eps0:
            return controlled, before, first
    at, slow = controlled, part(progress, 0.5, 0.7)
    if controlled.ranges:
        at, witness = falsify_corners(controlled, state, slow)
    else:
        witness = state(controlled, slow)
    if before is not None and (witness is None or before.eps0 <= witness.eps0):
        return controlled, before, first
    if not boxes:
        return at, witness, first
    result = proved(witness, max(0, boxes - first.looked_at), 0.7, 1.0)
    better = max((result, first), key=lambda one: one.eps0 or 0)
    return at, witness, replace(better, looked_at=first.looked_at + result.looked_at)


def _best(controlled: ControlledArm, result: CertifiedEpsilon) -> tuple[DecreaseProof | None, str, str]:
    """The proof of the larger ε₀, what it is called, and what more could be tried."""
    if result.proof is not None:
        boxes = isinstance(result.proof.by, BoxTree)
        return result.proof, "branch and bound" if boxes else "bounds along the links", result.reason
    norm, reason = norm_epsilon(controlled)
    return (None, "", reason) if norm is None else (norm, "norms alone", result.reason)


# --- What was found about a gain set, put together with all that follows from it.


def put_together(
    controlled: ControlledArm,
    at: ControlledArm,
    witness: RisingState | None,
    proof: DecreaseProof | ChainProof | None,
    scalar_proof: DecreaseProof | ChainProof | None,
    weighted: Weighted | None,
    reasons: Mapping[str, str],
    **found: Any,
) -> EpsilonResult:
    """What was found about a gain set, with all that follows from it.

    Args:
        controlled: gains and arm.
        at: the arm, within its ranges, that the witness is about.
        witness: of ``at``.
        proof, scalar_proof, weighted: as they were found; only what answers the question is kept.
        reasons: why a number is missing, and why one of these is not kept.
        found: what else it takes that does not follow from these.

    Raises:
        Contradiction: the witness refutes a certificate.
    """
    promise, why = _answers(proof, controlled)
    by_weights, why_weighted = _answers(None if weighted is None else weighted.proof, controlled)
    certified = None if promise is None or proof is None else proof.eps0
    require_consistent(at, witness, {"scalar": found["scalar"], "certified": certified})
    said = {
        **reasons,
        **({"certified": why} if why else {}),
        **({"weighted": why_weighted} if why_weighted else {}),
    }
    return EpsilonResult(
        gains=controlled.gains,
        promise=promise,
        falsified=None if witness is None else witness.eps0,
        witness=witness,
        proof=None if promise is None else proof,
        scalar_proof=None if _answers(scalar_proof, controlled)[0] is None else scalar_proof,
        weighted=None if by_weights is None else weighted,
        weighted_promise=by_weights,
        reasons={name: reason for name, reason in said.items() if reason},
        against=_refuted(controlled, at, witness),
        ranges=controlled.ranges,
        corner=_corner(at) if controlled.ranges else {},
        findings=tuple(findings(found["published"], certified, witness)),
        **found,
    )


def _answers(
    proof: DecreaseProof | ChainProof | None, controlled: ControlledArm
) -> tuple[Promise | None, str]:
    """The promise that V falls with the ε₀ and the weights of a proof, or why it is none.

    The question is about the arm as it was given: with all its ranges, or at its nominal numbers.
    """
    if proof is None or proof.judged is None:
        return None, ""
    own = controlled.gains, controlled.model, proof.eps0, proof.coupling
    return promised(asked.decreasing(*own, nominal=not controlled.ranges), proof.judged)


def _refuted(
    controlled: ControlledArm, at: ControlledArm, witness: RisingState | None
) -> tuple[Decreasing, StateWitness] | None:
    """What the witness refutes; ``None`` for an unbounded h, of which there are no such certificates."""
    if witness is None or not controlled.family.bounded:
        return None
    values = tuple(number.value for number in at.model.parameters.values()) if controlled.ranges else ()
    state = StateWitness(at.arm.viscous, values, witness.state.q, witness.state.e, witness.state.w)
    return statement_of(controlled.loop(witness.eps0)), state


def _corner(controlled: ControlledArm) -> dict[str, Fraction]:
    """The values of everything about the arm that has a range."""
    joints = zip(controlled.model.joints, controlled.model.viscous, strict=True)
    friction = {f"viscous friction of {joint}": number for joint, number in joints}
    numbers = {**controlled.model.parameters, **friction}
    return {name: number.value for name, number in numbers.items() if number.ranged}


def require_consistent(
    controlled: ControlledArm, witness: RisingState | None, claimed: Mapping[str, Fraction | None]
) -> None:
    """Raise `Contradiction` if the witness has dV/dt > 0 at an ε₀ that is claimed to be certified."""
    for name, eps0 in claimed.items():
        if witness is None or eps0 is None:
            continue
        if confirms_positive(controlled.arm, controlled.controller, eps0, witness.state):
            raise Contradiction(
                f"{controlled.gains.name}: the {name} ε₀ = {decimal_text(eps0)} is refuted by a proved state"
            )
        if name == "scalar" and eps0 >= witness.eps0:
            raise Contradiction(f"{controlled.gains.name}: the scalar ε₀ is not below a falsified one")


def findings(
    published: Fraction | None, certified: Fraction | None, witness: RisingState | None
) -> list[str]:
    """What the numbers say about each other, one sentence each."""
    result = []
    if published is not None and witness is not None and witness.eps0 < published:
        result.append("published-refuted")
    if published is not None and certified is not None and published * (1 + ROUNDED) <= certified:
        result.append("published-certified")
    if certified is not None and witness is not None and certified > witness.eps0:
        result.append("no-interval")
    return [FINDINGS[rule] for rule in result]
