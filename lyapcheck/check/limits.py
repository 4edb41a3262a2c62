"""What reading and judging one certificate may cost."""

from __future__ import annotations

from dataclasses import dataclass

MAX_BYTES = 50_000_000
"""Of a file."""
MAX_NESTING = 400
"""Levels of objects and lists; an expression may have 300 of them."""
MAX_ARM = 9
"""Joints of an arm."""
MOST_CORNERS = 256
"""Of the ranges of an arm's parameters."""
LARGEST = 10**9
"""rad, rad/s, N·m and J: beyond all that is of use."""
SHOWN = 300
"""Characters of a statement, or of its author's words, unless the whole is asked for."""

MOST = 1_000_000
"""Seconds or MiB, beyond which a limit is none."""


@dataclass(frozen=True)
class Limits:
    """Seconds of computing time and MiB that the process may take which judges a certificate."""

    seconds: int = 600
    memory: int = 4096
