"""The controller in C, with a bound of what rounding does to its torques."""
