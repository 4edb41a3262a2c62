"""Tuning: the largest gains that limits admit, or the best for targets."""
