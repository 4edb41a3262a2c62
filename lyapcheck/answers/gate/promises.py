"""Why the gate may say *accepted*: the promises on a gain set, each of a question and what was judged.

    gravity  |g_i(q)| ≤ k_gi at every posture of every arm in the ranges, judged once an arm
    gains    the conditions on numbers with the same k_gi, judged for each set
    proofs   of stability, which the checks carry themselves

Where no model shows a k_gi it is a premise, and is printed as one.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import TYPE_CHECKING

from lyapcheck.answers.gate.stability import unknown_function
from lyapcheck.asked import gate_accepted, gravity_kept
from lyapcheck.check.judgement import MAX_ARM
from lyapcheck.check.kinds.all_of import EveryPart
from lyapcheck.check.kinds.gate_accepted import TORQUES, GateParts
from lyapcheck.check.kinds.gravity import GravityOfPotential
from lyapcheck.check.kinds.identity import SameHarmonics
from lyapcheck.check.statement import Proof
from lyapcheck.control.conditions import CONDITIONS, Check
from lyapcheck.control.gravity import bounding
from lyapcheck.control.judgement import JudgedStatement, judged_statement, proves
from lyapcheck.family.base import named
from lyapcheck.files.decimals import decimal_text
from lyapcheck.promise import Promise, promised
from lyapcheck.robots.dynamics import TooManyTerms

if TYPE_CHECKING:
    from lyapcheck.control.gains import Bounds, GainSet
    from lyapcheck.control.limits import Limits
    from lyapcheck.robots import RobotModel

DIGITS = (30, 120, 1000)
"""Of γ, in turn."""
SAMPLED = "sampled"
"""It counts together with a condition by which no motor saturates."""
NEEDS_GRAVITY = frozenset(("10", *TORQUES))


@dataclass(frozen=True)
class Grounds:
    """What a gain set is accepted on; ``missing`` says why it is not."""

    promises: tuple[Promise, ...] = ()
    premises: tuple[str, ...] = ()
    missing: str = ""


NO_GROUNDS = Grounds()


@lru_cache(maxsize=16)
def _gravity(arm: RobotModel | None, k_g: tuple[Fraction, ...]) -> Grounds:
    """The promise that an arm keeps its bounds k_gi, or the premise that it does."""
    if arm is None:
        return NO_GROUNDS
    shown = shown_gravity(arm, k_g)
    if shown is None:
        unshown = "premise: |g_{}| ≤ {} N·m, which nothing shows"
        return Grounds(premises=tuple(unshown.format(i, decimal_text(k)) for i, k in enumerate(k_g, 1)))
    promise, why_not = promised(gravity_kept(arm, k_g), shown)
    return Grounds(missing=why_not) if promise is None else Grounds((promise,))


def grounds(
    gains: GainSet, limits: Limits, bounds: Bounds, deciding: Sequence[str], checks: Sequence[Check]
) -> Grounds:
    """The promises by which a set that passes its checks is accepted.

    Args:
        gains: the set.
        limits: by which it is judged.
        bounds: of its file.
        deciding: the conditions that must hold.
        checks: of them and others.

    Soundness: ``lyapcheck.promise``.
    """
    proofs = [check.promise for check in checks if check.id in deciding and check.id not in CONDITIONS]
    if None in proofs:
        return Grounds(missing="a proof of stability is about another arm")
    known = tuple(one for one in proofs if one is not None)
    names = (*deciding, *([] if SAMPLED not in deciding or set(TORQUES) & set(deciding) else ["10i"]))
    numbers = tuple(name for name in CONDITIONS if name in names)
    if not numbers:
        return Grounds(known)
    if not is_stated(gains, limits):
        # an h that the checker does not know: each check by itself
        own = [check for check in checks if check.id in numbers]
        return Grounds((*known, *(check.own_promise for check in own)))
    k_g = tuple(map(Fraction, limits.gravity))
    gravity = _gravity(limits.model, k_g) if NEEDS_GRAVITY & set(numbers) else NO_GROUNDS
    if gravity.missing:
        return gravity
    asked = gate_accepted(gains, limits.model, bounds, k_g, numbers)
    shown = judged_statement(asked, (GateParts((), digits, ()) for digits in DIGITS))
    one, missing = promised(asked, shown)
    if one is None:
        return Grounds(missing=missing)
    return Grounds((*gravity.promises, one, *known), gravity.premises)


def is_stated(gains: GainSet, limits: Limits) -> bool:
    """Whether a statement can speak of a set: the checker knows its h."""
    known = named(gains.family, gains.m).bounded and limits.n <= MAX_ARM
    return known and not unknown_function(gains)


@lru_cache(maxsize=16)
def shown_gravity(model: RobotModel, k_g: tuple[Fraction, ...]) -> JudgedStatement | None:
    """What the checker says of these bounds of gravity; ``None`` where nothing shows one of them."""
    try:
        asked = gravity_kept(model, k_g)
    except TooManyTerms:
        return None
    slope = [SameHarmonics() for _, part in asked.parts if isinstance(part, GravityOfPotential)]
    proofs: list[Proof] = [*slope]
    for i, (_, bound) in enumerate(asked.parts[len(slope) :]):
        proof = next((way for way in bounding(bound, model, i) if proves(bound, way)), None)
        if proof is None:
            return None
        proofs.append(proof)
    return judged_statement(asked, [EveryPart(tuple(proofs))])
