"""Statements about every state: norms first, then a search for a state, then branch and bound.

References: ``reyes2019family`` (12), (15), (19).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING

from flint import ctx

from lyapcheck.check.expressions.expression import ball
from lyapcheck.check.kinds.decreasing import (
    BoxTree,
    DampingAbove,
    DampingBelow,
    Decreasing,
    PositiveAndDecreasing,
    StateWitness,
)
from lyapcheck.check.kinds.inertia import Bisection
from lyapcheck.check.kinds.resting import AtBounds, Resting, RestWitness
from lyapcheck.check.kinds.sampled import GOAL, SampledStable
from lyapcheck.check.kinds.sampled_from_rest import SampledFromRest
from lyapcheck.check.loop import certifies
from lyapcheck.check.numbers.polynomials import Enclosure
from lyapcheck.claims.procedures.identity import find_constant
from lyapcheck.claims.procedures.inertia import find_mass_above
from lyapcheck.claims.search_result import (
    SearchResult,
    broken,
    entries,
    failing,
    procedure,
    shown,
    still_open,
)
from lyapcheck.control.judgement import proves, refutes
from lyapcheck.control.sampling import largest_periods, sampled_proof
from lyapcheck.errors import installed
from lyapcheck.files.decimals import decimal_text, significant_down, significant_up
from lyapcheck.robots import Number
from lyapcheck.robots.dynamics import FEW_JOINTS
from lyapcheck.search.controlled_arm import mass_proof
from lyapcheck.verdicts import Verdict

if TYPE_CHECKING:
    from lyapcheck.search.controlled_arm import ControlledArm


METHOD = "every state"
STARTS = 6
MAX_BOXES = 60_000
HALVINGS = 40
FACTORS = tuple(Fraction(k) for k in (1, 2, 10, 100))
ONE_BOX = BoxTree(".")


@procedure(Decreasing)
def find_decreasing(statement: Decreasing) -> SearchResult:
    """Norms alone, else a state with dV/dt > 0, else boxes."""
    loop = statement.closed_loop
    positive = find_mass_above(statement.mass_positive)
    if positive.verdict is not Verdict.PROVED:
        return replace(positive, reason=f"M ≻ 0: {positive.reason}" if positive.reason else "")
    if not loop.admissible:
        return still_open("K_p, K_v, B, K_p − ¼ε₀LK_v and ε₀ must be positive, and M symmetric", METHOD)
    if certifies(loop.tail, loop.eps0):
        return shown(_with_mass(statement, ONE_BOX), f"{METHOD}: norms alone")
    if statement.coupling:
        return still_open(
            "norms do not suffice, and no boxes are tried for weights; take a smaller ε₀", METHOD
        )
    return _against(statement) or _by_boxes(statement)


def _with_mass(statement: Decreasing | DampingBelow, by: BoxTree) -> PositiveAndDecreasing:
    """The boxes with what shows M ≻ 0."""
    inertia = Bisection() if statement.parameters else mass_proof(statement.mass)
    return PositiveAndDecreasing(inertia, by)


@procedure(DampingBelow)
def find_damping_below(statement: DampingBelow) -> SearchResult:
    """Look for a κ that breaks the bound and an ε₀ at which norms alone give dV/dt < 0; never proves."""
    positive = find_mass_above(statement.mass_positive)
    if positive.verdict is not Verdict.PROVED:
        return still_open(f"M ≻ 0 is not shown: {positive.reason or 'it is refuted'}", METHOD)
    for factor in _factors(statement):
        numbers = find_constant(statement.below(factor))
        eps0 = _small_enough(statement.with_damping(factor, Fraction(1)))
        if numbers.witness is None or numbers.proof is None or eps0 is None:
            continue
        gains = {"factor of K_v": str(factor), "eps0": str(eps0)}
        witness = {**numbers.witness, "point": gains}
        proof = DampingAbove(factor, eps0, numbers.proof, _with_mass(statement, ONE_BOX))
        return broken(proof, f"{METHOD}: gains that break the bound and have dV/dt < 0", witness)
    return still_open(
        "no gains that break the bound were found to have dV/dt < 0; friction may be lacking", METHOD
    )


def _factors(statement: DampingBelow) -> Iterator[Fraction]:
    """1, then factors that bring λmax(K_v) to the bound and beyond."""
    yield Fraction(1)
    with ctx.workprec(64):
        bound = Enclosure.from_arb(ball(statement.bound)).upper
    for factor in FACTORS:
        scaled = (bound / max(statement.kv) * factor).limit_denominator(1000)
        yield scaled if scaled > 0 else factor


def _small_enough(statement: Decreasing) -> Fraction | None:
    """A power of ½ for ε₀ at which norms alone give dV/dt < 0."""
    for power in range(HALVINGS):
        eps0 = Fraction(1, 2**power)
        loop = replace(statement, eps0=eps0).closed_loop
        if loop.admissible and certifies(loop.tail, eps0):
            return eps0
    return None


def _against(statement: Decreasing) -> SearchResult | None:
    """The states that refute the smallest ε₀ are tried at this one."""
    from lyapcheck.check.loop.states import confirms_positive, rate
    from lyapcheck.search.falsify import falsify

    controlled = controlled_arm_of(statement)
    worst = falsify(controlled, STARTS)
    if worst is None or worst.eps0 > statement.eps0:
        return None
    if not confirms_positive(controlled.arm, controlled.controller, statement.eps0, worst.state):
        return None
    state, middle = worst.state, _middles(statement)
    proof = StateWitness(middle[0], middle[1], state.q, state.e, state.w)
    slope = rate(controlled.arm, controlled.controller, statement.eps0, state, 256)
    place = entries(q=state.q, e=state.e, w=state.w)
    witness = failing(place, Enclosure.from_arb(slope), "<", 0)
    return broken(proof, f"{METHOD}: a state with dV/dt > 0", witness)


def _by_boxes(statement: Decreasing) -> SearchResult:
    from lyapcheck.search.certified import certify
    from lyapcheck.search.schur import SchurProblem

    if len(statement.kp) > FEW_JOINTS:
        return still_open(f"norms do not suffice, and boxes are tried up to {FEW_JOINTS} joints", METHOD)
    outcome = certify(SchurProblem(statement.closed_loop), MAX_BOXES)
    if not outcome.proved:
        return still_open(f"branch and bound: {outcome.reason}; take a smaller ε₀", METHOD)
    tree = _with_mass(statement, BoxTree(outcome.tree))
    return shown(tree, f"{METHOD}: branch and bound", boxes=outcome.tree.count("."))


def controlled_arm_of(statement: Decreasing) -> ControlledArm:
    """The arm at the middle of its ranges under the controller, for a search."""
    from lyapcheck.control.gains import GainSet
    from lyapcheck.search.controlled_arm import ControlledArm
    from lyapcheck.search.sampled import arm_of_terms

    gains = GainSet("gains", statement.m, statement.kp, statement.kv, statement.family)
    arm = arm_of_terms(statement.mass, statement.parameters).fixed()
    joints = tuple(f"joint {i + 1}" for i in range(len(statement.kp)))
    viscous = tuple(map(Number, _middles(statement)[0]))
    return ControlledArm(gains, replace(arm, joints=joints, viscous=viscous))


def _middles(statement: Decreasing) -> tuple[tuple[Fraction, ...], tuple[Fraction, ...]]:
    """Friction, and parameters, as far as there are any, in the middle of their ranges."""
    ranges = (statement.viscous, statement.parameters)
    viscous, parameters = (tuple((low + high) / 2 for low, high in ends) for ends in ranges)
    return viscous, parameters


# --- Gains on a computer: by (S), by an unstable goal, or from starts at rest by an energy that falls, (P).

SAMPLED = "friction above the held torque, (S)"
DIGITS = 4


@procedure(SampledStable)
def find_sampled(statement: SampledStable) -> SearchResult:
    """By (S) or an unstable goal; else up to which period (S) holds, and with how much friction it would."""
    proof = sampled_proof(statement)
    period = min(largest_periods(statement))
    reach = "" if period <= 0 else f"{decimal_text(significant_down(1000 * period, DIGITS))} ms"
    if proves(statement, proof):
        return shown(proof, SAMPLED, largest_period=reach)
    if statement.conclusion == GOAL and not statement.k_g and installed("numpy") and installed("scipy"):
        from lyapcheck.search.sampled import refuted_at, witness_of

        against = refuted_at(statement, statement.period)
        if against is not None:
            return broken(against, "growing motion at one goal, (R)", witness_of(against))
    rows = zip(statement.viscous_min, statement.needed(statement.k_g or proof.k_g), strict=True)
    more = [
        f"b_{i} > {decimal_text(significant_up(want, DIGITS))}"
        for i, (have, want) in enumerate(rows, 1)
        if have <= want
    ]
    far = f"holds for T < {reach}" if reach else "holds for no T"
    return still_open(f"(S) {far}; {' and '.join(more)} N·m·s/rad would do", SAMPLED)


@procedure(SampledFromRest)
def find_from_rest(statement: SampledFromRest) -> SearchResult:
    """By an energy that falls on the set that the starts lie in."""
    method = "an energy that falls, (P)"
    from lyapcheck.search.sampled_energy import falling_energy

    proof = falling_energy(statement)
    if proof is not None:
        return shown(proof, method)
    return still_open(
        "no falling sampled energy is found; take a shorter period or starts nearer to the goal", method
    )


# --- Where an arm may come to rest: decided by h at the bounds, or by a state of rest beyond one of them.

RESTING = "states of rest"
BEYOND = Fraction(1, 10**6)
"""rad: how far beyond a bound a state against it is looked for."""


@procedure(Resting)
def find_resting(statement: Resting) -> SearchResult:
    """By h at the bounds, else by a state of rest just beyond one of them."""
    proof = AtBounds()
    if proves(statement, proof):
        return shown(proof, RESTING)
    for joint, bound in enumerate(statement.errors):
        against = RestWitness(joint, (bound or Fraction(0)) + BEYOND)
        if bound is not None and refutes(statement, against):
            witness = failing({f"e{joint + 1}": against.error}, against.error, "<=", bound)
            return broken(against, f"{RESTING}: one beyond a bound", witness)
    return still_open("h at the bounds does not decide it; take larger bounds", RESTING)
