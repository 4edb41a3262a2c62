"""Thousands of runs of the closed loop at once, by compiled code or NumPy in the same steps of DOP853."""
