"""What is said about one check."""

from __future__ import annotations

from fractions import Fraction
from functools import lru_cache
from math import degrees

from lyapcheck.answers.gate.judge import DAMPED, GRAVITY, GateResult
from lyapcheck.answers.running import HOLDS, SAMPLED, SampledCheck
from lyapcheck.answers.running.holds import HoldsCheck, falls
from lyapcheck.answers.running.sampled import unstable_text
from lyapcheck.check.numbers.polynomials import Enclosure
from lyapcheck.check.refusal import Refused
from lyapcheck.control.conditions import ACCEPTED, REJECTED, UNDECIDED, Check
from lyapcheck.control.sampling import time_text
from lyapcheck.files.decimals import decimal_text, scaled_text
from lyapcheck.output.digits import at_least, at_most, correct_digits, decimals
from lyapcheck.promise import promised

SYMBOLS = {"accepted": "✓", "rejected": "✗", "undecided": "?"}

RULES = {
    "10": "λmax(K_p) + λmax(K_v) ≤ (‖τmax‖ − k_g)/(√n γ)",
    "10p": "k_p + k_v < (τmax − k_g)/(√n γ)",
    "10i": "k_p + k_v ≤ (τmax − k_g)/γ",
    "19": "k_v < λmin(B)/(√n γ)",
    "scalar": "dV/dt < 0 at each state but the goal with the ε₀ shown, from norms alone",
    "global": "dV/dt < 0 at each state but the goal with the ε₀ shown, box by box",
    "lasalle": "M(q) ≻ 0, which is what LaSalle's theorem asks of an arm for global asymptotic stability, "
    "with or without friction (Khalil 2002, corollary 4.2)",
    SAMPLED: "stability as a computer runs the gains, by b > L k_v Σ|f_j| + (½ + d) T (ρ k_p + Γ), "
    "whatever the inertia, or with --within by an energy that falls; values are periods; joints are "
    "revolute, readings exact and unwrapped",
    HOLDS: "sup |Δg| + f < k_p, for what pulls unknown to the controller, and dry friction f",
    DAMPED: "k_v > 0, which the theory asks for: without it a joint has only its own friction to damp it",
    GRAVITY: "|g_i(q)| ≤ k_gi, as it is stated: the arm's own model exceeds it at a posture",
}
KEYS = {
    "10": "kp",
    "10p": "kp",
    "10i": "kp",
    "19": "kv",
    "scalar": "",
    "global": "",
    "lasalle": "",
    SAMPLED: "kv",
    HOLDS: "kp",
    DAMPED: "kv",
    GRAVITY: "",
}
"""The gain to look at when a check fails."""
_SUBJECTS = {"10": "λmax(K_p) + λmax(K_v)", "10p": "k_p + k_v", "10i": "k_p + k_v", "19": "k_v"}


def joint_name(result: GateResult, check: Check) -> str:
    """The joint's name, or ``all``."""
    return "all" if check.joint is None else result.limits.joints[check.joint]


def spoken_verdict(check: Check) -> str:
    """The verdict on a check as it may be said: undecided, where what was judged is about another value."""
    if check.verdict != ACCEPTED:
        return check.verdict
    try:
        return check.own_promise.says(ACCEPTED)
    except Refused:
        return UNDECIDED


def about(result: GateResult) -> str:
    """The function h of a gain set."""
    return f"m = {result.m}" if result.m is not None else result.gains.family


def value_text(check: Check) -> str:
    """What was compared, exactly; ``none`` where a certificate proved no ε₀."""
    if check.id == "lasalle":
        return ""
    if check.id == SAMPLED and check.value is not None:
        return time_text(check.value)
    if check.id == HOLDS and check.value is not None:
        return at_most(check.value, 6)
    return "none" if check.value is None else decimal_text(check.value)


def limit_text(check: Check) -> str:
    """The limit to six digits, all correct; ``none`` where there is no limit."""
    if check.id == GRAVITY:
        return ""
    if isinstance(check, SampledCheck) and check.narrow:
        return check.narrow
    if check.id == SAMPLED:
        return "none" if check.limit is None else f"{at_least(1000 * check.limit.lower)} ms"
    if check.id == DAMPED:
        return "k_v > 0"
    if check.id not in (*_SUBJECTS, HOLDS):
        return "M ≻ 0" if check.id == "lasalle" else "ε₀ > 0"
    return "none" if check.limit is None else _digits(check.limit)


@lru_cache(maxsize=256)  # joints and sets share limits
def _digits(limit: Enclosure) -> str:
    return correct_digits(limit, 6)


def limit_ends(limit: Enclosure, digits: int) -> tuple[str, str]:
    """The limit between two decimals."""
    return _decimals(limit.lower.as_integer_ratio(), limit.upper.as_integer_ratio(), digits)


@lru_cache(maxsize=256)  # of integers, since hashing fractions takes longer
def _decimals(lower: tuple[int, int], upper: tuple[int, int], digits: int) -> tuple[str, str]:
    return decimals(Enclosure(Fraction(*lower), Fraction(*upper)), digits)


def largest_text(check: Check) -> str:
    """The largest value that passes, with as many decimal places as the user wrote, or ``none``."""
    largest = check.largest_admissible
    if check.id not in (*_SUBJECTS, SAMPLED) or (isinstance(check, SampledCheck) and check.narrow):
        return ""
    return "none" if largest is None else largest.text


def largest_shown(check: Check) -> str:
    """The same with its unit where that is not the one of a gain: of a period, of a payload."""
    if isinstance(check, SampledCheck) and check.most is not None and not check.narrow:
        return time_text(check.most)
    if isinstance(check, HoldsCheck) and check.payload is not None:
        return f"{decimal_text(check.payload)} kg"
    return largest_text(check)


def margin_shown(check: Check) -> str:
    """limit − value, of a period in ms."""
    if check.id != SAMPLED or check.margin is None:
        return margin_text(check)
    return f"{significant_text(*(1000 * check.margin).as_integer_ratio(), 4)} ms"


def margin_text(check: Check, digits: int = 4) -> str:
    """limit − value to a few digits, never larger than it is."""
    if check.limit is None or check.value is None:
        return ""
    a, b, c, d = *check.limit.lower.as_integer_ratio(), *check.value.as_integer_ratio()
    return significant_text(a * d - b * c, b * d, digits)  # which need not be in lowest terms


def significant_text(numerator: int, denominator: int, digits: int) -> str:
    """A decimal of a few significant digits that is not above the quotient."""
    if not numerator:
        return "0"
    size, places = abs(numerator), digits
    while places < 40 and size * 10**places < denominator * 10 ** (digits - 1):
        places += 1
    while places > 0 and size * 10**places >= denominator * 10**digits:
        places -= 1
    return scaled_text(numerator * 10**places // denominator, places)


def advice(result: GateResult, check: Check) -> str:
    """What is wrong and what to change, in one sentence; of an accepted check its narrow scope."""
    if check.verdict == ACCEPTED:
        return check.narrow if isinstance(check, SampledCheck) else ""
    return f"({check.id}) {joint_name(result, check)}: {_broken(result, check)}"


def advices(result: GateResult) -> list[str]:
    """The same for all that decides and was not accepted, joints of which the same is said together."""
    said: dict[tuple[str, str], list[str]] = {}
    for check in result.failures:
        said.setdefault((check.id, _broken(result, check)), []).append(joint_name(result, check))
    lines = [f"({name}) {', '.join(joints)}: {text}" for (name, text), joints in said.items()]
    if result.verdict == UNDECIDED and not result.failures:
        lines.append(result.grounds.missing)
    return lines


def _broken(result: GateResult, check: Check) -> str:
    if check.verdict == REJECTED and isinstance(check, SampledCheck) and check.refuted is not None:
        return unstable_text(check.refuted, check.rests)
    if check.verdict == REJECTED and isinstance(check, HoldsCheck):
        return falls(check, result.limits.joints)
    if check.limit is None or check.verdict == "undecided":
        return check.reason or _exceeded(result, check)
    broken = (
        f"{_SUBJECTS[check.id]} = {value_text(check)} breaks {RULES[check.id]} = {limit_text(check)}, "
        f"margin {margin_text(check)}"
    )
    return f"{broken}; {_repair(result, check)}"


def _exceeded(result: GateResult, check: Check) -> str:
    """The posture at which gravity exceeds a stated bound, or that nothing but friction damps a joint."""
    if check.id == DAMPED:
        return "k_v = 0: this joint has only its friction to damp it; give it a gain"
    for one in result.limits.refuted:
        if check.id == GRAVITY and one.joint == check.joint:
            q = one.refuted.proof.q  # type: ignore[union-attr]
            place = ", ".join(f"{degrees(x):.6g}" for x in q)
            return (
                f"the stated bound of {decimal_text(one.bound)} N·m is false: by the arm's own model gravity "
                f"exerts {float(one.reached):.6g} N·m at q = ({place})°; correct it, or remove it"
            )
    return ""


def _repair(result: GateResult, check: Check) -> str:
    if check.largest_admissible is None:
        return "no k_v > 0 meets it without friction" if check.id == "19" else "gravity alone needs the motor"
    most = largest_text(check)
    if check.id not in ("10p", "10i") or check.joint is None:
        return _passes(check, f"lower it to at most {most}")
    kv = result.gains.kv[check.joint]
    largest_kp = check.largest_admissible - kv
    return _passes(
        check,
        f"lower k_p to at most {decimal_text(largest_kp)}"
        if largest_kp > 0
        else f"lower k_p + k_v to at most {most}",
    )


def _passes(check: Check, words: str) -> str:
    """Words about the largest value that passes, which the checker has judged; else none of them."""
    if check.admitted is None or check.threshold is None or check.largest_admissible is None:
        return "lower it"
    promise, _ = promised(check.threshold.asked(check.largest_admissible), check.admitted)
    return "lower it" if promise is None else promise.says(words)
