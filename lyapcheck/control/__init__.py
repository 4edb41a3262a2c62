"""Gains, the limits of an arm, the paper's conditions on both, and the gate that decides them.

Each name is imported from its home when it is first used.
"""

from __future__ import annotations

from lyapcheck.control.gate import gate  # now: its module has the same name
from lyapcheck.lazy import exporter

TYPE_CHECKING = False
if TYPE_CHECKING:
    from lyapcheck.control.gains import Bounds, GainFile, GainSet, read_gain_file
    from lyapcheck.control.gate import GateResult, gate_exit
    from lyapcheck.control.limits import Limits, limits_for
    from lyapcheck.control.paper import paper_gain_file, proofs_folder

__all__ = [
    "Bounds",
    "GainFile",
    "GainSet",
    "GateResult",
    "Limits",
    "gate",
    "gate_exit",
    "limits_for",
    "paper_gain_file",
    "proofs_folder",
    "read_gain_file",
]

_HOMES = {
    "Bounds": "gains",
    "GainFile": "gains",
    "GainSet": "gains",
    "GateResult": "gate",
    "Limits": "limits",
    "gate_exit": "gate",
    "limits_for": "limits",
    "paper_gain_file": "paper",
    "proofs_folder": "paper",
    "read_gain_file": "gains",
}

__getattr__ = exporter(__name__, _HOMES)
