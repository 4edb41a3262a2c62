"""Bounds in a terminal."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from fractions import Fraction

    from lyapcheck.bounds.compare import Comparison
    from lyapcheck.search.decay_results import DisturbanceBound, Provenance, SettlingBound

LEGEND = (
    "certified: accepted by the checker, at nominal numbers, for all postures and all motions from starts no "
    "farther than this one, joint by joint; simulated: one run."
)


def render(results: Sequence[Comparison]) -> str:
    """A block a gain set, and what is assumed about the arm."""
    lines: list[str] = []
    for found in results:
        lines += [f"{found.settling.name} on {found.settling.robot}", *_settling(found.settling, found)]
        lines += [*_disturbance(found.disturbance, found), ""]
    assumed = dict.fromkeys(text for found in results for text in found.assumptions)
    return "\n".join([*lines, LEGEND, *(f"Assumed: {text}." for text in assumed)]) + "\n"


def _settling(bound: SettlingBound, found: Comparison) -> list[str]:
    seen = (
        f"not within {found.task.T:g} s" if found.simulated_time is None else f"{found.simulated_time:.3g} s"
    )
    lines = [f"  every |e_i| ≤ {math.degrees(bound.delta):g}° for good"]
    if bound.time is None:
        return [*lines, f"    certified: none; {bound.reason}", f"    simulated: {seen}"]
    lines += [f"    certified: within {_up(float(bound.time))} s", f"    simulated: {seen}"]
    lines.append(f"    on the way |e| ≤ {_angles(bound.largest_errors)}")
    if not bound.exponential:
        lines.append("    h is flat at 0: no exponential rate, and the time grows fast as the angle shrinks")
    return [*lines, *_rests_on(bound.rests_on)]


def _disturbance(bound: DisturbanceBound, found: Comparison) -> list[str]:
    acting = []
    if any(bound.torque):
        acting.append(f"torques up to {_numbers(map(float, bound.torque))} N·m of any sign")
    if any(bound.dry):
        acting.append(f"dry friction up to {_numbers(map(float, bound.dry))} N·m")
    if not acting:
        return []
    lines = [f"  under {' and '.join(acting)}"]
    if bound.level is None or bound.time is None:
        lines.append(f"    certified: none; {bound.reason}")
    else:
        lines.append(f"    certified: |e| ≤ {_angles(bound.errors)} from {_up(float(bound.time))} s on")
    lines.append(f"    simulated: |e| ≤ {_angles(found.simulated_errors)} at the end")
    if bound.resting is not None:
        lines.append(f"    at rest, certified: |e| ≤ {_angles(bound.rest)}")
    return [*lines, *_rests_on(bound.rests_on)]


def _rests_on(found: Provenance | None) -> list[str]:
    if found is None:
        return []
    shares = f"{float(found.friction):.0%} of B and {float(found.stiffness):.0%} of K_p"
    return [f"    rests on: {found.by} ({found.boxes} boxes), ε₀ = {float(found.eps0):g}, without {shares}"]


def _up(value: float) -> str:
    """A number in four digits, never rounded down."""
    if value <= 0:
        return "0"
    scale = 10.0 ** (3 - math.floor(math.log10(value)))
    return f"{math.ceil(value * scale * (1 + 1e-12)) / scale:.4g}"


def _angles(values: Sequence[Fraction | float | None]) -> str:
    shown = ["∞" if x is None else f"{_up(math.degrees(x))}°" for x in values]
    return f"({', '.join(shown)})"


def _numbers(values: Iterable[float]) -> str:
    return f"({', '.join(f'{x:g}' for x in values)})"
