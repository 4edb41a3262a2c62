"""How large ε₀ may be: published, scalar, certified and falsified, with certificates.

The searches propose, the checker disposes; this room asks them in turn and holds their answers together.
"""

from lyapcheck.admissible.compute import epsilon
from lyapcheck.admissible.consistency import Contradiction
from lyapcheck.admissible.result import EpsilonResult

__all__ = ["Contradiction", "EpsilonResult", "epsilon"]
