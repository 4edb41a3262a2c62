"""V and dV/dt along a simulated run."""

from __future__ import annotations

from typing import Any

import numpy as np

from lyapcheck._types import Array
from lyapcheck.output.escapes import plot_text
from lyapcheck.report.figures.style import COLOURS, panels, styled


def draw_lyapunov(title: str, t: Array, V: Array, dV: Array, bound: Array | None = None) -> Any:
    """V in J and −dV/dt in W over time on logarithmic axes; a rising V shows as a gap in the right panel.

    ``bound`` (N,) in W is what dV/dt must stay below.

    References: (12) and (15) of reyes2019family.
    """
    with styled():
        figure, axes = panels(1, 2, height=2.6)
        axes[0, 0].semilogy(t, _positive(V), color=COLOURS[0])
        axes[0, 0].set(xlabel="t [s]", ylabel="V [J]", title=plot_text(title), xlim=(t[0], t[-1]))
        axes[0, 1].semilogy(t, _positive(-dV), color=COLOURS[1])
        axes[0, 1].set(xlabel="t [s]", ylabel="−dV/dt [W]", title="rate of decrease", xlim=(t[0], t[-1]))
        if bound is not None:
            axes[0, 1].semilogy(
                t, _positive(-bound), color=COLOURS[2], linestyle="--", label="promised at least"
            )
            axes[0, 1].legend()
        return figure


def _positive(values: Array) -> Array:
    """The values where they can be drawn on a logarithmic axis, gaps elsewhere."""
    return np.where(values > 0.0, values, np.nan)
