"""Bounds in ‖e‖ alone, of M and of dV/dt < 0: here, so that certificates by them are read.

References: ``reyes2019family`` (11), (12), (15).
"""

from lyapcheck.check.loop.radial import RadialBounds

__all__ = ["RadialBounds"]
