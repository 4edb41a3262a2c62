"""The Lyapunov function of the paper: V, dV/dt, its quadratic form Q and scalar bounds, in several arithmetics."""
