"""The promise of (21) along a run: dV/dt below its form."""

from __future__ import annotations

import numpy as np

from lyapcheck._types import Array
from lyapcheck.simulate.breach import Breach, Monitor, Watched

ROUNDING = 1e-9
"""How far dV/dt may be above its bound, relative to the larger of both: what doubles may do."""


def form_monitor(bound: Array | None) -> Monitor:
    """dV/dt ≤ −[a b] Θ' [a b]ᵀ at every sample; ``bound`` (N,) in W."""

    def monitor(run: Watched) -> Breach | None:
        if bound is None:
            return None
        scale = ROUNDING * max(float(np.max(np.abs(bound))), float(np.max(np.abs(run.dV))))
        beyond = np.flatnonzero(run.dV > bound + scale)
        if not beyond.size:
            return None
        i = int(beyond[0])
        return run.breach("dV/dt ≤ −zᵀΘ'z", i, run.dV[i], bound[i], "W", False)

    return monitor
