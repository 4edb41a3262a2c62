"""Outward-rounded interval arithmetic over NumPy arrays: every result contains every possible value."""

from lyapcheck.intervals.interval import Interval, cosine, inverse_one_plus, norm, sine, unit_vector

__all__ = ["Interval", "cosine", "inverse_one_plus", "norm", "sine", "unit_vector"]
