"""Tuning: the largest gains that an arm's limits admit, by a convex program and exact rounding."""

from lyapcheck.tune.targets import Targets
from lyapcheck.tune.tuning import tune

__all__ = ["Targets", "tune"]
