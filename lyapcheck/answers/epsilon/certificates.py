"""The certificates of ε₀: dV/dt < 0 everywhere for the certified one, a state against the falsified one."""

from __future__ import annotations

from typing import TYPE_CHECKING

from lyapcheck.certificate import Certificate
from lyapcheck.check.certificate import About
from lyapcheck.check.kinds.decreasing import StateWitness, statement_of
from lyapcheck.check.statement import Proof, Statement
from lyapcheck.files.decimals import decimal_text
from lyapcheck.files.fields import file_stem

if TYPE_CHECKING:
    from collections.abc import Sequence
    from fractions import Fraction

    from lyapcheck.answers.epsilon import EpsilonResult
    from lyapcheck.answers.epsilon.four import Refutation
    from lyapcheck.search.falsify import RisingState

PROOF = "epsilon"


def certificates(result: EpsilonResult) -> dict[str, Certificate]:
    """Certificates by file name: of each ε₀ that is called certified, of the scalar one if it has one."""
    made: dict[str, Certificate] = {}

    def add(file: str, kind: str, says: str, statement: Statement, verdict: str, proof: Proof) -> None:
        about = About(f"{result.name}.{kind}", says, result.m, len(result.gains.kp), PROOF)
        certificate = Certificate(about, statement, verdict, "enclosure", proof)
        made[f"{file_stem(result.name)}.{file}.json"] = certificate

    weighted, witness = result.weighted, result.witness
    known = {
        ("certified", "proved"): result.proof,
        ("scalar", "scalar"): result.scalar_proof,
        ("weighted", "weighted"): weighted.proof if weighted and weighted.proof.coupling else None,
    }
    for (file, kind), proof in known.items():
        if proof is not None:
            says = _says(result, proof.eps0, proof.coupling)
            add(file, kind, says, proof.statement, "proved", proof.certificate)
    if witness is not None and (against := result.against) is not None:
        stated, state = statement_of(against.loop), _state(witness, against)
        says = _says(result, against.loop.eps0, against.loop.coupling)
        add("falsified", "refuted", says, stated, "refuted", state)
    return made


def _state(witness: RisingState, at: Refutation) -> StateWitness:
    """A state, and what is uncertain about the arm that it is a state of."""
    return StateWitness(at.viscous, at.parameters, witness.state.q, witness.state.e, witness.state.w)


def _says(result: EpsilonResult, eps0: Fraction, coupling: Sequence[Fraction]) -> str:
    arms = "for every arm in its ranges" if result.ranges else "at nominal numbers"
    weights = ", ".join(decimal_text(scale) for scale in coupling)
    return (
        f"dV/dt < 0 at every state but the origin: {result.name} on {result.robot}, {arms}, "
        f"ε₀ = {decimal_text(eps0)}{f', Λ = diag({weights})' if weights else ''}"
    )
