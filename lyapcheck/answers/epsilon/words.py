"""The four ε₀ in words: cells of a table, and a sentence for everything that must be said."""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from typing import TYPE_CHECKING

from lyapcheck.answers.epsilon.four import eps0_of
from lyapcheck.files.decimals import decimal_text
from lyapcheck.output.digits import at_most, decimals
from lyapcheck.output.document import Table
from lyapcheck.promise import all_say

if TYPE_CHECKING:
    from lyapcheck.answers.epsilon.four import FourEpsilons
    from lyapcheck.promise import Promise
    from lyapcheck.search.falsify import RisingState
    from lyapcheck.search.weights import Weighted

KINDS = ("published", "scalar", "certified", "falsified")
LEGEND = (
    "published: the end of (18), which claims dV/dt < 0 for all smaller ε₀.",
    "scalar: from norms alone.",
    "falsified: a state with dV/dt > 0 is shown in balls.",
)
CERTIFIED = "certified: dV/dt < 0 is proved at every state but the origin."
RANGED = "published, over ranges: (18) with the worst end of each of its constants, about all arms in them."
NUMBER = "Marked *: a number in floating point without a certificate; the checker proves less from norms."


INFINITE_RATE = "about (11), the loop of a controller of infinite rate"
MOST_REMARKS = 3
WAYS = {"published": "the end of (18)", "scalar": "norms alone", "falsified": "a state with dV/dt > 0"}


def numbers_table(result: FourEpsilons) -> Table:
    """The four ε₀ of one gain set, and where each is from."""
    rows = []
    for kind in KINDS:
        way = f"by {result.certified_by}" if kind == "certified" else WAYS[kind]
        missing = getattr(result, kind) is None
        why = "" if missing else way
        label = kind if kind != "certified" else "no certificate"
        if kind == "certified" and result.promise is not None:
            label = result.promise.says(kind)
        rows.append((label, number_cell(result, kind), why))
    return Table(("", "ε₀", "from"), tuple(rows), align="lrl", keys=2)


def said_of(result: FourEpsilons) -> str:
    """How far the largest ε₀ is known."""
    ratio = ratio_text(result.ratio)
    return "" if ratio is None else f"ε₀ = {exact(result.falsified)} is too large; the quotient is {ratio}"


def first_remarks(results: Sequence[FourEpsilons]) -> tuple[str, ...]:
    """What the numbers say about each other, and the weights, of one gain set; of any, what a star means."""
    starred = any(result.scalar_grade == "no certificate" for result in results)
    legend = (NUMBER,) if starred else ()
    if len(results) != 1:
        return legend
    (result,) = results
    said = [f"{finding}" for finding in result.findings]
    said += [text.removesuffix(".") for kind in ("certified", "published") for text in reasons(result, kind)]
    if result.promise is not None and result.unvaried is not None:
        said.append(_cost_text(result.promise, result.unvaried))
    if result.outside:
        said.append(f"the file's own value lies outside the range of {', '.join(result.outside)}")
    if result.weighted is not None and result.weighted_promise is not None:
        said.append(result.weighted_promise.says(_weighted_text(result.weighted)))
    return (*said[: MOST_REMARKS - len(legend)], *legend)


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
    promises = [result.promise for result in results if result.promise is not None]
    outcome = len(promises)
    if len(results) == 1:
        return f"{_one(results[0])} on {robots}"
    if outcome == len(results) > 0:
        return all_say(promises, f"✓ all {outcome} gain sets have a certified ε₀ on {robots}")
    if not promises:
        return f"? no gain set of {len(results)} has a certified ε₀ on {robots or 'no arm'}"
    return all_say(promises, f"? {outcome} of {len(results)} gain sets have a certified ε₀ on {robots}")


def _arm(result: FourEpsilons) -> str:
    """The arm with the extent of what is said of it."""
    return f"{result.robot}, {result.extent}" if result.extent else result.robot


def _one(result: FourEpsilons) -> str:
    if result.promise is None:
        return f"? no ε₀ is certified for {result.name}"
    return result.promise.says(f"✓ ε₀ = {exact(result.certified)} is certified for {result.name}")


FASTEST = 100
"""rad/s, beyond which no arm turns."""
BUYS = (
    "What ε₀ buys: V with ε = ε₀/(1 + ‖e‖) falls also where the arm stands still; it does "
    "not measure damping: gains that swing and gains that do not may have the same."
)


def remarks(result: FourEpsilons) -> list[str]:
    """How the certified number was proved, findings, reasons for missing numbers and the witness."""
    said = [_way(result)] if result.certified is not None or result.boxes else []
    if result.promise is not None and result.unvaried is not None:
        said.append(_cost_text(result.promise, result.unvaried))
    if result.outside:
        said.append(
            f"the file's own value lies outside the range of {', '.join(result.outside)}: nothing here is "
            "about the arm as its file describes it."
        )
    said += [f"{finding}." for finding in result.findings]
    said += reasons(result)
    if result.weighted is not None and result.weighted_promise is not None:
        said.append(result.weighted_promise.says(_weighted_text(result.weighted)))
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
    promise = result.promise
    parts = [] if promise is None else [promise.says(f"certified by {result.certified_by}")]
    if result.proof is not None and result.proof.boxes:
        parts.append(f"{boxes_text(result.proof.boxes)} judged by the checker")
    if result.boxes:
        parts.append(f"{boxes_text(result.boxes)} looked at by the search")
    return f"{', '.join(parts)}."


def _cost_text(whole: Promise, unvaried: Promise) -> str:
    """What the ranges cost."""
    certified, nominal = eps0_of(whole), eps0_of(unvaried)
    assert certified is not None
    assert nominal is not None
    cost = "nothing" if certified >= nominal else f"{at_most(100 * (1 - certified / nominal), 2)} %"
    about = unvaried.says(f"at nominal numbers ε₀ = {exact(nominal)} is certified.")
    return f"the ranges cost {cost}: {about}"


def reasons(result: FourEpsilons, *kinds: str) -> list[str]:
    """Why a number is missing, or not larger than it is; a sentence each, of ``kinds`` or of all."""
    return [
        f"no {kind} ε₀: {reason}." if getattr(result, kind) is None else f"no larger {kind} ε₀: {reason}."
        for kind, reason in result.reasons.items()
        if not kinds or kind in kinds
    ]


def _weighted_text(weighted: Weighted) -> str:
    """What a proof with weights shows, in one line."""
    seen = f"{weighted.states} worst states in the program"
    if not weighted.proof.loop.coupling:
        return f"with weights, y = w − εΛh, Λ = I is the best that was shown ({seen})."
    values = ", ".join(map(decimal_text, weighted.products))
    boxes = boxes_text(weighted.proof.boxes)
    return f"with weights, y = w − εΛh, dV/dt < 0 is proved for ε₀Λ = diag({values}) ({boxes}, {seen})."


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
    promises = [result.promise for result in results if result.promise is not None]
    return [
        *LEGEND[:-1],
        *([all_say(promises, CERTIFIED)] if promises else []),
        LEGEND[-1],
        *([RANGED] if any(result.ranges for result in results) else []),
        BUYS,
        *([NUMBER] if any(result.scalar_grade == "no certificate" for result in results) else []),
        *([f"Arm: {robots}. Seed: {seeds}."] if results else []),
        *(f"{text}." for text in assumed),
    ]
