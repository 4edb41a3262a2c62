"""Which conditions decide about a gain set: those asked for, else its own, else the paper's two."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

DECIDING = ("10p", "19")
"""The paper's tuning rules, for a gain set that names no conditions."""
CERTIFICATES = ("scalar", "global", "lasalle")
"""Proofs of stability for one arm and one gain set."""
KNOWN = ("10", "10p", "10i", "19", *CERTIFICATES)
"""Every condition that may decide."""


class Conditioned(Protocol):
    """A gain set that may name its conditions."""

    @property
    def condition(self) -> tuple[str, ...]:
        """The conditions; empty where the set names none."""


def deciding_for(gains: Conditioned, asked: Sequence[str] | None = None) -> tuple[str, ...]:
    """Return the conditions that decide about a gain set.

    Args:
        gains: the set; ``condition`` of its file is part of it.
        asked: conditions of the command line, which go before those of the set; ``None`` without any.
    """
    return tuple(dict.fromkeys(gains.condition or DECIDING if asked is None else asked))
