"""Comparisons between gain sets: performance indices and the four ε₀."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from lyapcheck.output.escapes import plot_text
from lyapcheck.report.figures.plot import Plot
from lyapcheck.report.figures.style import COLOURS, panels, styled

TICK = 24
"""Characters of a name that fit beside or below an axis."""
MARKERS = ("o", "s", "D", "X")
HATCHES = ("", "///", "\\\\\\")
"""One for each source, for grey prints."""


def indices_plot(names: Sequence[str], bars: Mapping[str, Sequence[float | None]]) -> Plot:
    """The L2 index in degrees of each gain set, one bar a source (simulated, printed).

    References: (20) and Fig. 11 of reyes2019family.
    """
    with styled():
        figure, axes = panels(1, 1, height=2.9)
        axis, width = axes[0, 0], 0.8 / len(bars)
        for index, (source, values) in enumerate(bars.items()):
            places = [i + (index - (len(bars) - 1) / 2) * width for i in range(len(names))]
            drawn = axis.bar(
                places,
                [value or 0.0 for value in values],
                width,
                label=source,
                color=COLOURS[index],
                hatch=HATCHES[index % len(HATCHES)],
                edgecolor="white",
            )
            texts = ["" if value is None else f"{value:.1f}" for value in values]
            axis.bar_label(drawn, texts, fontsize=8, padding=2)
        axis.set_xticks(range(len(names)), [plot_text(name, TICK) for name in names])
        axis.set(ylabel="L2 index [°]", title="Performance index (20), T = 5 s")
        axis.grid(axis="x", visible=False)
        axis.margins(y=0.15)
        figure.legend(ncols=len(bars), loc="outside lower center")
    rows = ([name, *(bars[source][i] for source in bars)] for i, name in enumerate(names))
    return Plot(figure, ["gains", *(f"{source} [deg]" for source in bars)], list(rows))


def damping_plot(names: Sequence[str], values: Sequence[float], limits: Sequence[float]) -> Plot:
    """The largest k_v of each gain set beside the largest that (19) admits, both in N·m.

    References: (19) of reyes2019family.
    """
    with styled():
        figure, axes = panels(1, 1, width=4.6, height=2.4)
        axis = axes[0, 0]
        for index, (label, numbers) in enumerate((("λmax(K_v)", values), ("λmin(B)/(√n γ)", limits))):
            places = [i + (index - 0.5) * 0.38 for i in range(len(names))]
            colour = COLOURS[1 - index]
            drawn = axis.bar(places, numbers, 0.38, label=label, color=colour, hatch=HATCHES[index])
            axis.bar_label(drawn, [f"{number:.4g}" for number in numbers], fontsize=8, padding=2)
        axis.set_xticks(range(len(names)), [plot_text(name, TICK) for name in names])
        axis.set(ylabel="N·m", ylim=(0, 1.25 * max([*values, *limits])))
        axis.grid(axis="x", visible=False)
        axis.legend(loc="upper right", ncols=2, fontsize=8)
    rows = list(zip(names, values, limits, strict=True))
    return Plot(figure, ["gains", "largest k_v [N·m]", "limit of (19) [N·m]"], rows)


def epsilon_plot(names: Sequence[str], epsilons: Mapping[str, Sequence[float | None]]) -> Plot:
    """The four ε₀ of each gain set on one logarithmic axis; an ε₀ that does not exist has no mark."""
    with styled():
        figure, axes = panels(1, 1, height=0.8 + 0.45 * len(names))
        axis = axes[0, 0]
        for index, (kind, values) in enumerate(epsilons.items()):
            known = [(value, place) for place, value in enumerate(values) if value is not None]
            if known:
                across, up = zip(*known, strict=True)
                axis.scatter(
                    across, up, label=kind, color=COLOURS[index], marker=MARKERS[index], s=42, zorder=3
                )
        axis.set_xscale("log")
        axis.set_yticks(range(len(names)), [plot_text(name, TICK) for name in names])
        axis.invert_yaxis()
        axis.margins(y=0.3)
        axis.set(xlabel="ε₀ [1/s]", title="ε₀: what is published, proved and refuted")
        figure.legend(ncols=4, loc="outside lower center")
    rows = ([name, *(epsilons[kind][i] for kind in epsilons)] for i, name in enumerate(names))
    return Plot(figure, ["gains", *(f"{kind} [1/s]" for kind in epsilons)], list(rows))
