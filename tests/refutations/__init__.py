"""Faults planted by a program in the statements of the proofs; none that is false may come back proved."""
