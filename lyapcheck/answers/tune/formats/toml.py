"""Nothing but the gain file."""

from __future__ import annotations

from lyapcheck.tune.gain_file import gain_file_text
from lyapcheck.tune.results import Tuning


def render(tuning: Tuning) -> str:
    """What ``--out`` writes, for a pipe."""
    return gain_file_text(tuning)
