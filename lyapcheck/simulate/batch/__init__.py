"""Thousands of runs of the closed loop at once, in steps of DOP853."""

from lyapcheck.simulate.batch.simulate import simulate_many
from lyapcheck.simulate.batch.task import Runs

__all__ = ["Runs", "simulate_many"]
