"""Both sides of a relation that fails, over the one letter that its witness moves."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from lyapcheck.claims.procedures.sampling import values_of
from lyapcheck.report.figures.plot import Plot
from lyapcheck.report.figures.style import COLOURS, panels, styled

if TYPE_CHECKING:
    from lyapcheck.claims.smallest import RefutedBelow

POINTS = 161
AXES = {"eps0": "ε₀ [1/s]", "x": "x [rad]", "e": "q̃ [rad]"}


def sides_plot(witness: RefutedBelow) -> Plot:
    """Left and right side, what fails shaded, the witness marked; angles from −π to π, ε₀ from 0 on."""
    at = float(witness.point[witness.moved])
    is_angle = witness.moved != "eps0"
    grid = np.linspace(-np.pi, np.pi, POINTS) if is_angle else np.linspace(0.0, 1.25 * at, POINTS)
    fixed = {name: np.full(POINTS, float(value)) for name, value in witness.point.items()}
    over = {**fixed, witness.moved: grid}
    left, right = (values_of(side, over) for side in (witness.relation.left, witness.relation.right))
    own = [np.interp(at, grid, side) for side in (left, right)]
    with styled():
        figure, axes = panels(1, 1, width=4.6, height=2.7)
        axis = axes[0, 0]
        axis.plot(grid, left, color=COLOURS[1], label="left")
        axis.plot(grid, right, color=COLOURS[0], linestyle="--", label="right")
        axis.fill_between(grid, left, right, where=left > right, color=COLOURS[1], alpha=0.15, linewidth=0)
        axis.plot([at, at], own, color="black", linewidth=1.2, marker="o", markersize=4)
        stem = witness.moved.rstrip("0123456789") if is_angle else witness.moved
        axis.set(xlabel=AXES[stem])
        axis.margins(x=0)
        axis.locator_params(nbins=6)
        axis.legend(loc="best")
    header = [AXES[stem], "left", "right"]
    return Plot(figure, header, np.column_stack([grid, left, right]))
