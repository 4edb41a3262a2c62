"""Certificates of ε₀, and four ε₀ found before: their certificates again, and what follows derived anew.

Words and counts of the search are taken as they were. Nothing is kept of a linear h: it has no certificates.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from lyapcheck import store
from lyapcheck._types import Progress, silent
from lyapcheck.answers.epsilon import EpsilonResult
from lyapcheck.answers.epsilon.compute import Options, by_forms, four, put_together
from lyapcheck.certificate import Certificate
from lyapcheck.check.certificate import About
from lyapcheck.check.certificate import Certificate as Read
from lyapcheck.check.kinds.decreasing import (
    BoxTree,
    Decreasing,
    PositiveAndDecreasing,
    StateWitness,
    statement_of,
)
from lyapcheck.check.kinds.inertia import Bisection, Links, MassAtCorners
from lyapcheck.check.kinds.link_bounds import LinkBounds
from lyapcheck.check.loop.states import State
from lyapcheck.check.statement import Proof, Statement
from lyapcheck.control.judgement import JudgedStatement
from lyapcheck.files.decimals import decimal_text
from lyapcheck.files.fields import file_stem
from lyapcheck.search.controlled_arm import ControlledArm, DecreaseProof
from lyapcheck.search.falsify import RisingState, at_corner, confirmed
from lyapcheck.search.weights import Weighted
from lyapcheck.store import KeptCertificates, remembered

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots import RobotModel

PROOF = "epsilon"
BESIDE = ("boxes", "certified_by", "seed")


def certificates(result: EpsilonResult) -> dict[str, Certificate]:
    """Certificates by file name: of each ε₀ that is called certified, of the scalar one if it has one."""
    made: dict[str, Certificate] = {}
    arms = "for every arm in its ranges" if result.ranges else "at nominal numbers"
    weighted = result.weighted
    known = {
        ("certified", "proved"): result.proof,
        ("scalar", "scalar"): result.scalar_proof,
        ("weighted", "weighted"): weighted.proof if weighted and weighted.proof.coupling else None,
    }
    rows: list[tuple[str, str, Fraction, Sequence[Fraction], str, Statement, Proof]] = [
        (file, kind, one.eps0, one.coupling, "proved", one.statement, one.certificate)
        for (file, kind), one in known.items()
        if one is not None
    ]
    if result.against is not None:
        stated, state = result.against
        rows.append(("falsified", "refuted", stated.eps0, stated.coupling, "refuted", stated, state))
    for file, kind, eps0, coupling, verdict, statement, proof in rows:
        weights = f", Λ = diag({', '.join(map(decimal_text, coupling))})" if coupling else ""
        says = (
            f"dV/dt < 0 at every state but the origin: {result.name} on {result.model.name}, {arms}, "
            f"ε₀ = {decimal_text(eps0)}{weights}"
        )
        about = About(f"{result.name}.{kind}", says, result.m, len(result.gains.kp), PROOF)
        name = f"{file_stem(result.name)}.{file}.json"
        made[name] = Certificate(about, statement, verdict, "enclosure", proof)
    return made


def kept_epsilon(
    gain_set: GainSet, model: RobotModel, options: Options, on_progress: Progress = silent
) -> EpsilonResult:
    """What :func:`lyapcheck.epsilon` answers, from the store where it is there and holds."""
    controlled = ControlledArm(gain_set, model, options.ranges)
    # another run of so many seconds may find a larger one
    if options.seconds is not None or controlled.too_long:
        return four(gain_set, model, options, on_progress)
    # all that the four depend on; not the name of the gain set
    gains = gain_set.family, gain_set.m, gain_set.kp, gain_set.kv, gain_set.angle_unit
    budget = {name: getattr(options, name) for name in ("max_boxes", "ranges", "weights", "starts", "seed")}
    return remembered(
        {"epsilon": store.exact(gains, model), **budget},
        lambda kept: _rebuilt(kept, controlled, model),
        lambda: four(gain_set, model, options, on_progress),
        _written,
        options.jobs,
    )


def _written(result: EpsilonResult) -> KeptCertificates | None:
    """Certificates by kind, and how they were found."""
    witness, weighted = result.witness, result.weighted
    made = {name.split(".")[-2]: one for name, one in certificates(result).items()}
    if witness is not None and "falsified" not in made:
        return None
    beside = {name: getattr(result, name) for name in BESIDE} | {"reasons": dict(result.reasons)}
    beside |= {"kind": witness and witness.kind}
    beside |= {"weighted": weighted and [weighted.states, weighted.looked_at, weighted.reason]}
    return KeptCertificates(made, beside)


def _rebuilt(kept: KeptCertificates, controlled: ControlledArm, model: RobotModel) -> EpsilonResult | None:
    """The answer, if the certificates are of these gains and this arm."""
    made, beside = dict(kept.certificates), kept.beside
    at, witness = _witness(made.pop("falsified", None), controlled, beside["kind"])
    proofs = {kind: _proof(one, controlled) for kind, one in made.items()}
    scalar_proof, weighted = proofs.get("scalar"), None
    published, scalar, reasons = by_forms(controlled)
    if scalar_proof is not None and scalar_proof.loop.eps0 != scalar.eps0:
        return None
    if beside["weighted"] is not None:  # that of Λ = I where the search came to no other
        states, looked_at, reason = beside["weighted"]
        proof = proofs.get("weighted") or proofs["certified"]
        weighted = Weighted(proof, int(states), int(looked_at), str(reason))
    said = {name: str(text) for name, text in (beside["reasons"] | reasons).items()}
    found = {name: beside[name] for name in BESIDE} | {
        "published": published,
        "scalar": scalar.eps0,
        "model": model,
    }
    return put_together(
        controlled, at, witness, proofs.get("certified"), scalar_proof, weighted, said, **found
    )


def _proof(one: Read, controlled: ControlledArm) -> DecreaseProof:
    """The proof of a certificate, which was judged when it was taken and must be of what is asked now."""
    stated, proof = one.statement, one.proof
    if not isinstance(stated, Decreasing) or not isinstance(proof, PositiveAndDecreasing):
        raise TypeError("no proof of an ε₀")
    rate, inertia = proof.rate, proof.inertia
    if not isinstance(rate, BoxTree | LinkBounds) or not isinstance(
        inertia, Bisection | Links | MassAtCorners
    ):
        raise TypeError("no proof of the search for ε₀")
    judged = JudgedStatement(stated, proof, one.verdict, one.grade)
    result = DecreaseProof(controlled.loop(stated.eps0, stated.coupling), rate, inertia, judged=judged)
    if result.statement != stated:
        raise ValueError("other gains or another arm")
    return result


def _witness(
    one: Read | None, controlled: ControlledArm, kind: Any
) -> tuple[ControlledArm, RisingState | None]:
    """The state of a certificate, and the arm that it is a state of, one of those meant."""
    if one is None:
        return controlled, None
    stated, state, plant = one.statement, one.proof, controlled.model
    if not isinstance(stated, Decreasing) or not isinstance(state, StateWitness):
        raise TypeError("no witness against an ε₀")
    if stated != statement_of(controlled.loop(stated.eps0)):
        raise ValueError("other gains or another arm")
    at = controlled
    if controlled.ranges:
        values = {f"viscous {i}": number for i, number in enumerate(state.viscous)}
        values |= dict(zip(plant.parameters, state.parameters, strict=True))
        at = replace(controlled, model=at_corner(plant, plant, values), ranges=False)
    return at, confirmed(at, stated.eps0, str(kind), State(state.q, state.e, state.w))
