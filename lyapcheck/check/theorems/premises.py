"""What the claims behind the hypotheses of Lyapunov's direct method must state, for one loop and one V.

What each property of V comes to is in ``kinds.loop_property``; ``rate`` is the bound of dV/dt, in which
a = ‖h(e)‖ and b = ‖w‖ vanish together at the origin alone, from |h| <= γ, |h'| <= ρ and h(x)/x <= L.

References: ``kelly2005control``, chapter 2; ``khalil2002nonlinear``, theorem 4.9; ``reyes2019family``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from fractions import Fraction

from lyapcheck.check.kinds.all_of import AllOf
from lyapcheck.check.kinds.inertia import CoriolisBelow, MassAbove, MassBelow
from lyapcheck.check.kinds.loop_property import (
    ABOVE,
    AN_EQUILIBRIUM,
    BELOW,
    EQUILIBRIUM,
    POSITIVE,
    SMOOTH,
    UNBOUNDED,
    LoopProperty,
    secant_fact,
    sign_facts,
    size_facts,
    slope_facts,
)
from lyapcheck.check.kinds.theorem import Theorem
from lyapcheck.check.statement import Statement
from lyapcheck.check.theorems.closed_loop import ClosedLoop
from lyapcheck.check.theorems.definiteness import shows_positive
from lyapcheck.check.theorems.rate import rate_bound

Premise = Callable[[ClosedLoop, frozenset[Statement]], str | None]
Needed = tuple[str, Statement]
"""A statement, and how it is called in words."""


def unmet(theorem: Theorem, stated: Mapping[str, Statement]) -> str | None:
    """What a claim behind a hypothesis fails to state, in words; ``None`` if nothing is missing.

    Args:
        theorem: its name is known and its hypotheses are those of the theorem.
        stated: the statements of the claims by id, all of them proved; a claim that is not here is left out.
    """
    for label, claim in theorem.hypotheses:
        lacks = PREMISES[label](theorem.loop, parts_of(stated[claim])) if claim in stated else None
        if lacks is not None:
            return f"{claim} does not state {lacks}, which “{label}” needs"
    return None


def parts_of(statement: Statement) -> frozenset[Statement]:
    """A statement and, if it is a conjunction, its parts."""
    if isinstance(statement, AllOf):
        return frozenset().union(*(parts_of(part) for _, part in statement.parts))
    return frozenset([statement])


def _needs(listed: Callable[[ClosedLoop], Iterable[Needed]]) -> Premise:
    """A premise that is a list of statements."""
    return lambda loop, parts: next((name for name, one in listed(loop) if one not in parts), None)


def _property(name: str) -> Premise:
    """A premise that is a property of the loop or of its V."""

    def listed(loop: ClosedLoop) -> list[Needed]:
        desired = loop.desired and name == AN_EQUILIBRIUM
        return [(name, LoopProperty(name, loop.h, loop.slope, loop.potential, desired))]

    return _needs(listed)


def _bounds_of_h(loop: ClosedLoop) -> list[Needed]:
    return [
        *sign_facts(loop.h),
        *size_facts(loop.h, loop.gamma),
        *slope_facts(loop.h, loop.slope, loop.rho),
        *secant_fact(loop.h, loop.L),
    ]


def _rate(loop: ClosedLoop) -> list[Needed]:
    return [("dV/dt ≤ −[a b] Θ [a b]ᵀ for this V and Θ, for every n", rate_bound(loop))]


def _mass(loop: ClosedLoop) -> list[Needed]:
    assert loop.arm is not None
    beta = dict(loop.numbers)["beta"]
    return [
        ("M(q) ≻ 0 of this arm", MassAbove(loop.arm.mass, (), Fraction(0))),
        (f"‖M(q)‖ ≤ {beta} of this arm", MassBelow(loop.arm.mass, (), beta)),
    ]


def _coriolis(loop: ClosedLoop) -> list[Needed]:
    assert loop.arm is not None
    kc = dict(loop.numbers)["kc"]
    return [(f"‖C(q, x)y‖ ≤ {kc} ‖x‖ ‖y‖ of this arm", CoriolisBelow(loop.arm.mass, (), kc))]


def _definite(loop: ClosedLoop, parts: frozenset[Statement]) -> str | None:
    corner, side, low = loop.form
    minor = ("add", ("mul", corner, low), ("neg", ("pow", side, 2)))
    for name, target in (("θ11 > 0", corner), ("θ11 θ22 − θ12² > 0", minor)):
        if not any(shows_positive(one, target, loop) for one in parts):
            return f"{name} for the Θ of this loop"
    return None


PREMISES: dict[str, Premise] = {
    "only equilibrium": _property(EQUILIBRIUM),
    "equilibrium": _property(AN_EQUILIBRIUM),
    "differentiable": _property(SMOOTH),
    "positive definite": _property(POSITIVE),
    "bounded below by a positive definite function": _property(BELOW),
    "bounded above by a positive definite function": _property(ABOVE),
    "radially unbounded": _property(UNBOUNDED),
    "bounds of h": _needs(_bounds_of_h),
    "rate bounded by a form": _needs(_rate),
    "form negative definite": _definite,
    "bounds of M": _needs(_mass),
    "bounds of C": _needs(_coriolis),
}
"""For each hypothesis, what is missing among the statements of its claim."""
