"""What this process has found before, forgotten."""

from __future__ import annotations

from lyapcheck.constants.storage.bounds import coriolis_proof
from lyapcheck.constants.storage.motion import program_of


def forget_bounds() -> None:
    """Bounds of k_c along chains, and the programs that were solved for them."""
    program_of.cache_clear()
    coriolis_proof.cache_clear()
