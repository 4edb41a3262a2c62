"""Claims: statements as data, the procedures that decide them, and the running of a proof script.

A proof script needs nothing but the names below; ``run_proof``, which no script needs, is imported where it
is first asked for.
"""

from types import ModuleType as _Module
from typing import Any as _Any

from lyapcheck.check.kinds.all_of import AllOf as AllOf
from lyapcheck.check.kinds.bound_every_n import BoundEveryN as BoundEveryN
from lyapcheck.check.kinds.constant import Agrees as Agrees
from lyapcheck.check.kinds.constant import Constant as Constant
from lyapcheck.check.kinds.decreasing import DampingBelow as DampingBelow
from lyapcheck.check.kinds.decreasing import Decreasing as Decreasing
from lyapcheck.check.kinds.every_n import EveryN as EveryN
from lyapcheck.check.kinds.for_all import ForAll as ForAll
from lyapcheck.check.kinds.for_small import ForSmall as ForSmall
from lyapcheck.check.kinds.identity import Identity as Identity
from lyapcheck.check.kinds.implies import Implies as Implies
from lyapcheck.check.kinds.norm_bound import NormBound as NormBound
from lyapcheck.check.kinds.sampled import SampledStable as SampledStable
from lyapcheck.check.statement import Relation as Relation
from lyapcheck.check.statement import Statement as Statement
from lyapcheck.check.statement import Variable as Variable
from lyapcheck.claims.arguments import along as along
from lyapcheck.claims.arguments import at_arm as at_arm
from lyapcheck.claims.arguments import cascade as cascade
from lyapcheck.claims.arguments import converges as converges
from lyapcheck.claims.arguments import exponential as exponential
from lyapcheck.claims.arguments import input_to_state as input_to_state
from lyapcheck.claims.arguments import lasalle as lasalle
from lyapcheck.claims.arguments import property_of as property_of
from lyapcheck.claims.arguments import rate_at_most as rate_at_most
from lyapcheck.claims.arguments import rate_definite as rate_definite
from lyapcheck.claims.arguments import step as step
from lyapcheck.claims.arguments import strict as strict
from lyapcheck.claims.arguments import uniform as uniform
from lyapcheck.claims.bounds import ArmBounds as ArmBounds
from lyapcheck.claims.bounds import FamilyBounds as FamilyBounds
from lyapcheck.claims.bounds import above as above
from lyapcheck.claims.bounds import below as below
from lyapcheck.claims.bounds import coriolis_at_rest as coriolis_at_rest
from lyapcheck.claims.bounds import coriolis_bounded as coriolis_bounded
from lyapcheck.claims.bounds import coriolis_matrix as coriolis_matrix
from lyapcheck.claims.bounds import gravity_bounded as gravity_bounded
from lyapcheck.claims.bounds import gravity_bounds as gravity_bounds
from lyapcheck.claims.bounds import gravity_vector as gravity_vector
from lyapcheck.claims.bounds import largest_with as largest_with
from lyapcheck.claims.bounds import mass_bounded as mass_bounded
from lyapcheck.claims.bounds import mass_matrix as mass_matrix
from lyapcheck.claims.bounds import mass_positive as mass_positive
from lyapcheck.claims.bounds import mass_symmetric as mass_symmetric
from lyapcheck.claims.bounds import rate_less_twice_coriolis as rate_less_twice_coriolis
from lyapcheck.claims.bounds import rate_of as rate_of
from lyapcheck.claims.bounds import rate_of_mass as rate_of_mass
from lyapcheck.claims.bounds import torque_limits as torque_limits
from lyapcheck.claims.claim import Case as Case
from lyapcheck.claims.claim import Claim as Claim
from lyapcheck.claims.claim import Lacking as Lacking
from lyapcheck.claims.claim import Proof as Proof
from lyapcheck.claims.claim import lacking as lacking
from lyapcheck.claims.expressions import Expr as Expr
from lyapcheck.claims.expressions import atan as atan
from lyapcheck.claims.expressions import cos as cos
from lyapcheck.claims.expressions import cosh as cosh
from lyapcheck.claims.expressions import dh as dh
from lyapcheck.claims.expressions import diff as diff
from lyapcheck.claims.expressions import exp as exp
from lyapcheck.claims.expressions import expr as expr
from lyapcheck.claims.expressions import gamma as gamma
from lyapcheck.claims.expressions import h as h
from lyapcheck.claims.expressions import log as log
from lyapcheck.claims.expressions import pi as pi
from lyapcheck.claims.expressions import potential as potential
from lyapcheck.claims.expressions import rho as rho
from lyapcheck.claims.expressions import secant_bound as secant_bound
from lyapcheck.claims.expressions import sin as sin
from lyapcheck.claims.expressions import sinh as sinh
from lyapcheck.claims.expressions import sqrt as sqrt
from lyapcheck.claims.expressions import tanh as tanh
from lyapcheck.claims.expressions import total as total
from lyapcheck.claims.expressions import var as var
from lyapcheck.claims.flows import converges_to as converges_to
from lyapcheck.claims.flows import enters as enters
from lyapcheck.claims.flows import global_ as global_
from lyapcheck.claims.flows import local as local
from lyapcheck.claims.flows import system as system
from lyapcheck.claims.goals import constant_goal as constant_goal
from lyapcheck.claims.goals import moving_goal as moving_goal
from lyapcheck.claims.goals import norm as norm
from lyapcheck.claims.letters import AnyMatrix as AnyMatrix
from lyapcheck.claims.letters import AnyVector as AnyVector
from lyapcheck.claims.letters import any_matrix as any_matrix
from lyapcheck.claims.letters import any_vector as any_vector
from lyapcheck.claims.letters import apply as apply
from lyapcheck.claims.letters import at_most_every_n as at_most_every_n
from lyapcheck.claims.letters import diagonal as diagonal
from lyapcheck.claims.letters import dot as dot
from lyapcheck.claims.letters import every_n as every_n
from lyapcheck.claims.letters import form as form
from lyapcheck.claims.letters import matrix as matrix
from lyapcheck.claims.letters import plus as plus
from lyapcheck.claims.letters import rate as rate
from lyapcheck.claims.letters import scaled as scaled
from lyapcheck.claims.letters import transpose as transpose
from lyapcheck.claims.letters import vector as vector
from lyapcheck.claims.letters import zero_vector as zero_vector
from lyapcheck.claims.script import companion as companion
from lyapcheck.claims.statements import Reals as Reals
from lyapcheck.claims.statements import agrees as agrees
from lyapcheck.claims.statements import all_of as all_of
from lyapcheck.claims.statements import damping_below as damping_below
from lyapcheck.claims.statements import decreasing as decreasing
from lyapcheck.claims.statements import for_all as for_all
from lyapcheck.claims.statements import identity as identity
from lyapcheck.claims.statements import implies as implies
from lyapcheck.claims.statements import nonnegative as nonnegative
from lyapcheck.claims.statements import norm_bound as norm_bound
from lyapcheck.claims.statements import positive as positive
from lyapcheck.claims.statements import reals as reals
from lyapcheck.claims.statements import sampled as sampled

__all__ = [name for name, value in globals().items() if name[0] != "_" and not isinstance(value, _Module)]


def __getattr__(name: str) -> _Any:
    if name == "run_proof":
        from lyapcheck.answers.check.run import run_proof

        return run_proof
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
