"""Reference trajectories q_d(t): sines, minimum jerk, recorded motions."""

from lyapcheck.simulate.reference.base import MinimumJerk, Reference, Sine, Suprema
from lyapcheck.simulate.reference.file import read_reference
from lyapcheck.simulate.reference.recorded import Recorded

__all__ = ["MinimumJerk", "Recorded", "Reference", "Sine", "Suprema", "read_reference"]
