"""Types, silent progress and the seed that the whole house shares; importing it costs nothing."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]
    """Doubles of any shape; who takes some says which."""
else:
    Array = Any

Progress = Callable[[float, str], None]
"""Takes the fraction done (0 to 1) and a note of a few words."""


def silent(fraction: float, note: str) -> None:
    """Progress that nobody looks at."""


def part(progress: Progress, low: float, high: float, about: str = "") -> Progress:
    """Of work that is done between two fractions of the whole; what it is about stands before its notes."""
    return lambda fraction, note: progress(low + (high - low) * fraction, about + note)


SEED = 20190301
"""Where random choices begin, unless the user says otherwise: the month of the paper."""
