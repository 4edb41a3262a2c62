"""What the formats share: heads, cells and sentences."""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from typing import TYPE_CHECKING

from lyapcheck.files import decimal_text

if TYPE_CHECKING:
    from lyapcheck.admissible import EpsilonResult
    from lyapcheck.search.falsify import Witness
    from lyapcheck.search.weights import Weighted

KINDS = ("published", "scalar", "certified", "falsified")
HEADS = ("gains", "m", *(f"{kind} ε₀" for kind in KINDS), "certified/falsified", "boxes")
LEGEND = (
    "published: end of (18), a claim; scalar: from norms; certified: dV/dt < 0 proved at every "
    "state but the origin; falsified: a state with dV/dt > 0 proved."
)
NUMBER = "* a number from norms in floating point, without a certificate: the checker proves less from norms."


def ratio_text(value: Fraction | None) -> str | None:
    """A ratio of certified to falsified in six decimals, never rounded up."""
    if value is None:
        return None
    whole, rest = divmod(math.floor(value * 10**6), 10**6)
    return f"{whole}.{rest:06d}"


def exact(value: Fraction | None) -> str | None:
    """An exact number as a decimal string."""
    return None if value is None else decimal_text(value)


def row(result: EpsilonResult, seconds: float | None) -> tuple[str, ...]:
    """The cells under `HEADS`, a dash where there is no number, and the seconds if they are wanted."""
    cells = [_cell(result, kind) for kind in KINDS]
    name = result.name, "—" if result.m is None else str(result.m)
    shown = () if seconds is None else (f"{seconds:.2f}",)
    return (*name, *cells, ratio_text(result.ratio) or "—", str(result.boxes), *shown)


def _cell(result: EpsilonResult, kind: str) -> str:
    """A number, with a star where it has no certificate."""
    star = "*" if kind == "scalar" and result.scalar_grade == "no certificate" else ""
    return f"{exact(getattr(result, kind)) or '—'}{star}"


def heads(seconds: Sequence[float] | None) -> tuple[str, ...]:
    """The heads of the table."""
    return HEADS if seconds is None else (*HEADS, "seconds")


def remarks(result: EpsilonResult) -> list[str]:
    """Findings, reasons for missing numbers, and the witness, a sentence each."""
    said = [] if result.certified is None else [_way(result)]
    said += [f"{finding}." for finding in result.findings]
    said += reasons(result)
    if result.weighted is not None:
        said.append(weighted_text(result.weighted))
    if result.witness is not None:
        said.append(witness_text(result.witness))
    if result.witness is not None and result.corner:
        values = ", ".join(f"{name} = {decimal_text(value)}" for name, value in result.corner.items())
        said.append(f"that state is one of the arm with {values}.")
    return said


def _way(result: EpsilonResult) -> str:
    """How the certified number was proved."""
    count = "" if result.proof is None else f", {result.proof.boxes} boxes judged by the checker"
    return f"certified by {result.certified_by}{count}."


def reasons(result: EpsilonResult) -> list[str]:
    """Why a number is missing, or not larger than it is; a sentence each."""
    return [
        f"no {kind} ε₀: {reason}." if getattr(result, kind) is None else f"{kind} ε₀: {reason}."
        for kind, reason in result.reasons.items()
    ]


def weighted_text(weighted: Weighted) -> str:
    """What a proof with weights shows, in one line."""
    products = ", ".join(map(decimal_text, weighted.products))
    return (
        f"with weights, y = w − εΛh, dV/dt < 0 is proved for ε₀Λ = diag({products}) "
        f"({weighted.proof.boxes} boxes, {weighted.states} worst states in the program)."
    )


def witness_text(witness: Witness) -> str:
    """The failing state in one line."""
    parts = (("q", "rad"), ("e", "rad"), ("w", "rad/s"))
    places = ", ".join(
        f"{name} = ({', '.join(map(decimal_text, getattr(witness.state, name)))}) {unit}"
        for name, unit in parts
    )
    low, _ = witness.rate.decimals(6)
    return f"at {places} with ε₀ = {decimal_text(witness.eps0)}: dV/dt > {low} W."


def _extent(results: Sequence[EpsilonResult]) -> str:
    if all(result.ranges for result in results):
        return "certified for all values in its ranges"
    return "at its nominal parameters"


def notes(results: Sequence[EpsilonResult]) -> list[str]:
    """What holds for all results: robot, seed, assumptions."""
    if not results:
        return []
    robots = ", ".join(dict.fromkeys(result.robot for result in results))
    seeds = ", ".join(dict.fromkeys(str(result.seed) for result in results))
    assumed = dict.fromkeys(text for result in results for text in result.assumptions)
    return [
        LEGEND,
        *([NUMBER] if any(result.scalar_grade == "no certificate" for result in results) else []),
        f"Arm: {robots}, {_extent(results)}. Seed: {seeds}.",
        *(f"Assumed: {text}." for text in assumed),
    ]
