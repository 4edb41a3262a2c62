"""Joint angles, and their rates, as they are typed: degrees, separated by commas."""

from __future__ import annotations

import math

from lyapcheck.errors import argument_error

MOST_DEGREES = 36_000.0
"""A hundred turns of a joint."""


def parse_angles(option: str, text: str, joints: tuple[str, ...]) -> tuple[float, ...]:
    """The angles in rad, one a joint.

    Raises:
        InputError: something that is not a number of degrees, or another number of angles than joints.
    """
    words = [word.strip() for word in text.split(",")] if text.strip() else []
    example = f"write {option} {','.join(['45'] * len(joints))}"
    if len(words) != len(joints):
        many = "number" if len(words) == 1 else "numbers"
        rule = f"has {len(words)} {many}, but the arm has {len(joints)} joints ({', '.join(joints)})"
        raise argument_error(option, text, rule, example)
    degrees = [_degrees(word) for word in words]
    if any(math.isnan(angle) for angle in degrees):
        rule = f"each must be a number from {-MOST_DEGREES:g} to {MOST_DEGREES:g} degrees"
        raise argument_error(option, text, rule, example)
    return tuple(math.radians(angle) for angle in degrees)


def _degrees(word: str) -> float:
    """The number, NaN if it is none or out of range."""
    try:
        angle = float(word)
    except ValueError:
        return math.nan
    return angle if abs(angle) <= MOST_DEGREES else math.nan
