"""Tuned gains in a terminal."""

from __future__ import annotations

from collections.abc import Sequence

from lyapcheck.tune.formats.rows import compared_rows, notes, tuned_rows
from lyapcheck.tune.gain_file import targets_text
from lyapcheck.tune.results import TUNED, TunedSet, Tuning


def render(tuning: Tuning) -> str:
    """A block a member, the comparison under it, and what it all rests on."""
    head = [f"{tuning.robot}: the largest gains within (10p) and (19)", targets_text(tuning), ""]
    blocks = [line for item in tuning.sets for line in [*_block(item, tuning.targets.digits), ""]]
    legend = ["(10p) k_p + k_v < (τmax − k_g)/(√n γ)   (19) k_v < λmin(B)/(√n γ)   in N·m", *notes(tuning)]
    return "\n".join([*head, *blocks, *legend]) + "\n"


def _block(item: TunedSet, digits: int) -> list[str]:
    if item.status != TUNED:
        return [f"✗ {item.name} (m = {item.m}): {item.status}", *(f"  → {text}" for text in item.reasons)]
    lines = [f"✓ {item.name} (m = {item.m})", *_aligned(tuned_rows(item, digits))]
    if item.comparison is not None:
        lines += [
            f"  beside {item.comparison.name} of {item.comparison.source}:",
            *_aligned(compared_rows(item.comparison)),
        ]
    return lines


def _aligned(rows: Sequence[Sequence[str]]) -> list[str]:
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return [
        "  " + "   ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()
        for row in rows
    ]
