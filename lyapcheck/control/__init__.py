"""Gains, the limits of an arm, and the paper's conditions on both."""
