"""What every format says about a check, in one place."""

from __future__ import annotations

from fractions import Fraction

from lyapcheck.control.conditions import ACCEPTED, Check
from lyapcheck.control.gate import GateResult
from lyapcheck.files import decimal_text

SYMBOLS = {"accepted": "✓", "rejected": "✗", "undecided": "?"}

RULES = {
    "10": "λmax(K_p) + λmax(K_v) ≤ (‖τmax‖ − k_g)/(√n γ)",
    "10p": "k_p + k_v < (τmax − k_g)/(√n γ)",
    "19": "k_v < λmin(B)/(√n γ)",
}
UNITS = {"10": "N·m", "10p": "N·m", "19": "N·m"}
KEYS = {"10": "kp", "10p": "kp", "19": "kv"}
"""The gain to look at when a check fails."""


def joint_name(result: GateResult, check: Check) -> str:
    """The joint's name, or ``all``."""
    return "all" if check.joint is None else result.limits.joints[check.joint]


def limit_text(check: Check, digits: int = 6) -> str:
    """The limit to a few digits, all correct; ``none`` where there is no limit."""
    return "none" if check.limit is None else check.limit.correct_digits(digits)


def largest_text(check: Check) -> str:
    """The largest value that passes, with as many decimal places as the user wrote, or ``none``."""
    largest = check.largest_admissible
    return "none" if largest is None else decimal_text(largest, check.places)


def margin_text(check: Check, digits: int = 4) -> str:
    """limit − value to a few digits, never larger than it is."""
    return "" if check.margin is None else significant_down(check.margin, digits)


def significant_down(value: Fraction, digits: int) -> str:
    """A decimal of a few significant digits that is not above ``value``."""
    places = digits
    while places < 40 and abs(value) * 10**places < 10 ** (digits - 1):
        places += 1
    while places > 0 and abs(value) * 10**places >= 10**digits:
        places -= 1
    return decimal_text(Fraction((value * 10**places).__floor__(), 10**places), places)


def advice(result: GateResult, check: Check) -> str:
    """What is wrong and what to change, in one sentence; empty for an accepted check."""
    if check.verdict == ACCEPTED:
        return ""
    joint = joint_name(result, check)
    if check.limit is None or check.verdict == "undecided":
        return f"({check.id}) {joint}: {check.reason}"
    broken = (
        f"{_subject(check.id)} = {decimal_text(check.value)} breaks {RULES[check.id]} = {limit_text(check)}"
    )
    return f"({check.id}) {joint}: {broken}; {_repair(result, check)}"


def _subject(condition: str) -> str:
    return {"10": "λmax(K_p) + λmax(K_v)", "10p": "k_p + k_v", "19": "k_v"}[condition]


def _repair(result: GateResult, check: Check) -> str:
    if check.largest_admissible is None:
        return "no positive gain passes on this arm"
    most = largest_text(check)
    if check.id != "10p" or check.joint is None:
        return f"lower it to at most {most}"
    kv = result.gains.kv[check.joint]
    room = check.largest_admissible - kv
    return f"lower k_p to at most {decimal_text(room)}" if room > 0 else f"lower k_p + k_v to at most {most}"
