"""The largest ε₀ of the scalar certificate: a conic program proposes, rational arithmetic disposes."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from flint import fmpq

from lyapcheck.check.loop.scalar import ScalarForm, certifies

DIGITS = 9
"""Significant digits of the ε₀ handed back."""


@dataclass(frozen=True)
class ScalarResult:
    """ε₀ of the scalar certificate, exactly checked, or ``None`` with the reason."""

    eps0: Fraction | None
    form: ScalarForm | None
    method: str
    reason: str = ""


def scalar_epsilon(form: ScalarForm | None, *, conic: bool = True) -> ScalarResult:
    """The largest ε₀ with Θ'(ε) ≻ 0 for all ε in (0, ε₀], rounded down to nine digits and proved.

    The condition k (β − ε c) ≥ ¼ ε (d + ε c)² is convex in ε ≥ 0; Clarabel maximises ε. An answer that is
    only almost solved, or that fails the exact check, is replaced by bisection in rational arithmetic.

    Args:
        form: Θ', or ``None`` for an unbounded function.
        conic: whether Clarabel is asked, or bisection alone.

    Soundness: ``lyapcheck.check.loop.scalar.certifies`` alone decides.
    """
    if form is None:
        return ScalarResult(None, None, "none", "h is unbounded, and the scalar form needs its bound γ")
    if form.friction <= 0:
        return ScalarResult(None, form, "none", "a joint has no viscous friction, so θ'22 is never positive")
    for method, propose in (("conic program", _conic), ("bisection", _bisection))[0 if conic else 1 :]:
        proposal = propose(form)
        eps0 = None if proposal is None else _rounded_down(proposal)
        if eps0 is not None and certifies(form, eps0):
            return ScalarResult(eps0, form, method)
    return ScalarResult(None, form, "none", "no ε₀ > 0 was found for which Θ' is positive definite")


def _conic(form: ScalarForm) -> Fraction | None:
    """Clarabel's answer; ``None`` unless it says Solved."""
    import cvxpy as cp

    scale = float(form.friction / (form.drift + form.cross**2 / (4 * form.stiffness)))
    k, beta, c, d = (float(x) for x in (form.stiffness, form.friction, form.drift, form.cross))
    x = cp.Variable(nonneg=True)
    burden = (d * d / 4 + k * c) * scale * x + d * c / 2 * scale**2 * x**2 + c * c / 4 * scale**3 * x**3
    problem = cp.Problem(cp.Maximize(x), [burden / (k * beta) <= 1])
    try:
        problem.solve(solver=cp.CLARABEL)
    except cp.SolverError:
        return None
    if problem.status != cp.OPTIMAL or x.value is None:
        return None
    return Fraction(float(x.value) * scale) * (1 - Fraction(1, 10**DIGITS))


def _bisection(form: ScalarForm) -> Fraction:
    """The root of the margin from below, by exact signs."""
    k, beta, c, d = (
        fmpq(x.numerator, x.denominator) for x in (form.stiffness, form.friction, form.drift, form.cross)
    )
    low, high = fmpq(0), beta / c if c else fmpq(10**9)
    for _ in range(64):
        middle = (low + high) / 2
        positive = k * (beta - middle * c) > middle * (d + middle * c) ** 2 / 4
        low, high = (middle, high) if positive else (low, middle)
    return Fraction(int(low.p), int(low.q))


def _rounded_down(value: Fraction) -> Fraction | None:
    if value <= 0:
        return None
    places = DIGITS
    while value * 10**places < 10 ** (DIGITS - 1):
        places += 1
    return Fraction(int(value * 10**places), 10**places)
