"""The bounded functions and their derivatives, as in Fig. 1 of the paper."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from lyapcheck.family import Family
from lyapcheck.report.figures.style import COLOURS, DASHES, Plot, panels, styled


def family_plot(families: Sequence[tuple[str, Family]]) -> Plot:
    """h and h' of each labelled family over x ∈ [−4, 4] rad, with γ as a thin line.

    References: Fig. 1 of reyes2019family.
    """
    x = np.linspace(-4.0, 4.0, 801)
    header, columns = ["x [rad]"], [x]
    with styled():
        figure, axes = panels(1, 2)
        for index, (label, family) in enumerate(families):
            look = {"color": COLOURS[index % len(COLOURS)], "linestyle": DASHES[index % len(DASHES)]}
            h, dh = family.h(x), family.dh(x)
            axes[0, 0].plot(x, h, label=label, **look)
            axes[0, 1].plot(x, dh, label=label, **look)
            header, columns = [*header, f"h ({label})", f"h' ({label})"], [*columns, h, dh]
            gamma = family.constants().gamma
            if gamma is not None:
                axes[0, 0].axhline(float(gamma.mid), color=look["color"], linewidth=0.6)
        axes[0, 0].set(xlabel="x [rad]", ylabel="h(x)", title="The family; thin lines: γ")
        axes[0, 1].set(xlabel="x [rad]", ylabel="h′(x)", title="Its derivative")
        axes[0, 0].legend()
    return Plot(figure, header, np.column_stack(columns))
