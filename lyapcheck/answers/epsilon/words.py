"""The four ε₀ in words: cells of a table, and a sentence for everything that must be said."""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from typing import TYPE_CHECKING

from lyapcheck.files.decimals import decimal_text
from lyapcheck.output.digits import at_most, decimals

if TYPE_CHECKING:
    from lyapcheck.answers.epsilon.four import FourEpsilons
    from lyapcheck.search.falsify import RisingState
    from lyapcheck.search.weights import Weighted

KINDS = ("published", "scalar", "certified", "falsified")
LEGEND = (
    "published: the end of (18), which claims dV/dt < 0 for every smaller ε₀.",
    "scalar: from norms alone.",
    "certified: dV/dt < 0 is proved at every state but the origin.",
    "falsified: a state with dV/dt > 0 is proved.",
)
RANGED = (
    "published, over ranges: (18) with the worst end of each of its constants, about the same arms as "
    "the certified ε₀."
)
NUMBER = "Marked *: a number in floating point without a certificate; the checker proves less from norms."


def ratio_text(value: Fraction | None) -> str | None:
    """A ratio of certified to falsified in six decimals, never rounded up."""
    if value is None:
        return None
    whole, rest = divmod(math.floor(value * 10**6), 10**6)
    return f"{whole}.{rest:06d}"


def boxes_text(count: int) -> str:
    """So many boxes."""
    return "1 box" if count == 1 else f"{count} boxes"


def exact(value: Fraction | None) -> str | None:
    """An exact number as a decimal string."""
    return None if value is None else decimal_text(value)


def number_cell(result: FourEpsilons, kind: str) -> str:
    """One of the four; a star where it has no certificate, a dash where there is none."""
    star = "*" if kind == "scalar" and result.scalar_grade == "no certificate" else ""
    return f"{exact(getattr(result, kind)) or '—'}{star}"


def title(results: Sequence[FourEpsilons]) -> str:
    """Whether every gain set has a certified ε₀."""
    robots = ", ".join(dict.fromkeys(filter(None, map(_arm, results))))
    outcome = sum(result.certified is not None for result in results)
    if len(results) == 1:
        return f"{_one(results[0])} on {robots}"
    if outcome == len(results) > 0:
        return f"✓ all {outcome} gain sets have a certified ε₀ on {robots}"
    return f"? {outcome} of {len(results)} gain sets have a certified ε₀ on {robots or 'no arm'}"


def _arm(result: FourEpsilons) -> str:
    """The arm with the extent of what is said of it."""
    return f"{result.robot}, {result.extent}" if result.extent else result.robot


def _one(result: FourEpsilons) -> str:
    if result.certified is None:
        return f"? no ε₀ is certified for {result.name}"
    return f"✓ ε₀ = {exact(result.certified)} is certified for {result.name}"


FASTEST = 100
"""rad/s, beyond which no arm turns."""
BUYS = (
    "What ε₀ buys: V with ε = ε₀/(1 + ‖e‖) falls at every state, also where the arm stands still; it does "
    "not measure damping: gains that swing and gains that do not may have the same."
)


def remarks(result: FourEpsilons) -> list[str]:
    """How the certified number was proved, findings, reasons for missing numbers and the witness."""
    said = [_way(result)] if result.certified is not None or result.boxes else []
    if result.certified is not None and result.unvaried is not None:
        said.append(_cost_text(result.certified, result.unvaried))
    if result.outside:
        said.append(
            f"the file's own value lies outside the range of {', '.join(result.outside)}: nothing here is "
            "about the arm as its file describes it."
        )
    said += [f"{finding}." for finding in result.findings]
    said += reasons(result)
    if result.weighted is not None:
        said.append(_weighted_text(result.weighted))
    if result.witness is not None:
        said.append(f"falsified {witness_text(result.witness)}.")
        speed = float(max(map(abs, result.witness.state.w)))
        if speed > FASTEST:
            said.append(
                f"that state moves at {speed:.0e} rad/s, where no arm comes: larger ε₀ fail there, and "
                "need not fail in any motion."
            )
    if result.witness is not None and result.corner:
        values = ", ".join(f"{name} = {decimal_text(value)}" for name, value in result.corner.items())
        said.append(f"that state is one of the arm with {values}.")
    return said


def _way(result: FourEpsilons) -> str:
    """How the certified number was proved, and how much was tried."""
    parts = [] if result.certified is None else [f"certified by {result.certified_by}"]
    if result.proof is not None:
        parts.append(f"{boxes_text(result.proof.boxes)} judged by the checker")
    if result.boxes:
        parts.append(f"{boxes_text(result.boxes)} looked at by the search")
    return f"{', '.join(parts)}."


def _cost_text(certified: Fraction, nominal: Fraction) -> str:
    """What the ranges cost."""
    if certified >= nominal:
        return f"the ranges cost nothing: at nominal numbers ε₀ = {exact(nominal)} is certified."
    share = at_most(100 * (1 - certified / nominal), 2)
    return f"the ranges cost {share} %: at nominal numbers ε₀ = {exact(nominal)} is certified."


def reasons(result: FourEpsilons) -> list[str]:
    """Why a number is missing, or not larger than it is; a sentence each."""
    return [
        f"no {kind} ε₀: {reason}." if getattr(result, kind) is None else f"{kind} ε₀: {reason}."
        for kind, reason in result.reasons.items()
    ]


def _weighted_text(weighted: Weighted) -> str:
    """What a proof with weights shows, in one line."""
    products = ", ".join(map(decimal_text, weighted.products))
    return (
        f"with weights, y = w − εΛh, dV/dt < 0 is proved for ε₀Λ = diag({products}) "
        f"({boxes_text(weighted.proof.boxes)}, {weighted.states} worst states in the program)."
    )


def witness_text(witness: RisingState) -> str:
    """The failing state in one line."""
    parts = (("q", "rad"), ("e", "rad"), ("w", "rad/s"))
    places = ", ".join(
        f"{name} = ({', '.join(map(decimal_text, getattr(witness.state, name)))}) {unit}"
        for name, unit in parts
    )
    low, _ = decimals(witness.rate, 6)
    return f"at {places} with ε₀ = {decimal_text(witness.eps0)}: dV/dt > {low} W"


def notes(results: Sequence[FourEpsilons]) -> list[str]:
    """What holds for all results: what the columns say, the arm, the seed, assumptions."""
    robots = ", ".join(dict.fromkeys(map(_arm, results)))
    seeds = ", ".join(dict.fromkeys(str(result.seed) for result in results))
    assumed = dict.fromkeys(text for result in results for text in result.assumptions)
    return [
        *LEGEND,
        *([RANGED] if any(result.ranges for result in results) else []),
        BUYS,
        *([NUMBER] if any(result.scalar_grade == "no certificate" for result in results) else []),
        *([f"Arm: {robots}. Seed: {seeds}."] if results else []),
        *(f"{text}." for text in assumed),
    ]
