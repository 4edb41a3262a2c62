"""Gains, the limits of an arm, the paper's conditions on both, and the gate that decides them."""

from lyapcheck.control.gains import Bounds, GainFile, GainSet, read_gain_file
from lyapcheck.control.gate import GateResult, gate, gate_exit
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
