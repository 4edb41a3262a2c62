"""From a problem to a certified bound: doubles propose the storage forms, balls decide."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from functools import partial
from typing import Any

import numpy as np
from flint import arb, ctx, fmpq

from lyapcheck.check.loop.arithmetic import BALLS
from lyapcheck.constants.storage.exact import Exact, exact
from lyapcheck.constants.storage.hinges import hinges
from lyapcheck.constants.storage.kinetic import kinetic
from lyapcheck.constants.storage.problem import Problem
from lyapcheck.constants.storage.program import Proposal, propose
from lyapcheck.constants.storage.weight import weight
from lyapcheck.constants.storage.whirl import whirl_bound
from lyapcheck.robots.dynamics import Chain

_MARGINS = (1e-9, 1e-8, 1e-7, 1e-6, 1e-5)
_BITS = 256


def storage_bounds(chain: Chain) -> dict[str, Callable[[], Fraction | None]]:
    """For each constant how to bound it for all angles: λmin(M) from below, the others from above.

    Returns:
        By the name of the constant a function that gives the bound, or ``None`` where none was certified.

    Soundness: the forms are rational, the slacks are exact, and `lyapcheck.check.loop.arithmetic` shows in
        balls that they are positive definite; what the solver of semidefinite programs says is not relied on.
    """
    bodies, fall = hinges(chain)
    makers: dict[str, Callable[[], Problem]] = {
        "lambda_min": partial(kinetic, bodies, -1),
        "lambda_max": partial(kinetic, bodies, 1),
        "k_g": partial(weight, bodies, fall, range(len(bodies))),
    }
    for i in range(len(bodies)):
        makers[f"k_g{i + 1}"] = partial(weight, bodies, fall, [i])
    found: dict[str, Callable[[], Fraction | None]] = {
        name: partial(_bound, make) for name, make in makers.items()
    }
    return found | {"k_c": partial(whirl_bound, bodies)}


def _bound(make: Callable[[], Problem]) -> Fraction | None:
    problem = make()
    proposal = proved(problem)
    return None if proposal is None else problem.sign * Fraction(proposal.kappa)


def proved(problem: Problem) -> Proposal | None:
    """A proposal that holds, with the smallest margin that suffices; ``None`` where none does."""
    proposals = (propose(problem, margin) for margin in _MARGINS)
    return next((found for found in proposals if found is not None and holds(problem, found)), None)


def holds(problem: Problem, proposal: Proposal) -> bool:
    """Whether the forms of the proposal prove its κ."""
    kappa, forms = _number(proposal.kappa), [_form(problem, row) for row in proposal.coefficients]
    first = problem.steps[0].carry @ problem.start
    if any(first) and not kappa >= first @ forms[0] @ first:
        return False
    following = [*forms[1:], None]
    slacks = (problem.slack(k, forms[k], after, kappa) for k, after in enumerate(following))
    return all(map(_definite, slacks))


def _form(problem: Problem, coefficients: Any) -> Exact:
    """Σ_i c_i form_i, exactly."""
    total = exact(problem.forms[0] * 0)
    for coefficient, form in zip(coefficients, problem.forms, strict=True):
        total = total + exact(form) * _number(coefficient)
    return total


def _number(value: float) -> fmpq:
    numerator, denominator = float(value).as_integer_ratio()
    return fmpq(numerator, denominator)


def _definite(slack: Exact) -> bool:
    previous = ctx.prec
    ctx.prec = _BITS
    try:
        return BALLS.positive_definite([[arb(x) for x in row] for row in np.asarray(slack)])
    finally:
        ctx.prec = previous
