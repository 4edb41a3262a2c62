"""The promises of (21) along a run: dV/dt below its form, each torque below its bound."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from lyapcheck.simulate.breach import Breach, Monitor, Watched

Array = NDArray[np.float64]

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


def torque_monitor(bounds: tuple[float, ...] | None) -> Monitor:
    """Each |τ_i| at most its bound of `torque_bounds`, N·m."""

    def monitor(run: Watched) -> Breach | None:
        if bounds is None:
            return None
        beyond = np.argwhere(np.abs(run.tau) > np.array(bounds) * (1 + 1e-12))
        if not beyond.size:
            return None
        i, joint = beyond[0].tolist()
        name = run.setting.model.joints[joint]
        value = abs(run.tau[i, joint])
        return run.breach(f"|τ| of {name} within its bound for (21)", i, value, bounds[joint], "N·m", False)

    return monitor
