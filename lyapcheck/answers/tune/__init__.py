"""Tuning: the largest gains that an arm's limits admit, by a convex program and exact rounding."""

from lyapcheck.answers.tune.answer import Tuning
from lyapcheck.answers.tune.gain_file import gain_file_text
from lyapcheck.answers.tune.results import TunedJoint, TunedSet
from lyapcheck.answers.tune.targets import Targets
from lyapcheck.answers.tune.tuning import tune

__all__ = ["Targets", "TunedJoint", "TunedSet", "Tuning", "gain_file_text", "tune"]
