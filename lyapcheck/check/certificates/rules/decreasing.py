"""dV/dt < 0 at every state but the origin: by a tree of boxes, and against it by one state.

References: ``reyes2019family`` (11), (12), (15).
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from lyapcheck.check.certificates.proofs import BoxTree, RadialBounds, StateWitness
from lyapcheck.check.certificates.refusal import Refused, require
from lyapcheck.check.certificates.statements import Decreasing, Ends, Monomials
from lyapcheck.check.certificates.verify import Accepted, rule
from lyapcheck.check.members import member
from lyapcheck.check.stability import Closure, proves
from lyapcheck.check.stability.radial import Radial, proves_radially
from lyapcheck.check.states import Arm, Controller, State, confirms_positive


@rule(Decreasing, BoxTree)
def by_tree(statement: Decreasing, proof: BoxTree) -> Accepted:
    """Soundness: ``lyapcheck.check.stability``."""
    closure = closure_of(statement)
    require(closure.admissible, "gains, friction or ε₀", "", "K_p, K_v, B, K̃ and ε₀ must be positive, M = Mᵀ")
    if not proves(closure, proof.tree):
        raise Refused("tree", f"of {proof.tree.count('.')} boxes", "has a box on which P ≻ 0 is not shown")
    return Accepted("proved", "enclosure")


@rule(Decreasing, RadialBounds)
def by_radial_bounds(statement: Decreasing, proof: RadialBounds) -> Accepted:
    """Soundness: ``lyapcheck.check.stability.radial``."""
    data = Radial(proof.weights, proof.inertia, proof.lowest, proof.angles, proof.tree, proof.cuts)
    if not proves_radially(closure_of(statement), data):
        raise Refused("bounds", "", "do not show dV/dt < 0 at every ‖e‖")
    return Accepted("proved", "enclosure")


@rule(Decreasing, StateWitness)
def by_state(statement: Decreasing, proof: StateWitness) -> Accepted:
    """Soundness: dV/dt > 0 in balls, by the plain chain rule, at one state of one arm within the ranges."""
    require(not statement.coupling, "coupling", statement.coupling, "must be empty: the state is of (13)")
    _require_within("viscous", proof.viscous, statement.viscous)
    _require_within("parameters", proof.parameters, statement.parameters)
    mass = tuple(
        tuple(_at(entry, 2 * len(statement.mass), proof.parameters) for entry in row)
        for row in statement.mass
    )
    known = member(statement.family, statement.m)
    controller = Controller(known.functions, statement.kp, statement.kv)
    state = State(proof.q, proof.e, proof.w)
    if not confirms_positive(Arm(mass, proof.viscous), controller, statement.eps0, state):
        raise Refused("state", "", "does not show dV/dt > 0")
    return Accepted("refuted", "enclosure")


def closure_of(statement: Decreasing) -> Closure:
    """The statement as the checker of trees takes it."""
    return Closure(
        arm=Arm(statement.mass, tuple(low for low, _ in statement.viscous)),
        family=statement.family,
        m=statement.m,
        kp=statement.kp,
        kv=statement.kv,
        eps0=statement.eps0,
        parameters=statement.parameters,
        viscous=statement.viscous,
        coupling=statement.coupling,
    )


def _require_within(subject: str, values: Sequence[Fraction], ranges: Sequence[Ends]) -> None:
    require(len(values) == len(ranges), subject, len(values), f"must be {len(ranges)}")
    for value, (low, high) in zip(values, ranges, strict=True):
        require(low <= value <= high, subject, value, f"must be between {low} and {high}")


def _at(entry: Monomials, angles: int, parameters: Sequence[Fraction]) -> Monomials:
    """The entry with numbers for the parameters."""
    found = []
    for powers, coefficient in entry:
        value = coefficient
        for parameter, power in zip(parameters, powers[angles:], strict=True):
            value *= parameter**power
        found.append((powers[:angles], value))
    return tuple(found)
