"""The closed loop in motion."""
