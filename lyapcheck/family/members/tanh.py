"""The hyperbolic tangent: the hyperbolic family at m = 1, under its own name."""

from __future__ import annotations

from dataclasses import dataclass

from lyapcheck.check.expressions.expression import Tree
from lyapcheck.family.base import require_none
from lyapcheck.family.members.hyperbolic import Hyperbolic


@dataclass(frozen=True)
class Tanh(Hyperbolic):
    """h = tanh x, h' = sech²x, U = ln cosh x."""

    @property
    def gamma(self) -> Tree:
        """1."""
        return "num", "1"

    @property
    def _member(self) -> int:
        return 1


def create(m: int | None) -> Tanh:
    """The one member."""
    require_none("tanh", m)
    return Tanh("tanh")
