"""How large ε₀ may be: published, scalar, certified and falsified, with certificates.

The searches propose, the checker disposes; this folder asks them in turn and holds their answers together.
"""

from lyapcheck.answers.epsilon.compute import epsilon
from lyapcheck.answers.epsilon.four import Contradiction
from lyapcheck.answers.epsilon.options import Options
from lyapcheck.answers.epsilon.result import EpsilonResult, EpsilonResults

__all__ = ["Contradiction", "EpsilonResult", "EpsilonResults", "Options", "epsilon"]
