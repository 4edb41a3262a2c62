"""Robot models: exact trigonometric polynomials with the provenance of every number.

Adding an arm is adding one file to ``arms/``; see `lyapcheck.robots.armfile` for its form. Indices of
joints count from 0 in Python and from 1 in names (s1, M11), q is in rad, and angles are measured as the
arm file says, from the downward vertical in the built-in arms.
"""

from lyapcheck.robots.fields import Number
from lyapcheck.robots.plant import RobotModel
from lyapcheck.robots.registry import load, names

__all__ = ["Number", "RobotModel", "load", "names"]
