"""The cells that the text and the Markdown format share."""

from __future__ import annotations

from lyapcheck.files import decimal_text
from lyapcheck.tune.results import Comparison, TunedSet, Tuning

HEADS = ("joint", "k_p", "k_v", "(10p) limit", "(19) limit", "k_p ends at", "k_v ends at")
DAMPING_HEAD = "ζ"
COMPARED_HEADS = ("joint", "k_p", "k_v", "k_p left", "of the largest", "share of (10p)", "breaks")
BOUNDS = {"10p": "(10p)", "19": "(19)", "damping": "damping"}


def tuned_rows(item: TunedSet, digits: int) -> list[tuple[str, ...]]:
    """The heads and a row a joint."""
    damped = any(joint.damping is not None for joint in item.joints)
    rows: list[tuple[str, ...]] = [(*HEADS, DAMPING_HEAD) if damped else HEADS]
    for joint in item.joints:
        cells = (
            joint.name,
            decimal_text(joint.kp, digits),
            decimal_text(joint.kv, digits),
            joint.sum_limit.correct_digits(8),
            joint.kv_limit.correct_digits(8),
            BOUNDS[joint.kp_bound],
            BOUNDS[joint.kv_bound],
        )
        rows.append(cells if joint.damping is None else (*cells, f"{float(joint.damping):.4g}"))
    return rows


def compared_rows(comparison: Comparison) -> list[tuple[str, ...]]:
    """The heads and a row a joint."""
    rows: list[tuple[str, ...]] = [COMPARED_HEADS]
    for joint in comparison.joints:
        broken = ", ".join(BOUNDS[name] for name in joint.broken) or "nothing"
        gains = (decimal_text(joint.kp), decimal_text(joint.kv), decimal_text(joint.kp_left))
        shares = (f"{float(joint.kp_left_share):.1%}", f"{float(joint.used):.1%}")
        rows.append((joint.name, *gains, *shares, broken))
    return rows


def notes(tuning: Tuning) -> list[str]:
    """What the gains rest on."""
    return [f"assumed: {text}" for text in tuning.limits.assumptions]
