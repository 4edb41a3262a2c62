"""Bounds of a motion proved before: taken from the store only if the checker accepts their proofs again.

What a statement says of the arm, the gains, the start and what acts must be what is asked now. The runs shown
beside the bounds have no certificate, and are made anew.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from lyapcheck import store
from lyapcheck._types import part
from lyapcheck.certificate import to_json
from lyapcheck.check.codec import from_json
from lyapcheck.check.kinds.decreasing import statement_of
from lyapcheck.check.kinds.of_loop import OfLoop
from lyapcheck.check.kinds.phases import FallingPhases, StaysWithin
from lyapcheck.check.kinds.resting import AtBounds, Resting
from lyapcheck.check.kinds.settling import FallingLevels, Settling
from lyapcheck.check.kinds.stopping import ComesToRest, EnergyFalls
from lyapcheck.check.loop.decay.estimate import Disturbance
from lyapcheck.check.refusal import Refused
from lyapcheck.check.statement import Proof, Statement
from lyapcheck.search.decay.bounds import disturbance_bound, settling_bound
from lyapcheck.search.decay.digits import as_written
from lyapcheck.search.decay.results import AtRest, DisturbanceBound, MotionWithProof, SettlingBound, accepted
from lyapcheck.search.decay.start import Start, start_of, torques_of

if TYPE_CHECKING:
    from lyapcheck._types import Progress
    from lyapcheck.search.controlled_arm import ControlledArm

SETTLING, DISTURBED, RESTING = "settling", "disturbed", "resting"
LEVELS = {Settling: FallingLevels, StaysWithin: FallingPhases}
REST = {Resting: AtBounds, ComesToRest: EnergyFalls}
"""What may be shown, and by which proofs."""
BROKEN = (Refused, KeyError, TypeError, ValueError, ZeroDivisionError, AttributeError)

Bounds = tuple[SettlingBound, DisturbanceBound]


def kept_bounds(
    controlled: ControlledArm,
    e0: Sequence[float],
    w0: Sequence[float] | None,
    delta: float,
    torque: Sequence[Fraction | float],
    dry: Sequence[Fraction | float],
    *,
    max_boxes: int,
    jobs: int,
    on_progress: Progress,
) -> Bounds:
    """``settling_bound`` and ``disturbance_bound``, from the store where they are there and hold."""
    acting = Disturbance(torques_of(controlled, "torque", torque), torques_of(controlled, "dry", dry))
    asked = BoundsQuestion(controlled, start_of(controlled, e0, w0, delta), as_written(delta), acting)
    budget: dict[str, Any] = {"max_boxes": max_boxes, "jobs": jobs}
    return store.remembered(
        asked.question(max_boxes),
        lambda kept: asked.read(kept, jobs),
        lambda: (
            settling_bound(controlled, e0, w0, delta, on_progress=part(on_progress, 0, 0.5), **budget),
            disturbance_bound(
                controlled, e0, w0, torque, dry, on_progress=part(on_progress, 0.5, 1), **budget
            ),
        ),
        written,
    )


def written(result: Bounds) -> dict[str, Any]:
    """Statements, their proofs, and why there is none, as plain data."""
    settling, left = result
    shown = {SETTLING: settling.shown, DISTURBED: left.shown, RESTING: left.resting}
    proofs = {
        name: None if one is None else [to_json(one.statement), to_json(one.proof)]
        for name, one in shown.items()
    }
    return {**proofs, "reasons": [settling.reason, left.reason]}


@dataclass(frozen=True)
class BoundsQuestion:
    """What bounds are asked about.

    Args:
        controlled: gains and arm.
        start: bounds of |e_i|, rad, and |w_i|, rad/s, at the start.
        delta: δ, rad.
        acting: the torques.
    """

    controlled: ControlledArm
    start: Start
    delta: Fraction
    acting: Disturbance

    def question(self, max_boxes: int) -> dict[str, Any]:
        """All that the bounds depend on; not the name of the gain set."""
        gains, model = self.controlled.gains, self.controlled.model
        own = (gains.family, gains.m, gains.kp, gains.kv, gains.angle_unit)
        numbers = (self.start, self.delta, self.acting.torque, self.acting.dry)
        asked = {"bounds": store.exact(own, model, numbers), "boxes": max_boxes}
        return asked | ({"ranges": True} if self.controlled.ranges else {})

    def read(self, kept: Any, jobs: int) -> Bounds | None:
        """What was written, if the checker accepts all of it, and it is about what is asked."""
        try:
            return self._read(kept, jobs)
        except BROKEN:
            return None

    def _read(self, kept: Any, jobs: int) -> Bounds | None:
        calm, held = Disturbance.none(self.controlled.n), self._held
        settling = _parts(kept[SETTLING], LEVELS)
        left, resting = _parts(kept[DISTURBED], LEVELS), _parts(kept[RESTING], REST)
        about = [
            (settling, self._begins | vars(calm)),
            (left, self._begins | vars(self.acting)),
            (resting, {"torque": held, "dry": held}),
        ]
        whole = statement_of(self.controlled.loop(Fraction(1)))
        loop = {one.name: getattr(whole, one.name) for one in fields(OfLoop)}
        for pair, known in about:
            if pair is not None and not (_is_about(pair[0], loop | known) and accepted(*pair, jobs)):
                return None
        if settling is not None and max(settling[0].errors) > self.delta:
            return None
        if isinstance(resting and resting[0], ComesToRest) and any(self.acting.torque):
            return None
        of_settling, of_left = map(str, kept["reasons"])
        return (
            SettlingBound.of(
                self.controlled, settling and MotionWithProof(*settling), of_settling, self.delta
            ),
            DisturbanceBound.of(
                self.controlled,
                left and MotionWithProof(*left),
                of_left,
                self.acting.torque,
                self.acting.dry,
                resting and AtRest(*resting),
            ),
        )

    @property
    def _begins(self) -> dict[str, Any]:
        return {"errors_at_start": self.start[0], "rates_at_start": self.start[1]}

    @property
    def _held(self) -> tuple[Fraction, ...]:
        return tuple(a + b for a, b in zip(self.acting.torque, self.acting.dry, strict=True))


def _parts(kept: Any, kinds: dict[Any, Any]) -> tuple[Any, Any] | None:
    """A statement and its proof, of the kinds that are meant."""
    if kept is None:
        return None
    statement, proof = from_json(Statement, kept[0], "statement"), from_json(Proof, kept[1], "proof")
    if not isinstance(proof, kinds[type(statement)]):
        raise TypeError(f"{type(proof).__name__} proves no bound")
    return statement, proof


def _is_about(statement: Any, known: dict[str, Any]) -> bool:
    """Whether each thing known that a statement speaks of is what it says."""
    return all(value == known.get(name, value) for name, value in vars(statement).items())
