"""The certificates of ε₀: dV/dt < 0 everywhere for the certified one, a state against the falsified one."""

from __future__ import annotations

from importlib.metadata import version
from typing import TYPE_CHECKING

from lyapcheck.check.certificate import About, Certificate
from lyapcheck.check.kinds.decreasing import StateWitness, statement_of
from lyapcheck.check.statement import Proof
from lyapcheck.files.decimals import decimal_text
from lyapcheck.files.names import file_stem

if TYPE_CHECKING:
    from lyapcheck.answers.epsilon import EpsilonResult
    from lyapcheck.check.loop import Closure

PROOF = "epsilon"


def certificates(result: EpsilonResult) -> dict[str, Certificate]:
    """Certificates by file name: of each ε₀ that is called certified, of the scalar one if it has one."""
    stem, found = file_stem(result.name), {}
    if result.proof is not None:
        found[f"{stem}.certified.json"] = _certificate(
            result, result.proof.closure, "proved", result.proof.certificate
        )
    if result.scalar_proof is not None:
        proof = result.scalar_proof
        found[f"{stem}.scalar.json"] = _certificate(
            result, proof.closure, "proved", proof.certificate, "scalar"
        )
    if result.weighted is not None:
        proof = result.weighted.proof
        found[f"{stem}.weighted.json"] = _certificate(result, proof.closure, "proved", proof.certificate)
    if result.witness is not None and result.against is not None:
        state, against = result.witness.state, result.against
        proof_against = StateWitness(against.viscous, against.parameters, state.q, state.e, state.w)
        found[f"{stem}.falsified.json"] = _certificate(result, against.closure, "refuted", proof_against)
    return found


def _certificate(
    result: EpsilonResult, closure: Closure, verdict: str, proof: Proof, kind: str = ""
) -> Certificate:
    arms = "for every arm in its ranges" if result.ranges else "at nominal numbers"
    says = (
        f"dV/dt < 0 at every state but the origin: {result.name} on {result.robot}, "
        f"{arms}, ε₀ = {decimal_text(closure.eps0)}"
    )
    weights = ", ".join(decimal_text(scale) for scale in closure.coupling)
    says += f", Λ = diag({weights})" if weights else ""
    kind = kind or ("weighted" if weights else verdict)
    about = About(f"{result.name}.{kind}", says, result.m, closure.n, PROOF)
    used = {name: version(name) for name in ("lyapcheck", "python-flint")}
    return Certificate(about, statement_of(closure), verdict, "enclosure", proof, {}, used)
