"""How Coq is to prove that dV/dt < 0 for one arm, its gains and ε₀, or that a state refutes it.

Numbers and trees are given, which Coq judges.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from itertools import product

import numpy as np

from lyapcheck.check.kinds.coriolis import CoriolisBelow
from lyapcheck.check.kinds.decreasing import (
    BoxTree,
    Decreasing,
    PositiveAndDecreasing,
    StateWitness,
)
from lyapcheck.check.kinds.inertia import HarmonicSizes, MassAbove, MassBelow, OfArm
from lyapcheck.check.loop import ClosedLoop, certifies
from lyapcheck.check.loop.field import PI_ABOVE, Side
from lyapcheck.check.loop.schur import MORE_HALVINGS
from lyapcheck.check.numbers.harmonics import angles_in
from lyapcheck.check.numbers.polynomials import root_above
from lyapcheck.check.statement import Mass, Proof
from lyapcheck.kernel.statements import OF_ARM
from lyapcheck.kernel.terms import NotPrinted, exact, exact_list
from lyapcheck.robots.numeric import NumericModel
from lyapcheck.search.sampled import arm_of_terms

FUEL = 30
"""How often a box of angles may be halved until M(q) ≻ 0 shows."""
LITTLE = Fraction(1, 10**7)
"""The part of K_p and B that is kept back, so that dV/dt is as far below 0 as convergence asks."""
SLACK = 2.0**-20
"""How much wider than the certificate's the box is, so that it reaches far enough after outward rounding."""
PIECES = range(2, 7)
"""The members of ``formal/Turns.v``."""
STEPS = 25
"""Of a grid of angles, along each."""
LITERAL = 4000
"""Longer texts overflow the stack of Coq's parser."""


def arm_script(statement: Decreasing, proof: Proof) -> str:
    """The tactics for ``certified``, or for ``falsified`` by a state.

    Raises:
        NotPrinted: the proof is of a kind, or about a function, that Coq has no theorem for.
    """
    loop = statement.closed_loop
    if isinstance(proof, StateWitness):
        parts = _robot(loop) | {
            "q": exact_list(proof.q),
            "e": exact_list(proof.e),
            "w": exact_list(proof.w),
            "hI": "h1_I" if loop.m == 1 else f"(h_I {loop.m} 0)",
            "dhI": "dh1_I" if loop.m == 1 else f"(dh_I {loop.m} 0)",
        }
        return _applied("falsified_by_state", parts)
    if certifies(loop.tail, loop.eps0):
        return by_norms(loop)
    if not isinstance(proof, PositiveAndDecreasing) or not isinstance(proof.rate, BoxTree):
        rule = proof.rate.rule if isinstance(proof, PositiveAndDecreasing) else proof.rule
        raise NotPrinted(f"a proof by {rule}")
    parts = _parts(loop)
    count, n = len(loop.angles), loop.n
    errors = loop.start[count : count + n]
    signs = "; ".join(f"({j}%nat, {_signs(loop, j)})" for j in loop.one_sided)
    tree = proof.rate.tree
    texts = (f'"{tree[k : k + LITERAL]}"' for k in range(0, len(tree), LITERAL))
    parts |= {
        "Lq": exact(
            Fraction(1) if loop.m == 1 else Fraction(math.ceil(loop.member.L * 10**4 + Fraction(1, 4)), 10**4)
        ),
        "rad": exact(Fraction(loop.radius).limit_denominator(10**6)),
        "signs": f"[{signs}]",
        "errors": _sides([(low - SLACK, high + SLACK) for low, high in errors]),
        "hI": _range("h", loop.m),
        "dhI": _range("dh", loop.m),
        "more": f"{MORE_HALVINGS}%nat",
        "tree": f"({' ++ '.join(texts)})%string",
    }
    return _applied("certified_by_boxes", parts)


def by_norms(loop: ClosedLoop, moving: bool = False) -> str:
    """The tactics for ``certified``, or for a goal that moves, where norms alone show it."""
    return _applied("certified_tracking_by_norms" if moving else "certified_by_norms", _parts(loop))


def _parts(loop: ClosedLoop) -> dict[str, str]:
    """What every theorem about dV/dt < 0 takes."""
    return _robot(loop) | {
        "f": f"member_{loop.m}",
        "c1": exact(min(loop.kp) * LITTLE),
        "c2": exact(min(loop.arm.viscous) * LITTLE),
    }


def property_script(statement: OfArm, proof: Proof) -> str:
    """The tactics for one of Properties 2.1 to 2.6.

    Raises:
        NotPrinted: there is no theorem of Coq's.
    """
    if isinstance(statement, MassBelow | CoriolisBelow) and not isinstance(proof, HarmonicSizes):
        raise NotPrinted(f"an upper bound by {proof.rule}")
    _, theorem = OF_ARM.get(type(statement), ("", ""))
    if not theorem:
        raise NotPrinted(f"statements of the kind {type(statement).__name__}")
    if not isinstance(statement, MassAbove):  # what has to compute with the entries of M(q) alone
        return f"apply {theorem}; computed."
    angles = angles_in(statement.inertia.mass)
    lowest = Fraction(_lowest(statement.mass, angles)).limit_denominator(10**6)
    return _applied(theorem, _lower(angles, (statement.low + lowest) / 2))


def _lower(angles: Sequence[int], alpha: Fraction) -> dict[str, str]:
    """What shows M(q) − alpha I ≻ 0."""
    turn = [(-PI_ABOVE - SLACK, PI_ABOVE + SLACK)] * len(angles)
    return {
        "angles": f"[{'; '.join(map(str, angles))}]%nat",
        "ks": "waves_in A",
        "alpha": exact(alpha),
        "turn": _sides(turn),
        "fuel": f"{FUEL}%nat",
    }


def _robot(loop: ClosedLoop) -> dict[str, str]:
    """What shows that the arm is a robot and the gains are positive: for every theorem about one arm."""
    viscous = loop.arm.viscous
    lowest = Fraction(0.9 * _lowest(loop.arm.mass, loop.angles)).limit_denominator(10**6)
    return _lower(loop.angles, lowest) | {
        "beta": exact(loop.inertia.largest_row),
        "kc": exact(root_above(loop.inertia.squares_of_symbols)),
        "lo": exact(min(viscous)),
        "hi": exact(max(viscous)),
        "kmin": exact(min(loop.kp)),
        "vmax": exact(max(loop.kv)),
    }


def _applied(theorem: str, parts: dict[str, str]) -> str:
    goal, _, _ = theorem.partition("_by_")
    chosen = " ".join(f"({name} := {value})" for name, value in parts.items())
    given = " _" * {"certified_tracking": 5, "M_above": 1}.get(goal, 4)
    return f"match goal with |- {goal} ?A{given} => eapply {theorem} with {chosen}; computed end."


def _range(name: str, m: int | None) -> str:
    """The range of h_m or h_m′ over an interval: by monotone pieces, where Coq knows them."""
    if m == 1:
        return f"{name}1_I"
    return f"{name}_R_{m}" if m in PIECES else f"({name}_I {m} 3)"


def _lowest(mass: Mass, angles: Sequence[int]) -> float:
    """The least eigenvalue of M(q) on a grid; only a proposal."""
    places = np.array([*product(np.linspace(-math.pi, math.pi, STEPS), repeat=len(angles))])
    q = np.zeros((len(places), len(mass)))
    q[:, list(angles)] = places
    return float(np.linalg.eigvalsh(NumericModel(arm_of_terms(mass, ())).mass(q)).min())


def _signs(loop: ClosedLoop, joint: int) -> str:
    """Signs of all joints that leave dV/dt as it is, turn this joint and no other one-sided one."""
    for signs in product((1, -1), repeat=loop.n):
        turned = [j for j in loop.one_sided if signs[j] < 0]
        if turned == [joint] and loop.symmetric_under(signs):
            return f"[{'; '.join(f'({s})' for s in signs)}]%Z"
    raise NotPrinted("a symmetry that the checker knows, but not its signs")


def _sides(sides: Sequence[Side]) -> str:
    return f"[{'; '.join(f'({_double(low)}, {_double(high)})' for low, high in sides)}]"


def _double(value: float) -> str:
    return f"({value.hex()})%float"
