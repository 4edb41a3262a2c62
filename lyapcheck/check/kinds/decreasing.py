"""dV/dt < 0 at every state but the origin: by a tree of boxes, and against it by one state.

References: ``reyes2019family`` (11), (12), (15).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import chain

from lyapcheck.check.expressions.domain import Domain
from lyapcheck.check.expressions.expression import Tree
from lyapcheck.check.expressions.text import diagonal_text, number_text
from lyapcheck.check.kinds.agrees import MAX_INPUTS
from lyapcheck.check.loop import Closure, proves
from lyapcheck.check.loop.radial import Radial, proves_radially
from lyapcheck.check.loop.states import Arm, Controller, State, confirms_positive
from lyapcheck.check.numbers.members import member
from lyapcheck.check.refusal import Refused, require
from lyapcheck.check.statement import Ends, Monomials, Proof, Statement
from lyapcheck.check.verify import Accepted, rule


@dataclass(frozen=True)
class Decreasing(Statement):
    """dV/dt < 0 along (11) at every state but the origin, for every arm in the ranges.

    ``mass`` is M(q), kg·m²; ``viscous`` the range of each diagonal entry of B, N·m·s/rad; ``parameters`` the
    range of each parameter in M; ``family`` and ``m`` name h; ``kp`` and ``kv`` are in N·m, ``eps0`` is ε₀;
    ``coupling`` is the diagonal of Λ in y = w − εΛh, empty for (13).
    """

    mass: tuple[tuple[Monomials, ...], ...]
    viscous: tuple[Ends, ...]
    parameters: tuple[Ends, ...]
    family: str
    m: int | None
    kp: tuple[Fraction, ...]
    kv: tuple[Fraction, ...]
    eps0: Fraction
    coupling: tuple[Fraction, ...]

    def require_well_formed(self) -> None:
        """Refuse what the rules should not have to look at."""
        n = len(self.viscous)
        require(1 <= n <= MAX_ARM, "joints", n, f"must be from 1 to {MAX_ARM}")
        for subject in ("mass", "kp", "kv"):
            size = len(getattr(self, subject))
            require(size == n, subject, size, f"must be {n}, one a joint")
        coupling = len(self.coupling)
        require(coupling in (0, n), "coupling", coupling, f"must be empty or {n}, one a joint")
        require(all(len(row) == n for row in self.mass), "mass", "a row", f"must have {n} entries")
        length = 2 * n + len(self.parameters)
        for powers, _ in chain.from_iterable(chain.from_iterable(self.mass)):
            fits = len(powers) == length and all(0 <= p <= MAX_POWER for p in powers)
            require(fits, "exponents", powers, f"must be {length} numbers from 0 to {MAX_POWER}")
        for low, high in (*self.viscous, *self.parameters):
            require(low <= high, "range", f"[{low}, {high}]", "is empty")
        require(len(self.parameters) <= MAX_INPUTS, "parameters", len(self.parameters), "are too many")

    def terms(self) -> list[tuple[Tree, Domain]]:
        """None: M, h and V have values everywhere."""
        return []

    def text(self) -> str:
        """The statement in one line."""
        weights = f", Λ = {diagonal_text(self.coupling)}" if self.coupling else ""
        gains = f"K_p = {diagonal_text(self.kp)}, K_v = {diagonal_text(self.kv)}"
        return f"dV/dt < 0 at every state but the origin, for {gains}, ε₀ = {number_text(self.eps0)}{weights}"


@dataclass(frozen=True)
class BoxTree(Proof):
    """A tree of boxes of (q, e): in preorder, a digit for the side that is cut, a dot for a leaf."""

    rule = "tree of boxes"
    tree: str


@dataclass(frozen=True)
class RadialBounds(Proof):
    """Bounds of the parts of dV/dt in ‖e‖ alone: weights, μ, ν, boxes of some angles behind them, cuts."""

    rule = "bounds in ‖e‖"
    weights: tuple[Fraction, ...]
    inertia: Fraction
    lowest: Fraction
    angles: tuple[int, ...]
    tree: str
    cuts: tuple[Fraction, ...]


@dataclass(frozen=True)
class StateWitness(Proof):
    """An arm within the ranges and a state of it at which dV/dt > 0."""

    rule = "state"
    viscous: tuple[Fraction, ...]
    parameters: tuple[Fraction, ...]
    q: tuple[Fraction, ...]
    e: tuple[Fraction, ...]
    w: tuple[Fraction, ...]


MAX_ARM = 9


MAX_POWER = 40


@rule(Decreasing, BoxTree)
def by_tree(statement: Decreasing, proof: BoxTree) -> Accepted:
    """Soundness: ``lyapcheck.check.loop``."""
    closure = closure_of(statement)
    require(closure.admissible, "gains, friction or ε₀", "", "K_p, K_v, B, K̃ and ε₀ must be positive, M = Mᵀ")
    if not proves(closure, proof.tree):
        raise Refused("tree", f"of {proof.tree.count('.')} boxes", "has a box on which P ≻ 0 is not shown")
    return Accepted("proved", "enclosure")


@rule(Decreasing, RadialBounds)
def by_radial_bounds(statement: Decreasing, proof: RadialBounds) -> Accepted:
    """Soundness: ``lyapcheck.check.loop.radial``."""
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
