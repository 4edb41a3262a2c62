"""Thousands of runs of the closed loop at once, in steps of DOP853."""

from lyapcheck.simulate.batch.simulate import Runs, simulate_many

__all__ = ["Runs", "simulate_many"]
