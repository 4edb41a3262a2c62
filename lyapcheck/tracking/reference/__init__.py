"""Reference trajectories q_d(t): sines, minimum jerk, recorded motions."""

from lyapcheck.tracking.reference.base import Reference, Suprema
from lyapcheck.tracking.reference.file import read_reference
from lyapcheck.tracking.reference.minimum_jerk import MinimumJerk
from lyapcheck.tracking.reference.recorded import Recorded
from lyapcheck.tracking.reference.sine import Sine

__all__ = ["MinimumJerk", "Recorded", "Reference", "Sine", "Suprema", "read_reference"]
