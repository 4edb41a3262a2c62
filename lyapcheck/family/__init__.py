"""The bounded functions that shape errors and rates into torques: a file each, behind one protocol."""

from lyapcheck.family.base import CasadiForms, Family, FamilyConstants, SymbolicForms
from lyapcheck.family.registry import algebraic, arctan, hyperbolic, linear, named, names, tanh

__all__ = [
    "CasadiForms",
    "Family",
    "FamilyConstants",
    "SymbolicForms",
    "algebraic",
    "arctan",
    "hyperbolic",
    "linear",
    "named",
    "names",
    "tanh",
]
