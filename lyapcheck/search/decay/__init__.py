"""How fast V falls: times to the goal, and what disturbances can do; proposed here, judged by ``check``."""
