"""What the gate says of a gain set beside its checks: each a sentence."""

from __future__ import annotations

from lyapcheck.answers.gate.friction import damping_lines, friction_lines, held
from lyapcheck.answers.gate.judge import DAMPED, GRAVITY, GateResult
from lyapcheck.answers.running import running_sentences
from lyapcheck.control.conditions import ACCEPTED, REJECTED, Check
from lyapcheck.control.gains import CERTIFICATES
from lyapcheck.output.digits import at_least

_NO_ARM = (
    "(19) fails, but it is only sufficient; stability is not judged without the arm: name one with robot = …"
)
_SINGLE = "(10p) fails, but by its √n only: |τ_i| ≤ γ (k_p + k_v) + k_g keeps each joint within its limit"
_NO_FRICTION = (
    "no viscous friction is known of a joint (λmin(B) = 0), so (19) admits no k_v. Without it the origin "
    "is still globally asymptotically stable; what is not known is how fast: no ε₀, no certified time or "
    "error, no bound under a disturbance. A measured friction goes into [bounds] viscous_min"
)


def remarks(result: GateResult) -> list[str]:
    """What the conditions say about each other, and the bench about the gains."""
    run = running_sentences(result.checks, result.limits.joints, result.failures)
    joints = result.verdict_of(("10p",))
    missing = [check for check in result.checks if check.id in CERTIFICATES and check.verdict != ACCEPTED]
    outcome = without_19(result)
    if missing and result.verdict_of(("10p", "19")) == ACCEPTED:
        outcome += [f"(10p) and (19) hold, yet no {check.id} certificate was found" for check in missing]
    if joints == REJECTED and result.verdict_of(("10i",)) == ACCEPTED and "10p" in result.deciding:
        outcome.append(_SINGLE + _accepts(result))
    elif result.saturates and result.stable is not None:
        words = "(10i) fails: a motor may saturate, and stability is proved only while none does"
        outcome.append(result.stable.own_promise.says(words))
    model, gains = result.limits.model, result.gains
    if not result.explained or model is None:
        return [*outcome, *run]
    friction = friction_lines(gains, model, list(held(gains, model)))
    return [*outcome, *run, *friction, *damping_lines(gains, model)]


def without_19(result: GateResult) -> list[str]:
    """What is known of stability where (19) fails."""
    if result.verdict_of(("19",)) != REJECTED:
        return []
    known, frictionless = result.stable, result.limits.viscous_min == 0
    if known is not None:
        where = "over all its ranges" if result.limits.varied else "at its nominal numbers"
        how = "proved stable while no motor saturates" if result.saturates else "proved stable without it"
        outcome = f"(19) fails, yet the gains are {how}: {_proof(known, where)}"
        outcome += _accepts(result) if "19" in result.deciding else ""
        said = [outcome, _NO_FRICTION] if frictionless else [outcome]
        return [known.own_promise.says(words) for words in said]
    if not result.limits.robot:
        return [_NO_ARM]
    if frictionless:
        return []
    asked = set(CERTIFICATES) & set(result.deciding)
    return [
        f"(19) fails, but it is only sufficient{'' if asked else '; --condition scalar looks for a proof'}"
    ]


def proved_otherwise(result: GateResult) -> str:
    """The same in a line, of a set that breaks nothing but (19)."""
    known = result.stable
    assert known is not None
    eps0 = "" if known.value is None else f", ε₀ = {at_least(known.value)}"
    options = accepting(result)
    accepted = f"; accepted with {' '.join(options)}" if options else ""
    return known.own_promise.says(f"proved stable by {known.id}{eps0}{accepted}")


def _proof(known: Check, where: str) -> str:
    if known.value is None:
        return f"M(q) ≻ 0 is proved for the arm {where}, the rest is LaSalle's theorem"
    return f"dV/dt < 0 with ε₀ = {at_least(known.value)} ({known.id} certificate, for the arm {where})"


def _accepts(result: GateResult) -> str:
    options = accepting(result)
    return f"; {' '.join(options)} accepts it" if options else ""


def accepting(result: GateResult) -> list[str]:
    """The options with which the gate would accept, by what this run has shown; none where it has not."""
    if result.verdict == ACCEPTED or result.verdict_of((GRAVITY, DAMPED)) == REJECTED:
        return []  # a false bound of gravity is rejected whatever decides
    known = result.stable
    instead = {"10p": "10i"} if result.verdict_of(("10p",)) == REJECTED else {}
    if known is not None and result.verdict_of(("19",)) == REJECTED:
        instead["19"] = known.id
    wanted = dict.fromkeys(instead.get(name, name) for name in result.deciding)
    others = tuple(name for name in wanted if known is None or name != known.id)
    if others and result.verdict_of(others) != ACCEPTED:
        return []
    return [word for name in wanted for word in ("--condition", name)]
