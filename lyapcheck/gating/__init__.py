"""The gate: gain sets accepted or rejected by the conditions that a user wants to hold.

Each name is imported from its home when it is first used.
"""

from __future__ import annotations

from lyapcheck.gating.gate import gate  # now: its module has the same name
from lyapcheck.lazy import exporter

TYPE_CHECKING = False
if TYPE_CHECKING:
    from lyapcheck.gating.gate import GateResult, gate_exit

__all__ = ["GateResult", "gate", "gate_exit"]

_HOMES = {"GateResult": "gate", "gate_exit": "gate"}

__getattr__ = exporter(__name__, _HOMES)
