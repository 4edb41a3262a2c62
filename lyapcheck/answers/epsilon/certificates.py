"""The certificates of ε₀: dV/dt < 0 everywhere for the certified one, a state against the falsified one."""

from __future__ import annotations

from importlib.metadata import version
from typing import TYPE_CHECKING

from lyapcheck.answers.epsilon.words import limits_text
from lyapcheck.certificate import Certificate
from lyapcheck.check.certificate import About
from lyapcheck.check.kinds.decreasing import StateWitness, statement_of
from lyapcheck.check.statement import Proof, Statement
from lyapcheck.files.decimals import decimal_text
from lyapcheck.files.names import file_stem

if TYPE_CHECKING:
    from lyapcheck.answers.epsilon import EpsilonResult
    from lyapcheck.answers.epsilon.nearby import NearbyResult
    from lyapcheck.check.loop.closed_loop import ClosedLoop

PROOF = "epsilon"


def certificates(result: EpsilonResult) -> dict[str, Certificate]:
    """Certificates by file name: of each ε₀ that is called certified, of the scalar one if it has one."""
    stem, outcome = file_stem(result.name), {}
    if result.proof is not None:
        outcome[f"{stem}.certified.json"] = _certificate(
            result, result.proof.loop, "proved", result.proof.certificate
        )
    if result.scalar_proof is not None:
        proof = result.scalar_proof
        outcome[f"{stem}.scalar.json"] = _certificate(
            result, proof.loop, "proved", proof.certificate, "scalar"
        )
    if result.weighted is not None:
        proof = result.weighted.proof
        outcome[f"{stem}.weighted.json"] = _certificate(result, proof.loop, "proved", proof.certificate)
    if result.witness is not None and result.against is not None:
        state, against = result.witness.state, result.against
        proof_against = StateWitness(against.viscous, against.parameters, state.q, state.e, state.w)
        outcome[f"{stem}.falsified.json"] = _certificate(result, against.loop, "refuted", proof_against)
    if result.nearby is not None:
        outcome |= _nearby(result, result.nearby, stem)
    return outcome


def _nearby(result: EpsilonResult, near: NearbyResult, stem: str) -> dict[str, Certificate]:
    """Of states within limits."""
    outcome = {}
    about = f"{result.name} on {result.robot}, among states with {limits_text(near.limits)} alone"
    if near.proof is not None:
        says = f"dV/dt < 0: {about}"
        outcome[f"{stem}.nearby.certified.json"] = _entry(
            result, "nearby.proved", says, near.proof.statement, "proved", near.proof.certificate
        )
    if near.witness is not None and near.against is not None:
        state, says = near.witness.state, f"not dV/dt < 0: {about}"
        against = StateWitness(near.viscous, near.parameters, state.q, state.e, state.w)
        outcome[f"{stem}.nearby.falsified.json"] = _entry(
            result, "nearby.refuted", says, near.against, "refuted", against
        )
    return outcome


def _certificate(
    result: EpsilonResult, loop: ClosedLoop, verdict: str, proof: Proof, kind: str = ""
) -> Certificate:
    arms = "for every arm in its ranges" if result.ranges else "at nominal numbers"
    says = (
        f"dV/dt < 0 at every state but the origin: {result.name} on {result.robot}, "
        f"{arms}, ε₀ = {decimal_text(loop.eps0)}"
    )
    weights = ", ".join(decimal_text(scale) for scale in loop.coupling)
    says += f", Λ = diag({weights})" if weights else ""
    kind = kind or ("weighted" if weights else verdict)
    return _entry(result, kind, says, statement_of(loop), verdict, proof)


def _entry(
    result: EpsilonResult, kind: str, says: str, statement: Statement, verdict: str, proof: Proof
) -> Certificate:
    about = About(f"{result.name}.{kind}", says, result.m, len(result.gains.kp), PROOF)
    used = {name: version(name) for name in ("lyapcheck", "python-flint")}
    return Certificate(about, statement, verdict, "enclosure", proof, {}, used)
