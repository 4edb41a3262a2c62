"""V and dV/dt, symbolic, in floating point and compiled."""
