"""Reference trajectories q_d(t): sines, minimum jerk, recorded motions."""

from lyapcheck.tracking.reference.base import MinimumJerk, Reference, Sine, Suprema
from lyapcheck.tracking.reference.file import read_reference
from lyapcheck.tracking.reference.recorded import Recorded

__all__ = ["MinimumJerk", "Recorded", "Reference", "Sine", "Suprema", "read_reference"]
