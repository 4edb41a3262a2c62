"""What is said about one check."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from functools import lru_cache
from math import degrees
from typing import TYPE_CHECKING, NamedTuple

from lyapcheck.answers.gate.judge import DAMPED, GRAVITY, GateResult
from lyapcheck.answers.gate.stability import GLOBAL, LASALLE, SCALAR
from lyapcheck.answers.running.holds import HOLDS, HoldsCheck, falls
from lyapcheck.answers.running.sampled import SAMPLED, SampledCheck, unstable_text
from lyapcheck.check.numbers.polynomials import Enclosure
from lyapcheck.check.refusal import Refused
from lyapcheck.control.conditions import ACCEPTED, REJECTED, UNDECIDED, Check
from lyapcheck.control.sampling import time_text
from lyapcheck.files.decimals import decimal_text
from lyapcheck.output.digits import at_least, at_most, correct_digits, ends, scaled_text
from lyapcheck.output.fields import Field
from lyapcheck.promise import promised

if TYPE_CHECKING:
    from lyapcheck.files.toml import Place

DIGITS, MARGIN_DIGITS = 20, 12
"""Significant digits of limits and of margins in data; people see fewer."""
SYMBOLS = {"accepted": "✓", "rejected": "✗", "undecided": "?"}


class Rule(NamedTuple):
    """A condition: its formula, what it means if it holds, the gain to look at, and what is compared.

    ``limit`` is what it asks for where that is no number.
    """

    formula: str
    holds: str
    key: str = ""
    subject: str = ""
    limit: str = ""


RULES = {
    "10": Rule(
        "λmax(K_p) + λmax(K_v) ≤ (‖τmax‖ − k_g)/(√n γ)", "the torque norm is within (10)", "kp",
        "λmax(K_p) + λmax(K_v)",
    ),
    "10p": Rule("k_p + k_v < (τmax − k_g)/(√n γ)", "no motor saturates (10p)", "kp", "k_p + k_v"),
    "10i": Rule("k_p + k_v ≤ (τmax − k_g)/γ", "no motor saturates (10i)", "kp", "k_p + k_v"),
    "19": Rule("k_v < λmin(B)/(√n γ)", "k_v is within (19)", "kv", "k_v"),
    SCALAR: Rule(
        "dV/dt < 0 at each state but the goal with the ε₀ shown, from norms alone", "stable (scalar)",
        limit="ε₀ > 0",
    ),
    GLOBAL: Rule(
        "dV/dt < 0 at each state but the goal with the ε₀ shown, box by box", "stable (global)",
        limit="ε₀ > 0",
    ),
    LASALLE: Rule(
        "M(q) ≻ 0, which is what LaSalle's theorem asks of an arm for global asymptotic stability, "
        "with or without friction (Khalil 2002, corollary 4.2)",
        "stable (lasalle)", limit="M ≻ 0",
    ),
    SAMPLED: Rule(
        "stability as a computer runs the gains, by b > L k_v Σ|f_j| + (½ + d) T (ρ k_p + Γ), "
        "whatever the inertia, or with --within by an energy that falls; values are periods; joints are "
        "revolute, readings exact and unwrapped",
        "stable as run (sampled)", "kv",
    ),
    HOLDS: Rule(
        "sup |Δg| + f < k_p, for what pulls unknown to the controller, and dry friction f",
        "unknown gravity is held (holds)", "kp",
    ),
    DAMPED: Rule(
        "k_v > 0, which the theory asks for: without it a joint has only its own friction to damp it", "",
        "kv", limit="k_v > 0",
    ),
    GRAVITY: Rule("|g_i(q)| ≤ k_gi, as it is stated: the arm's own model exceeds it at a posture", ""),
}  # fmt: skip


class Row(NamedTuple):
    """A check of a gain set."""

    result: GateResult
    check: Check

    @property
    def joint(self) -> str:
        """The joint's name, or ``all``."""
        return "all" if self.check.joint is None else self.result.limits.joints[self.check.joint]

    @property
    def place(self) -> Place | None:
        """Where the gain to look at stands in its file."""
        result, check = self
        return result.file.place(result.gains, RULES[check.id].key, check.joint)


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
    """What was compared, exactly; ``none`` where a proof shows no ε₀."""
    value = check.value
    if check.id == LASALLE:
        return ""
    if value is None:
        return "none"
    if check.id in (SCALAR, GLOBAL):
        return f"ε₀ = {at_least(value)}"
    if check.id == HOLDS:
        return at_most(value, 6)
    return time_text(value) if check.id == SAMPLED else decimal_text(value)


def limit_text(check: Check) -> str:
    """The limit to six digits, all correct; ``none`` where there is no limit."""
    if check.narrow or check.id == GRAVITY:
        return check.narrow
    if fixed := RULES[check.id].limit:
        return fixed
    if check.limit is None:
        return "none"
    return f"{at_least(1000 * check.limit.lower)} ms" if check.id == SAMPLED else _digits(check.limit)


@lru_cache(maxsize=256)  # joints and sets share limits
def _digits(limit: Enclosure) -> str:
    return correct_digits(limit, 6)


def _limit_ends(limit: Enclosure) -> dict[str, str]:
    return _ends(limit.lower.as_integer_ratio(), limit.upper.as_integer_ratio())


@lru_cache(maxsize=256)  # of integers, since hashing fractions takes longer
def _ends(lower: tuple[int, int], upper: tuple[int, int]) -> dict[str, str]:
    return ends(Enclosure(Fraction(*lower), Fraction(*upper)), DIGITS)


def largest_shown(check: Check) -> str:
    """The largest value that passes, as the user would write it, or ``none``; of a payload with its unit."""
    if isinstance(check, SampledCheck):
        return "" if check.narrow else "none" if check.most is None else time_text(check.most)
    if isinstance(check, HoldsCheck) and check.payload is not None:
        return f"{decimal_text(check.payload)} kg"
    if not RULES[check.id].subject and check.id != SAMPLED:
        return ""
    return "none" if check.largest_admissible is None else check.largest_admissible.text


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
        return check.narrow
    return f"({check.id}) {Row(result, check).joint}: {broken(result, check)}"


def by_joints(result: GateResult, text: Callable[[GateResult, Check], str]) -> list[str]:
    """A text for all that decides and was not accepted, joints of which the same is said together."""
    said: dict[tuple[str, str], list[str]] = {}
    for check in result.failures:
        said.setdefault((check.id, text(result, check)), []).append(Row(result, check).joint)
    lines = []
    for (name, words), joints in said.items():
        where = "" if joints == ["all"] else f" {', '.join(joints)}"
        lines.append(f"({name}){where}: {words}")
    if result.verdict == UNDECIDED and not result.failures:
        lines.append(result.grounds.missing)
    return lines


def repairs(result: GateResult) -> list[str]:
    """What to change for all that fails; where no number is too large, what is wrong."""

    def said(result: GateResult, check: Check) -> str:
        numbers = check.verdict == REJECTED and check.limit is not None and RULES[check.id].subject
        return repair(result, check) if numbers else broken(result, check)

    return by_joints(result, said)


def advices(result: GateResult) -> list[str]:
    """The same with what is wrong."""
    return by_joints(result, broken)


def broken(result: GateResult, check: Check) -> str:
    """What is wrong and what to change."""
    if check.verdict == REJECTED and isinstance(check, SampledCheck) and check.refuted is not None:
        return unstable_text(check.refuted, check.rests)
    if check.verdict == REJECTED and isinstance(check, HoldsCheck):
        return falls(check, result.limits.joints)
    if check.limit is None or check.verdict == "undecided":
        return check.reason or _exceeded(result, check)
    rule = RULES[check.id]
    said = (
        f"{rule.subject} = {value_text(check)} breaks {rule.formula} = {limit_text(check)}, "
        f"margin {margin_text(check)}"
    )
    return f"{said}; {repair(result, check)}"


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


def repair(result: GateResult, check: Check) -> str:
    """What makes a check pass that failed, in a few words."""
    if check.largest_admissible is None:
        return "no k_v > 0 meets it without friction" if check.id == "19" else "gravity alone needs the motor"
    most = check.largest_admissible.text
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


FIELDS = (
    Field("", lambda row: SYMBOLS[row.check.verdict], " ", align="l"),
    Field("", "result.name", "gain set", align="l"),
    Field("id", "check.id", "condition", align="l"),
    Field("joint", lambda row: None if row.check.joint is None else row.joint),
    Field("", "joint", "joint", align="l"),
    Field("verdict", lambda row: spoken_verdict(row.check)),
    Field("value", "check.value", to=decimal_text),
    Field("", lambda row: value_text(row.check), "value [N·m]"),
    Field("limit", "check.limit", to=_limit_ends),
    Field("", lambda row: limit_text(row.check), "limit"),
    Field("margin", lambda row: None if row.check.limit is None else margin_text(row.check, MARGIN_DIGITS)),
    Field("", lambda row: margin_shown(row.check), "margin"),
    Field("largest_admissible", "check.largest_admissible", to=lambda largest: largest.text),
    Field("", lambda row: largest_shown(row.check), "max allowed"),
    Field("line", "place.line"),
    Field("column", "place.column"),
    Field("message", lambda row: advice(*row)),
)
"""What is said of a check, for programs and for people."""
