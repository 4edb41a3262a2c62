"""The functions of the family, and γ_m, ρ_m and L_m against m, beside what they tend to."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from lyapcheck.answers.table import Table
from lyapcheck.check.numbers.polynomials import Enclosure
from lyapcheck.family import Family
from lyapcheck.family.asymptotes import asymptotes, limits
from lyapcheck.report.plots import COLOURS, DASHES, Plot, panels, png, styled, svg


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


MOST_MARKERS = 40
"""With more members than these the points would run together: a line instead."""
MOST_LINEAR = 20
"""The last m over the first beyond which the axes are logarithmic."""


def constants_svg(table: Table) -> str:
    """The figure as SVG text."""
    return svg(_figure(table))


def constants_png(table: Table) -> bytes:
    """The figure as a PNG file."""
    return png(_figure(table))


def _figure(table: Table) -> Any:
    """One panel a constant: its values, the leading terms for m → ∞, and the limit."""
    tails = [asymptotes(row, table.digits) for row in table.rows]
    root, secant = (float(limit.mid()) for limit in limits())
    with styled():
        figure, axes = panels(1, 3)
        gamma, rho, L = axes[0]
        _draw(gamma, table, [row.gamma for row in table.rows], [tail.gamma for tail in tails])
        _draw(rho, table, [row.rho for row in table.rows], [tail.rho for tail in tails])
        _draw(L, table, [row.L for row in table.rows], [tail.L for tail in tails])
        gamma.set(title="γ = sup h", ylabel="γ", ylim=_room(table, "gamma", root))
        L.set(title="L = sup h(x)/x", ylabel="L", ylim=_room(table, "L", secant))
        _limit(gamma, root, "√2")
        _limit(L, secant, "√2/asinh 1")
        rho.set(title="ρ = sup |h′|", ylabel="ρ", yscale=rho.get_xscale())
        figure.legend(*gamma.get_legend_handles_labels(), loc="outside lower center", ncols=3)
        for axis in (gamma.xaxis, rho.xaxis, L.xaxis, rho.yaxis):
            _plain(axis)
    return figure


def _draw(axis: Any, table: Table, values: Sequence[Enclosure], leading: Sequence[Enclosure]) -> None:
    ms = [row.m for row in table.rows]
    few = len(ms) <= MOST_MARKERS
    dots = (
        {"marker": "o", "markersize": 3.5, "linestyle": "none"} if few else {"linewidth": 2.4, "alpha": 0.8}
    )
    axis.plot(ms, _floats(values), color=COLOURS[0], label="certified", **dots)
    beside = {"marker": "_", "markersize": 7} if len(ms) == 1 else {}
    axis.plot(
        ms,
        _floats(leading),
        color=COLOURS[1],
        linestyle="--",
        linewidth=1.2,
        label="leading terms for m → ∞",
        **beside,
    )
    if len(ms) == 1:
        axis.set_xlim(ms[0] - 1, ms[0] + 1)
    axis.set(xlabel="m", xscale="log" if max(ms) > MOST_LINEAR * min(ms) else "linear")


def _limit(axis: Any, value: float, name: str) -> None:
    axis.axhline(value, color=COLOURS[2], linestyle=":", linewidth=1.2, label="limit")
    axis.annotate(
        name, (0, value), xycoords=("axes fraction", "data"), xytext=(3, -10), textcoords="offset points"
    )


def _plain(axis: Any) -> None:
    """Whole numbers on an axis: 1, 10, 100 where it is logarithmic."""
    from matplotlib.ticker import MaxNLocator, NullFormatter, StrMethodFormatter

    if axis.get_scale() == "log":
        axis.set_minor_formatter(NullFormatter())
    else:
        axis.set_major_locator(MaxNLocator(nbins=6, integer=True))
    axis.set_major_formatter(StrMethodFormatter("{x:g}"))


def _floats(values: Sequence[Enclosure]) -> list[float]:
    return [float(value.mid) for value in values]


def _room(table: Table, name: str, limit: float) -> tuple[float, float]:
    """From below the least value to above the limit; leading terms of small m may leave below."""
    least = min(_floats([getattr(row, name) for row in table.rows]))
    return least - 0.25 * (limit - least), limit + 0.08 * (limit - least)
