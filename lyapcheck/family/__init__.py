"""The bounded functions that shape errors and rates into torques: a file each, behind one protocol."""

from lyapcheck.family.base import (
    Family,
    FamilyConstants,
    NumericForms,
    SymbolicForms,
    hyperbolic,
    named,
    names,
)

__all__ = ["Family", "FamilyConstants", "NumericForms", "SymbolicForms", "hyperbolic", "named", "names"]
