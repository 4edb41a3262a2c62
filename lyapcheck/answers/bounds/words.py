"""Times, angles and sentences about bounds; nothing certified is rounded down."""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from typing import TYPE_CHECKING

from lyapcheck.check.kinds.phases import StaysWithin
from lyapcheck.check.numbers.enclosure import Enclosure

if TYPE_CHECKING:
    from lyapcheck.answers.bounds.compare import BoundsComparison
    from lyapcheck.search.decay.results import Provenance


def title(results: Sequence[BoundsComparison]) -> str:
    """Whether all bounds are certified."""
    robots = ", ".join(dict.fromkeys(result.settling.robot for result in results))
    whole = sum(result.certified for result in results)
    if len(results) == 1:
        return _one(results[0])
    if whole == len(results) > 0:
        return f"✓ the bounds of all {whole} gain sets are certified on {robots}"
    return f"? the bounds of {whole} of {len(results)} gain sets are certified on {robots or 'no arm'}"


def _one(result: BoundsComparison) -> str:
    bound = result.settling
    mark = "✓" if result.certified else "?"
    over = f" with {', '.join(result.varies)}" if result.varies else ""
    about = f"{mark} {bound.name} on {bound.robot}{over}:"
    if bound.time is None:
        return f"{about} no settling time is certified"
    within = f"every |e_i| ≤ {angle_text(bound.delta)} for good within {seconds_up(bound.time)}"
    if result.certified:
        return f"{about} {within}, certified"
    return f"{about} {within} is certified, what disturbances leave is not"


def seconds_up(value: Fraction | None) -> str:
    """A time in four digits, never rounded down; a dash where there is none."""
    return "—" if value is None else f"{_up(Enclosure(value, value).float_upper)} s"


def ratio_text(result: BoundsComparison) -> str:
    """How many times the certified time is that of the run."""
    if result.settling.time is None or not result.simulated_time:
        return "—"
    ratio = float(result.settling.time) / result.simulated_time
    return f"{float(f'{ratio:.3g}'):g} ×"


def after_text(result: BoundsComparison) -> str:
    """How errors die out, where that is certified; empty where it is not."""
    shown = result.settling.shown
    after = shown.statement.after if shown is not None and isinstance(shown.statement, StaysWithin) else None
    if after is None:
        return ""
    m = result.settling.m or 1
    elapsed = f"(t − T)/({_up(float(after.scale))} s)"
    falling = f"exp(−{elapsed})" if m == 1 else f"(1 + {elapsed})^(−1/{2 * m - 2})"
    sizes = ", ".join(map(angle_up, after.sizes))
    return f"from T = {seconds_up(result.settling.time)} on |e_i| ≤ a_i {falling} is certified, a = ({sizes})"


def simulated_time(result: BoundsComparison) -> str:
    """When the run came to stay within δ."""
    if result.simulated_time is None:
        return f"not within {result.simulated_for:g} s"
    return f"{result.simulated_time:.3g} s"


def angle_text(value: Fraction | float) -> str:
    """An angle in degrees, rounded."""
    return f"{math.degrees(value):g}°"


def angle_up(value: Fraction | float | None) -> str:
    """An angle in degrees, in four digits and never rounded down; ``None`` is without a bound."""
    return "∞" if value is None else f"{_up(math.degrees(value))}°"


def provenance_text(result: Provenance) -> str:
    """What a bound rests on."""
    shares = f"{float(result.friction):.0%} of B and {float(result.stiffness):.0%} of K_p"
    boxes = "box" if result.boxes == 1 else "boxes"
    by = f"{result.by} ({result.boxes} {boxes})"
    if result.phases > 1:
        return f"{by} in {result.phases} phases, ε₀ ≥ {float(result.eps0):g}, doing without at most {shares}"
    return f"{by}, ε₀ = {float(result.eps0):g}, doing without {shares}"


def _up(value: float) -> str:
    if value <= 0:
        return "0"
    if math.isinf(value):
        return "more than 1e308"
    scale = 10.0 ** (3 - math.floor(math.log10(value)))
    rounded = math.ceil(value * scale * (1 + 1e-12)) / scale
    return f"{rounded:.0f}" if 1e4 <= rounded < 1e7 else f"{rounded:.4g}"
