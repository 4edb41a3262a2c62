"""The Lyapunov function: V, dV/dt, the quadratic form Q and its scalar bounds, in several arithmetics."""
