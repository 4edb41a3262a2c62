"""What is known about stability beside (19), which is sufficient and not necessary.

For all positive gains the origin is globally asymptotically stable on every arm with Properties 2.1 to 2.7,
viscous friction in each joint included: ``proofs/scalar.py``, claim arms.all. A certificate says the same of
one arm with an ε₀ of V. Both are about the torques of (6): a motor that saturates is outside, see (10p).
"""

from __future__ import annotations

from fractions import Fraction

from lyapcheck.control.conditions import ACCEPTED, REJECTED
from lyapcheck.files.decimals import decimal_text
from lyapcheck.gating.gate import CERTIFICATES, GateResult
from lyapcheck.records import Record

THEOREM = "theorem"
_CLAIM = "claim arms.all of scalar.py"


class Stability(Record):
    """Why the origin is globally asymptotically stable.

    Args:
        by: ``theorem``, or the certificate: ``scalar`` or ``global``.
        eps0: what the certificate proves.
        assumes: what is taken for granted about the arm beyond its numbers.
    """

    by: str
    eps0: Fraction | None = None
    assumes: tuple[str, ...] = ()


def stability(result: GateResult) -> Stability | None:
    """What establishes stability apart from (19), the certificate with the larger ε₀ first.

    Soundness: a certificate was proved; the theorem is about the hyperbolic family and needs λmin(B) > 0. An
        arm that has a model has revolute joints, so that β_M and k_c are finite, and its M ≻ 0 is checked.
    """
    proved = [check for check in result.checks if check.id in CERTIFICATES and check.value is not None]
    if proved:
        best = max(proved, key=lambda check: check.value or 0)
        return Stability(best.id, best.value)
    if result.gains.family != "hyperbolic" or not result.limits.viscous_min:
        return None
    return Stability(THEOREM, None, () if result.limits.robot else ("the arm has Properties 2.1 to 2.7",))


def remarks(result: GateResult) -> list[str]:
    """What the conditions say about each other, a sentence each; nothing where they agree."""
    known, damping = stability(result), result.verdict_of(("19",))
    missing = [check for check in result.checks if check.id in CERTIFICATES and check.verdict != ACCEPTED]
    found = [_without_19(known, result)] if damping == REJECTED and result.limits.viscous_min else []
    if missing and result.verdict_of(("10p", "19")) == ACCEPTED:
        found += [f"(10p) and (19) hold, yet no {check.id} certificate was found" for check in missing]
    told = known is not None and (damping == REJECTED or known.by != THEOREM)
    if told and result.verdict_of(("10p",)) == REJECTED:
        found.append("(10p) fails: a motor may saturate, and stability is proved only while none does")
    return found


def _without_19(known: Stability | None, result: GateResult) -> str:
    asked = set(CERTIFICATES) & set(result.deciding)
    if known is None:
        hint = "" if asked else "; --condition scalar looks for a proof without it"
        return f"(19) fails, but it is only sufficient{hint}"
    if known.eps0 is not None:
        return (
            f"(19) fails, yet the gains are proved stable without it: {known.by} certificate, "
            f"dV/dt < 0 with ε₀ = {decimal_text(known.eps0)}"
        )
    hint = "" if asked else "; --condition scalar proves an ε₀"
    given = f", given that {known.assumes[0]}" if known.assumes else ""
    return (
        "(19) fails, yet it is not needed: positive gains and friction in each joint make the origin "
        f"globally asymptotically stable{given} ({_CLAIM}){hint}"
    )
