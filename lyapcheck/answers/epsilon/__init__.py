"""How large ε₀ may be: published, scalar, certified and falsified, with certificates.

The searches propose, the checker disposes; this folder asks them in turn and holds their answers together.
"""

from lyapcheck.answers.epsilon.answer import EpsilonResult, EpsilonResults
from lyapcheck.answers.epsilon.compute import Contradiction, Options, epsilon
from lyapcheck.answers.epsilon.kept import certificates, kept_epsilon

__all__ = [
    "Contradiction",
    "EpsilonResult",
    "EpsilonResults",
    "Options",
    "certificates",
    "epsilon",
    "kept_epsilon",
]
