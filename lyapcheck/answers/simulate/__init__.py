"""How does the closed loop move, and does it keep what theory promises: set points, starts, tracking."""
