"""Gains as a computer runs them, on an arm of which the controller does not know all that pulls at it."""
