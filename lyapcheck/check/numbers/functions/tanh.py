"""The hyperbolic tangent: the hyperbolic family at m = 1, under its own name."""

from __future__ import annotations

from lyapcheck.check.numbers.functions import hyperbolic
from lyapcheck.check.numbers.members import Member, require_single


def create(m: int | None) -> Member:
    """h = tanh x."""
    require_single("tanh", m)
    return hyperbolic.create(1)
