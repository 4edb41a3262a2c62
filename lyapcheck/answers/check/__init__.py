"""Does each claim of a proof script hold: proved, refuted with a witness, or undecided with a reason."""

from lyapcheck.answers.check.proof import ClaimResult, ProofResult

__all__ = ["ClaimResult", "ProofResult"]
