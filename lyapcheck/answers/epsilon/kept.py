"""Four ε₀ computed before: taken from the store only if the checker accepts all their proofs again.

Closed loops are built anew from gains and arm, the proofs and the witness are judged on them, and what
follows from these is derived again, as are the ε₀ that no search finds. Words are taken as they were.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from lyapcheck import store
from lyapcheck._types import Progress, silent
from lyapcheck.answers.epsilon.assembled import put_together
from lyapcheck.answers.epsilon.compute import four
from lyapcheck.answers.epsilon.consistency import Contradiction
from lyapcheck.answers.epsilon.forms import by_forms
from lyapcheck.answers.epsilon.four import Refutation
from lyapcheck.answers.epsilon.options import Options
from lyapcheck.answers.epsilon.result import EpsilonResult
from lyapcheck.certificate import to_json
from lyapcheck.check.codec import from_json
from lyapcheck.check.kinds.decreasing import BoxTree, PositiveAndDecreasing
from lyapcheck.check.kinds.link_bounds import LinkBounds
from lyapcheck.check.loop.states import State
from lyapcheck.check.refusal import Refused
from lyapcheck.check.statement import Proof
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.search.corners import at_corner
from lyapcheck.search.falsify import confirmed
from lyapcheck.search.proof import DecreaseProof
from lyapcheck.search.weights import Weighted

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots import RobotModel
    from lyapcheck.robots.plant import Plant


def kept_epsilon(
    gain_set: GainSet, model: RobotModel, options: Options, on_progress: Progress = silent
) -> EpsilonResult:
    """What :func:`lyapcheck.epsilon` answers, from the store where it is there and holds."""
    if options.seconds is not None:  # another run of so many seconds may find a larger one
        return four(gain_set, model, options, on_progress)
    return store.remembered(
        question(gain_set, model, options),
        lambda kept: read(kept, gain_set, model, options),
        lambda: four(gain_set, model, options, on_progress),
        written,
    )


def question(gain_set: GainSet, model: RobotModel, options: Options) -> dict[str, Any]:
    """All that the four ε₀ depend on; not the name of the gain set."""
    gains = (gain_set.family, gain_set.m, gain_set.kp, gain_set.kv, gain_set.angle_unit)
    budget = {name: getattr(options, name) for name in ("max_boxes", "ranges", "weights", "starts", "seed")}
    return {"epsilon": store.exact(gains, model), **budget}


def written(result: EpsilonResult) -> dict[str, Any]:
    """What cannot be derived again, as plain data."""
    witness, weighted = result.witness, result.weighted
    return {
        "boxes": result.boxes,
        "certified_by": result.certified_by,
        "reasons": dict(result.reasons),
        "proof": None if result.proof is None else _written(result.proof),
        "scalar_proof": None if result.scalar_proof is None else _written(result.scalar_proof),
        "weighted": None
        if weighted is None
        else {**_written(weighted.proof), "states": weighted.states, "looked_at": weighted.looked_at},
        "witness": None
        if witness is None
        else {
            "eps0": str(witness.eps0),
            "kind": witness.kind,
            "state": to_json(witness.state),
            "arm": None if result.against is None else _written_arm(result.against),
        },
        "seed": result.seed,
    }


def read(kept: Any, gain_set: GainSet, model: RobotModel, options: Options) -> EpsilonResult | None:
    """What was written, if the checker accepts all of it for these gains and this arm."""
    try:
        controlled = ControlledArm(gain_set, model, options.ranges)
        return _read(kept, controlled, model.assumptions, options.jobs)
    except (Refused, Contradiction, KeyError, TypeError, ValueError, ZeroDivisionError, AttributeError):
        return None


def _read(
    kept: Mapping[str, Any], controlled: ControlledArm, assumptions: tuple[str, ...], jobs: int
) -> EpsilonResult | None:
    proof, heavier = _proof(kept["proof"], controlled), kept["weighted"]
    weighted, (published, scalar, reasons) = _proof(heavier, controlled), by_forms(controlled)
    scalar_proof = _proof(kept["scalar_proof"], controlled)
    at, seen = controlled, kept["witness"]
    witness = None
    if seen is not None:
        if controlled.ranges:
            at = replace(controlled, model=_arm(seen["arm"], controlled), ranges=False)
        state = from_json(State, seen["state"], "state")
        witness = confirmed(at, Fraction(seen["eps0"]), str(seen["kind"]), state)
    proofs = [one for one in (proof, scalar_proof, weighted) if one is not None]
    lost = (witness is None and seen is not None) or (scalar_proof and scalar_proof.loop.eps0 != scalar.eps0)
    if lost or not all(one.accepted(jobs) for one in proofs):
        return None
    return put_together(
        controlled,
        at,
        witness,
        published=published,
        scalar=scalar.eps0,
        proof=proof,
        scalar_proof=scalar_proof,
        weighted=None
        if weighted is None
        else Weighted(weighted, int(heavier["states"]), int(heavier["looked_at"])),
        boxes=int(kept["boxes"]),
        certified_by=str(kept["certified_by"]),
        reasons={name: str(text) for name, text in (kept["reasons"] | reasons).items() if text},
        assumptions=assumptions,
        seed=int(kept["seed"]),
    )


def _written_arm(against: Refutation) -> dict[str, Any]:
    return {"viscous": to_json(against.viscous), "parameters": to_json(against.parameters)}


def _arm(arm: Any, controlled: ControlledArm) -> Plant:
    """The arm at the values that a witness is about.

    Raises:
        ValueError: it is none of those that are meant.
    """
    plant = controlled.model
    viscous = {f"viscous {i}": number for i, number in enumerate(plant.viscous)}
    numbers = {**viscous, **plant.parameters}
    values = dict(zip(numbers, map(Fraction, (*arm["viscous"], *arm["parameters"])), strict=True))
    for name, number in numbers.items():
        low, high = number.bounds
        if not low <= values[name] <= high:
            raise ValueError(f"{name} is outside its range")
    return at_corner(plant, plant, values)


def _written(proof: DecreaseProof) -> dict[str, Any]:
    loop = proof.loop
    return {
        "eps0": str(loop.eps0),
        "coupling": to_json(loop.coupling),
        "proof": to_json(proof.certificate),
    }


def _proof(kept: Any, controlled: ControlledArm) -> DecreaseProof | None:
    """A proof as it was written, of what is asked now; not yet judged."""
    if kept is None:
        return None
    result = from_json(Proof, kept["proof"], "proof")
    if not isinstance(result, PositiveAndDecreasing) or not isinstance(result.rate, BoxTree | LinkBounds):
        raise TypeError(f"{type(result).__name__} proves no ε₀")
    coupling = from_json(tuple[Fraction, ...], kept["coupling"], "coupling")
    return DecreaseProof(
        controlled.loop(Fraction(kept["eps0"]), coupling), result.rate, controlled.inertia_proof
    )
