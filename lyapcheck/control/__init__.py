"""Gains, the limits of an arm, and the paper's conditions on both.

Each name is imported from its home when it is first used.
"""

from __future__ import annotations

from lyapcheck.lazy import exporter

TYPE_CHECKING = False
if TYPE_CHECKING:
    from lyapcheck.control.gains import Bounds, GainFile, GainSet, read_gain_file
    from lyapcheck.control.limits import Limits, limits_for
    from lyapcheck.control.paper import paper_gain_file, proofs_folder

__all__ = [
    "Bounds",
    "GainFile",
    "GainSet",
    "Limits",
    "limits_for",
    "paper_gain_file",
    "proofs_folder",
    "read_gain_file",
]

_HOMES = {
    "Bounds": "gains",
    "GainFile": "gains",
    "GainSet": "gains",
    "Limits": "limits",
    "limits_for": "limits",
    "paper_gain_file": "paper",
    "proofs_folder": "paper",
    "read_gain_file": "gains",
}

__getattr__ = exporter(__name__, _HOMES)
