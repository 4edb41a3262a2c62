"""Lyapunov's direct method applied to a closed loop, and what its hypotheses come to."""
