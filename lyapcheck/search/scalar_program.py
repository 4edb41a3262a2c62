"""The largest ε₀ of the scalar certificate, by bisection in rational arithmetic."""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from typing import TYPE_CHECKING

from flint import fmpq

from lyapcheck.check.kinds.decreasing import BoxTree
from lyapcheck.check.loop import ScalarForm, certifies
from lyapcheck.check.numbers.polynomials import fraction
from lyapcheck.family.base import named
from lyapcheck.files.decimals import significant_down
from lyapcheck.search.controlled_arm import ChainProof, DecreaseProof

if TYPE_CHECKING:
    from lyapcheck.check.statement import Ends, Proof
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots.dynamics import Chain
    from lyapcheck.search.controlled_arm import ControlledArm

DIGITS = 9
"""Significant digits of the ε₀ handed back."""
_TURNS = 4_000
"""The most halvings: what is smaller than 2⁻⁴⁰⁰⁰ of β/c is no ε₀ of anybody's arm."""


@dataclass(frozen=True)
class ScalarResult:
    """ε₀ of the scalar certificate, exactly checked, or ``None`` with the reason."""

    eps0: Fraction | None
    form: ScalarForm | None
    reason: str = ""


def scalar_epsilon(form: ScalarForm | None) -> ScalarResult:
    """The largest ε₀ with Θ'(ε) ≻ 0 for all ε in (0, ε₀], rounded down to nine digits and proved.

    The condition is k (β − ε c) ≥ ¼ ε (d + ε c)², whose margin falls as ε grows.

    Args:
        form: Θ', or ``None`` for an unbounded function.

    Soundness: ``lyapcheck.check.loop.certifies`` alone decides.
    """
    if form is None:
        return ScalarResult(None, None, "h is unbounded, and the scalar form needs its bound γ")
    if form.friction <= 0:
        return ScalarResult(None, form, "a joint has no viscous friction, so θ'22 is never positive")
    k, beta, c, d = (
        fmpq(x.numerator, x.denominator) for x in (form.stiffness, form.friction, form.drift, form.cross)
    )
    # the root of the margin from below, by exact signs, to a digit more than is handed back
    low, high = fmpq(0), beta / c if c else fmpq(10**9)
    for _ in range(_TURNS):
        middle = (low + high) / 2
        positive = k * (beta - middle * c) > middle * (d + middle * c) ** 2 / 4
        low, high = (middle, high) if positive else (low, middle)
        if (high - low) * 10 ** (DIGITS + 1) < low:
            break
    eps0 = significant_down(fraction(low), DIGITS)
    if certifies(form, eps0):
        return ScalarResult(eps0, form)
    return ScalarResult(None, form, "no ε₀ > 0 was found for which Θ' is positive definite")


# --- An ε₀ from norms of M and C alone: the checker's own bounds propose it, a tree of one leaf proves it.


REFUSED = "the checker accepted no proof"
UNBOUNDED = "h is unbounded, and the checker needs its bound γ"


def norm_epsilon(
    controlled: ControlledArm, viscous: tuple[Ends, ...] | None = None
) -> tuple[DecreaseProof | None, str]:
    """A proof that the checker has accepted, or why there is none.

    Args:
        viscous: the range of each diagonal entry of B that replaces the arm's, N·m·s/rad.
    """
    if not controlled.family.bounded:
        return None, UNBOUNDED
    loop = controlled.loop(Fraction(1))
    if viscous is not None:
        loop = replace(loop, viscous=viscous)
    result = scalar_epsilon(loop.tail)
    if result.eps0 is None:
        return None, result.reason
    accepted = controlled.proof(replace(loop, eps0=result.eps0), BoxTree(".")).accepted()
    return accepted, REFUSED if accepted is None else ""


# --- The same of links whose M(q) is too long to be written out: bounds of ‖M‖ and ‖C‖ along the links.


def chain_epsilon(gains: GainSet, chain: Chain, viscous: tuple[Ends, ...]) -> tuple[ChainProof | None, str]:
    """A proof that the checker has accepted, or why there is none.

    Args:
        viscous: the range of each diagonal entry of B, N·m·s/rad.
    """
    from lyapcheck.check.kinds.chain import ChainAbove, OwnMoments
    from lyapcheck.check.kinds.link_bounds import ChainDecreasing, ChainNorms
    from lyapcheck.constants.storage import storage_proof
    from lyapcheck.control.judgement import judged_statement, proves

    if not named(gains.family, gains.m).bounded:
        return None, UNBOUNDED
    if min(low for low, _ in viscous) <= 0:
        return None, "a joint has no viscous friction, so θ'22 is never positive"
    largest, coriolis = (storage_proof(chain, name) for name in ("lambda_max", "k_c"))
    if largest is None or coriolis is None:
        return None, "no bounds of ‖M‖ and ‖C‖ along the links were found"
    positive: Proof = OwnMoments()
    if not proves(ChainAbove(chain.links, Fraction(0)), positive):
        smallest = storage_proof(chain, "lambda_min")
        if smallest is None:
            return None, "M(q) is not shown to be positive definite; lyapcheck robot says what is known"
        positive = smallest.proof
    own = gains.family, gains.m, tuple(gains.kp), tuple(gains.kv)
    statement = ChainDecreasing(chain.links, viscous, *own, Fraction(1))
    result = scalar_epsilon(statement.form(largest.bound, coriolis.bound))
    if result.eps0 is None:
        return None, result.reason
    statement = replace(statement, eps0=result.eps0)
    norms = ChainNorms(positive, largest.bound, largest.proof, coriolis.bound, coriolis.proof)
    judged = judged_statement(statement, [norms])
    return (ChainProof(statement, norms, judged), "") if judged.shown == "proved" else (None, REFUSED)
