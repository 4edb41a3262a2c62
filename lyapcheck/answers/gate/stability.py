"""What is known about stability beside (19), which is sufficient and not necessary.

Stability is said only with an ε₀ that was proved in this run for this arm and these gains. It is about the
torques of (6): a motor that saturates is outside, see (10p).
"""

from __future__ import annotations

from lyapcheck.answers.gate.judge import CERTIFICATES, GateResult
from lyapcheck.control.conditions import ACCEPTED, REJECTED, Check
from lyapcheck.files.decimals import decimal_text

_NO_ARM = (
    "(19) fails, but it is only sufficient; stability is not judged without the arm: name one with robot = …"
)


def stable_otherwise(result: GateResult) -> Check | None:
    """The certificate with the larger ε₀, which proves stability whatever (19) says; ``None`` without one.

    Soundness: it was accepted by ``lyapcheck.check.verify``, as a statement of kind ``Decreasing``.
    """
    proved = [check for check in result.checks if check.id in CERTIFICATES and check.verdict == ACCEPTED]
    return max(proved, key=lambda check: check.value or 0, default=None)


def remarks(result: GateResult) -> list[str]:
    """What the conditions say about each other, a sentence each; nothing where they agree."""
    known, damping = stable_otherwise(result), result.verdict_of(("19",))
    missing = [check for check in result.checks if check.id in CERTIFICATES and check.verdict != ACCEPTED]
    found = [_without_19(known, result)] if damping == REJECTED and result.limits.viscous_min else []
    if missing and result.verdict_of(("10p", "19")) == ACCEPTED:
        found += [f"(10p) and (19) hold, yet no {check.id} certificate was found" for check in missing]
    if known is not None and result.verdict_of(("10p",)) == REJECTED:
        found.append("(10p) fails: a motor may saturate, and stability is proved only while none does")
    return found


def _without_19(known: Check | None, result: GateResult) -> str:
    if known is not None:
        eps0 = "" if known.value is None else decimal_text(known.value)
        return (
            f"(19) fails, yet the gains are proved stable without it: {known.id} certificate, "
            f"dV/dt < 0 with ε₀ = {eps0}; --condition {known.id} without 19 accepts it"
        )
    if not result.limits.robot:
        return _NO_ARM
    asked = set(CERTIFICATES) & set(result.deciding)
    return f"(19) fails, but it is only sufficient{'' if asked else '; --condition scalar looks for a proof'}"
