"""Tuning: the largest gains that an arm's limits admit, by a convex program and exact rounding."""

from lyapcheck.tune.gain_file import gain_file_text
from lyapcheck.tune.results import TunedJoint, TunedSet, Tuning
from lyapcheck.tune.targets import Targets
from lyapcheck.tune.tuning import tune

__all__ = ["Targets", "TunedJoint", "TunedSet", "Tuning", "gain_file_text", "tune"]
