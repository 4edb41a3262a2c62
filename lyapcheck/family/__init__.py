"""The bounded functions that shape errors and rates into torques: a file each, behind one protocol."""

from lyapcheck.family.base import Family, FamilyConstants, NumericForms, SymbolicForms
from lyapcheck.family.registry import algebraic, arctan, hyperbolic, linear, named, names, tanh

__all__ = [
    "Family",
    "FamilyConstants",
    "NumericForms",
    "SymbolicForms",
    "algebraic",
    "arctan",
    "hyperbolic",
    "linear",
    "named",
    "names",
    "tanh",
]
