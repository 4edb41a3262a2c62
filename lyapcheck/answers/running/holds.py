"""Whether gains hold the gravity that the controller does not know, and how far from the goal it leaves them.

    Δg_i = g_i of an unknown payload of up to P kg, ± a share s of the arm's own g_i

The payload sits at the centre of mass of the last link, as for ``--vary payload``, on links without mass. At
rest K_p h(e) is Δg and what dry friction f holds. With

    holds   sup |Δg_i| + f_i < k_pi      every rest lies where h rises: |e_i| ≤ h⁻¹((sup |Δg_i| + f_i)/k_pi)
    falls   |Δg_i(q)| > γ k_pi + f_i     at a posture q, where no error makes torque enough

In between neither is said: from k_pi to γ k_pi there is a second state of rest, where h falls.

References: (6), (11) of reyes2019family.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import lru_cache
from math import degrees
from typing import TYPE_CHECKING

from flint import arb

from lyapcheck.asked import gravity_kept, resting
from lyapcheck.check.kinds.all_of import AllOf, EveryPart
from lyapcheck.check.kinds.inertia import PostureWitness
from lyapcheck.check.kinds.resting import AtBounds, Resting
from lyapcheck.check.numbers.members import member
from lyapcheck.check.numbers.polynomials import Enclosure
from lyapcheck.control.conditions import Check
from lyapcheck.control.gravity import bounding, computed_bounds, exceeded
from lyapcheck.control.judgement import (
    DEGREES,
    JudgedStatement,
    Room,
    degrees_above,
    dry_friction,
    judged_statement,
    rest_error,
    stalls,
)
from lyapcheck.control.sampling import exact_only
from lyapcheck.family.base import named
from lyapcheck.files.decimals import decimal_text, significant_down, significant_up
from lyapcheck.output.digits import at_least, at_most
from lyapcheck.promise import all_say, promised
from lyapcheck.robots.dynamics import Chain, TooManyTerms

if TYPE_CHECKING:
    from lyapcheck.check.statement import Proof
    from lyapcheck.control.gains import GainSet
    from lyapcheck.control.sampling import LoopRecord
    from lyapcheck.robots import RobotModel

HOLDS = "holds"
HALVINGS, FAR = 50, 40.0
"""Of an interval with a state of rest, and its end, rad: there every h is 1 but for rounding."""
NO_LINKS = "an unknown payload needs the links of the arm: give it by [[links]] or a URDF file"
NO_ARM = "needs the arm itself, not only its limits; name one with robot = …"
UNBOUNDED = "h is unbounded, and no error at rest is judged of it"
NOTHING = "nothing unknown is stated: add unknown_payload = … or gravity_error = … under [loop]"


@dataclass(frozen=True, repr=False)
class HoldsCheck(Check):
    """`Check` of one joint: its value is sup |Δg_i| + f_i, its limit k_pi, in N·m.

    Args:
        unknown: what the controller does not know, in words.
        friction: f_i, N·m.
        exact_only: that the error leaves out the encoder of the record, in words; empty without one.
        payload: the largest that the same bounds let it hold, kg; ``None`` where they bound none.
        reach: γ k_pi + f_i, N·m.
        reached: what is asked at a posture that refutes, N·m, from below.
    """

    unknown: str = ""
    friction: Fraction = Fraction(0)
    exact_only: str = ""
    payload: Fraction | None = None
    reach: Fraction = Fraction(0)
    reached: Fraction = Fraction(0)

    @property
    def error(self) -> Fraction | None:
        """The error at rest that is promised, rad; ``None`` without."""
        if self.promise is None:
            return None
        assert isinstance(self.promise.asked, AllOf)
        rest = dict(self.promise.asked.parts)["rest"]
        assert isinstance(rest, Resting)
        return rest.errors[0]


def holds_checks(
    gains: GainSet,
    model: RobotModel | None,
    record: LoopRecord,
    room: Room,
    dry: Sequence[Fraction] | None = None,
) -> tuple[Check, ...]:
    """The check of each joint that something unknown may move, of all if it moves none; or why there is none.

    Args:
        gains: the controller.
        model: the arm, of which all values of its ranges are meant.
        record: what the controller does not know.
        room: what the motors can do beyond the gravity that the controller knows.
        dry: (n,) bounds of dry friction in place of the arm's, N·m.

    Soundness: bounds of Δg and of the errors are accepted by ``lyapcheck.check.verify``; a posture at which a
        joint falls refutes that |Δg_i| stays below γ k_pi + f_i.
    """
    reason = NOTHING if record.knows_gravity else ""
    reason = reason or (NO_ARM if model is None else "")
    reason = reason or ("" if named(gains.family, gains.m).bounded else UNBOUNDED)
    if reason or model is None:
        return (Check(HOLDS, reason=reason),)
    if record.unknown_payload and not isinstance(model.dynamics, Chain):
        return (Check(HOLDS, reason=NO_LINKS),)
    parts = []
    try:
        if record.unknown_payload:
            arm = payload_alone(model, record.unknown_payload)
            parts.append(_Part("payload", arm, Fraction(1), computed_bounds(arm)))
        if record.gravity_error:
            parts.append(_Part("gravity", model, record.gravity_error, computed_bounds(model)))
    except TooManyTerms as error:
        return (Check(HOLDS, reason=str(error)),)
    friction = dry_friction(model) if dry is None else dry
    moved = [i for i in range(model.n) if any(part.bounds[i] for part in parts)] or range(model.n)
    return tuple(_check(gains, model, record, (i, friction[i]), parts, room[i]) for i in moved)


@dataclass(frozen=True)
class _Part:
    """An arm whose gravity the controller does not know, times a share; bounds of its g_i, N·m."""

    name: str
    arm: RobotModel
    share: Fraction
    bounds: tuple[Fraction, ...]


@lru_cache(maxsize=16)
def payload_alone(model: RobotModel, payload: Fraction) -> RobotModel:
    """A payload at the centre of mass of the last link, on links without mass."""
    chain = model.dynamics
    assert isinstance(chain, Chain)
    nothing = ((Fraction(0),) * 3,) * 3
    bare = [replace(link, mass=Fraction(0), inertia=nothing, rotor=Fraction(0)) for link in chain.links]
    links = (*bare[:-1], replace(bare[-1], mass=payload))
    return replace(model, dynamics=Chain(links, chain.fall, chain.names))


def _check(
    gains: GainSet,
    model: RobotModel,
    record: LoopRecord,
    joint: tuple[int, Fraction],
    parts: Sequence[_Part],
    room: Fraction | None,
) -> HoldsCheck:
    i, friction = joint
    most = sum((part.share * part.bounds[i] for part in parts), Fraction(0))
    kp = Fraction(gains.kp[i])
    total = most + friction
    known = HoldsCheck(
        HOLDS,
        i,
        value=total,
        limit=Enclosure(kp, kp),
        unknown=record.unknown_text,
        friction=friction,
        exact_only=exact_only(record),
        payload=_payload(record, i, parts, (kp if room is None else min(kp, room)) - friction),
        reach=member(gains.family, gains.m).gamma * kp + friction,
    )
    stalled = total < kp and stalls(total, room)
    error = rest_error(gains.family, gains.m, total / kp) if total < kp and not stalled else None
    if error is not None:
        printed = significant_up(error * DEGREES, 4) / DEGREES
        judged = _judged(_stated(gains, i, parts, total, error), i, parts)
        promise, why = promised(_stated(gains, i, parts, total, printed), judged)
        return replace(
            known, judgement=judged if promise else None, promise=promise, reason=judged.reason or why
        )
    for part in parts:
        try:
            broken = exceeded(part.arm, i, known.reach / part.share)
        except TooManyTerms:
            continue
        if broken is not None:
            return replace(known, judgement=broken[0], reached=part.share * broken[1])
    if stalled:
        stuck = f"gravity and dry friction may hold {model.joints[i]} with its motor at its limit"
        return replace(known, reason=f"{stuck}, with {record.unknown_text}")
    return replace(known, reason=_between(gains, record, total, kp, model.joints[i]))


def _stated(gains: GainSet, i: int, parts: Sequence[_Part], total: Fraction, error: Fraction) -> AllOf:
    """|g_i| is bounded for each part, and with all of them the joint rests within an error, rad."""
    bounds = tuple(
        (part.name, dict(gravity_kept(part.arm, part.bounds).parts)[f"g{i + 1}"]) for part in parts
    )
    alone = replace(gains, kp=(gains.kp[i],), kv=(gains.kv[i],))
    return AllOf((*bounds, ("rest", resting(alone, (total,), (error,)))))


def _judged(stated: AllOf, i: int, parts: Sequence[_Part]) -> JudgedStatement:
    proofs: list[Proof] = []
    for (_, bound), part in zip(stated.parts, parts, strict=False):
        known = judged_statement(bound, bounding(bound, part.arm, i))
        if known.proof is None:
            return replace(known, statement=stated)
        proofs.append(known.proof)
    return judged_statement(stated, [EveryPart((*proofs, AtBounds()))])


def _payload(record: LoopRecord, i: int, parts: Sequence[_Part], room: Fraction) -> Fraction | None:
    """The payload below which the bounds say that the joint holds, kg, rounded down."""
    for part in parts:
        if part.name == "payload" and part.bounds[i]:
            others = sum((one.share * one.bounds[i] for one in parts if one is not part), Fraction(0))
            return significant_down(
                max(room - others, Fraction(0)) * record.unknown_payload / part.bounds[i], 4
            )
    return None


def _between(gains: GainSet, record: LoopRecord, total: Fraction, kp: Fraction, joint: str) -> str:
    """Why neither is shown, with the states of rest that h has for as much torque as is asked at most."""
    ratio = float(total / kp)
    found = [f"{degrees(x):.3g}°" for x in _rests(gains, ratio)]
    rests = f"; so much rests at {' and at '.join(found)} (estimated)" if found else ""
    return (
        f"{record.unknown_text} may ask {float(total):.4g} N·m of {joint}, k_p = {decimal_text(kp)} N·m, "
        f"and no posture was found where it falls{rests}"
    )


def _rests(gains: GainSet, ratio: float) -> list[float]:
    """The x > 0 with h(x) = ratio, where h rises and where it falls; floating point."""
    constants, known = named(gains.family, gains.m).constants(), member(gains.family, gains.m)
    if constants.gamma is None or constants.gamma_at is None or not 1 < ratio < float(constants.gamma.upper):
        return []

    def below(x: float) -> bool:
        return float(known.h(arb(x)).mid()) < ratio

    def crossing(low: float, high: float) -> float:
        rising = below(low)
        for _ in range(HALVINGS):
            middle = (low + high) / 2
            low, high = (middle, high) if below(middle) == rising else (low, middle)
        return low

    top = float(constants.gamma_at.mid)
    return [crossing(0.0, top), crossing(top, FAR)]


def holds_sentences(checks: Sequence[Check], joints: Sequence[str]) -> list[str]:
    """How far from the goal the joints may rest that hold; `falls` says what is shown of others."""
    held = _held(checks)
    if not held:
        return []
    some = any(one.friction for one in held)
    far = ", ".join(
        f"{joints[one.joint or 0]} {degrees_above(one.error or Fraction(0))}"
        f"{' (without dry friction)' if some and not one.friction else ''}"
        for one in held
    )
    dry = " with dry friction" if some else ", without dry friction,"
    leaves = f"{dry} leaves at most {far}, at every state of rest{held[0].exact_only}"
    words = f"{held[0].unknown} unknown to the controller{leaves}"
    return [all_say((one.promise for one in held), words)]


def farthest_unknown(checks: Sequence[Check]) -> tuple[Fraction, str] | None:
    """How far from the goal what is unknown may leave a joint, in degrees and in words; ``None`` if open."""
    held = _held(checks)
    if not held or len(held) < sum(check.id == HOLDS for check in checks):
        return None
    most = max(one.error or Fraction(0) for one in held)
    leave = " and dry friction leave" if any(one.friction for one in held) else " leaves"
    words = f"{held[0].unknown}{leave} at most {degrees_above(most)}"
    return most * DEGREES, all_say((one.promise for one in held), words)


def _held(checks: Sequence[Check]) -> list[HoldsCheck]:
    return [check for check in checks if isinstance(check, HoldsCheck) and check.error is not None]


def falls(check: HoldsCheck, joints: Sequence[str]) -> str:
    """What is asked of a joint at a posture, and what holds it."""
    proof = None if check.judgement is None else check.judgement.proof
    q = proof.q if isinstance(proof, PostureWitness) else ()
    place = ", ".join(f"{degrees(x):.6g}" for x in q)
    holds = "γ k_p and dry friction hold" if check.friction else "γ k_p holds"
    return (
        f"{joints[check.joint or 0]} falls: {check.unknown} asks {at_least(check.reached)} N·m at "
        f"q = ({place})°, {holds} {at_most(check.reach)} N·m"
    )
