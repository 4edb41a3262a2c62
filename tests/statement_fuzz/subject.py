"""What is fuzzed: all that this package takes from lyapcheck, but for its words for writing statements."""

from __future__ import annotations

from typing import Any

from lyapcheck.certificate import Certificate, to_json
from lyapcheck.check.certificate import About
from lyapcheck.check.expressions.expression import FAMILY, FUNCTIONS
from lyapcheck.check.kinds.agrees import Agrees, OutsideRounding, PrintedInputs
from lyapcheck.check.kinds.all_of import AllOf
from lyapcheck.check.kinds.bound_every_n import BoundEveryN
from lyapcheck.check.kinds.constant import Constant, ExactNumbers, SeparateBalls
from lyapcheck.check.kinds.coriolis import (
    CoriolisAtRest,
    CoriolisTorque,
    MassSymmetric,
    RateLessTwiceCoriolis,
    RateOfMass,
)
from lyapcheck.check.kinds.coriolis_below import CoriolisBelow
from lyapcheck.check.kinds.damping import DampingBelow
from lyapcheck.check.kinds.decreasing import Decreasing
from lyapcheck.check.kinds.every_n import EveryN, Given
from lyapcheck.check.kinds.for_all import Boxes, ForAll, Pieces, Sturm
from lyapcheck.check.kinds.for_small import ForSmall, LeadingTerm
from lyapcheck.check.kinds.gravity import GravityBelow, GravityOfPotential
from lyapcheck.check.kinds.identity import Identity, NormalForm
from lyapcheck.check.kinds.implies import Implies
from lyapcheck.check.kinds.inertia import MassAbove, MassBelow
from lyapcheck.check.kinds.norm_bound import NormBound, Supremum
from lyapcheck.check.kinds.property import Property
from lyapcheck.check.kinds.resting import Resting
from lyapcheck.check.kinds.signs import SignIdentity
from lyapcheck.check.kinds.stability import Stable
from lyapcheck.check.kinds.trigonometric import TrigonometricBound, TrigonometricPositive
from lyapcheck.check.statement import Proof, Relation, Statement, Variable, Witness
from lyapcheck.claims.case import Case
from lyapcheck.claims.procedures import propose
from tests.statement_fuzz.proposed import Proposed, decide_proposed

__all__ = [
    "FAMILY",
    "FUNCTIONS",
    "About",
    "Agrees",
    "AllOf",
    "BoundEveryN",
    "Boxes",
    "Case",
    "Certificate",
    "Constant",
    "CoriolisAtRest",
    "CoriolisBelow",
    "CoriolisTorque",
    "DampingBelow",
    "Decreasing",
    "EveryN",
    "ExactNumbers",
    "ForAll",
    "ForSmall",
    "Given",
    "GravityBelow",
    "GravityOfPotential",
    "Identity",
    "Implies",
    "LeadingTerm",
    "MassAbove",
    "MassBelow",
    "MassSymmetric",
    "NormBound",
    "NormalForm",
    "OutsideRounding",
    "Pieces",
    "PrintedInputs",
    "Proof",
    "Property",
    "RateLessTwiceCoriolis",
    "RateOfMass",
    "Relation",
    "Resting",
    "SeparateBalls",
    "SignIdentity",
    "Stable",
    "Statement",
    "Sturm",
    "Supremum",
    "TrigonometricBound",
    "TrigonometricPositive",
    "Variable",
    "Witness",
    "decide",
    "to_json",
]


def decide(statement: Any) -> Any:
    """The verdict that the search proposes and the rules of the checker accept."""
    return decide_proposed(statement) if isinstance(statement, Proposed) else propose(statement)
