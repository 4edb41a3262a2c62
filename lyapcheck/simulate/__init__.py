"""The closed loop in motion: the reference simulation of (11), the bench experiment, performance indices."""
