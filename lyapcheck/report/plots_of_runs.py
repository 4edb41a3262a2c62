"""Position errors and torques of one simulated run, as in Figs. 3 to 10 of the paper."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from lyapcheck._types import Array
from lyapcheck.output.escapes import plot_text
from lyapcheck.report.model import KINDS
from lyapcheck.report.plots import COLOURS, DASHES, Plot, panels, styled

if TYPE_CHECKING:
    from lyapcheck.answers.gate.judge import GateResult
    from lyapcheck.report.jobs import GainData
    from lyapcheck.report.model import EpsilonRow, RunRow
    from lyapcheck.report.plots import Files


ABREAST = 3
"""Panels in a row, and names in a row of a legend."""


def draw_errors(title: str, t: Array, e: Array, joints: Sequence[str]) -> Any:
    """Position errors in degrees over time; ``t`` (N,) in s, ``e`` (N, n) in rad.

    References: Figs. 3, 5, 7 and 9 of reyes2019family.
    """
    with styled():
        figure, axes = panels(1, 1, height=2.8)
        axis = axes[0, 0]
        for i, joint in enumerate(joints):
            axis.plot(
                t,
                np.degrees(e[:, i]),
                label=plot_text(joint),
                color=COLOURS[i % len(COLOURS)],
                linestyle=DASHES[i % len(DASHES)],
            )
        axis.axhline(0.0, color="black", linewidth=0.6)
        axis.set(xlabel="t [s]", ylabel="position error [°]", title=plot_text(title), xlim=(t[0], t[-1]))
        axis.legend(ncols=min(len(joints), ABREAST))
        return figure


def draw_torques(
    title: str, t: Array, tau: Array, joints: Sequence[str], limits: Sequence[float | None]
) -> Any:
    """Applied torques in N·m over time, a panel a joint, with the joint's limit; ``tau`` (N, n).

    References: Figs. 4, 6, 8 and 10 of reyes2019family.
    """
    with styled():
        figure, axes = _per_joint("torque [N·m]", t, joints)
        for i, axis in enumerate(axes):
            axis.plot(t, tau[:, i], color=COLOURS[i % len(COLOURS)])
            _mark_limit(axis, tau[:, i], limits[i])
        figure.suptitle(plot_text(title), x=0.01, ha="left", fontsize=10)
        return figure


def draw_tracking(title: str, t: Array, q: Array, goal: Array, joints: Sequence[str]) -> Any:
    """Joint angles in degrees beside what they should follow; ``q`` and ``goal`` (N, n) in rad."""
    with styled():
        figure, axes = _per_joint("angle [°]", t, joints)
        for i, axis in enumerate(axes):
            axis.plot(t, np.degrees(goal[:, i]), color="black", linestyle="--", label="reference")
            axis.plot(t, np.degrees(q[:, i]), color=COLOURS[i % len(COLOURS)], label="joint")
        figure.legend(*axes[0].get_legend_handles_labels(), loc="outside upper right", ncols=2)
        figure.suptitle(plot_text(title), x=0.01, ha="left", fontsize=10)
        return figure


def _per_joint(label: str, t: Array, joints: Sequence[str]) -> tuple[Any, list[Any]]:
    """A panel a joint, three in a row, with the label at the left of each row."""
    rows, columns = -(-len(joints) // ABREAST), min(len(joints), ABREAST)
    figure, axes = panels(rows, columns, height=0.6 + 2.0 * rows)
    used = list(axes.flat)[: len(joints)]
    for axis in list(axes.flat)[len(joints) :]:
        axis.set_axis_off()
    for axis, joint in zip(used, joints, strict=True):
        axis.set(xlabel="t [s]", title=plot_text(joint), xlim=(t[0], t[-1]))
    for axis in used[::columns]:
        axis.set_ylabel(label)
    return figure, used


def _mark_limit(axis: object, tau: Array, limit: float | None) -> None:
    if limit is None:
        return
    for sign in (1.0, -1.0):
        if np.max(sign * tau) > 0.25 * limit:
            axis.axhline(sign * limit, color="black", linestyle=":", linewidth=1.0)  # type: ignore[attr-defined]


# --- V and dV/dt along a simulated run.


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


# --- Comparisons between gain sets: performance indices and the four ε₀.


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


# --- All figures of a report, by file name: each as SVG and PNG, with its data as CSV.


def draw_family(ms: Sequence[int]) -> Files:
    """The functions h of the members and their derivatives."""
    from lyapcheck.family import hyperbolic
    from lyapcheck.report.plots_of_constants import family_plot

    return family_plot([(f"m = {m}", hyperbolic(m)) for m in ms]).files("family")


def draw_set(data: GainData) -> Files:
    """Errors, torques, V and dV/dt of the simulated run of a gain set."""
    import numpy as np

    from lyapcheck.report.plots import Plot
    from lyapcheck.report.plots_of_runs import draw_errors, draw_lyapunov, draw_torques

    run, row = data.run, data.row
    name, joints = file_stem(row.name), row.joints
    label = row.name if row.m is None else f"{row.name} (m = {row.m})"
    errors = draw_errors(label, run.t, run.e, joints)
    torques = draw_torques(label, run.t, run.tau, joints, row.torque_limit)
    falling = draw_lyapunov(label, run.t, run.V, run.dV)
    e, tau = (["t [s]", *(f"{joint} [{unit}]" for joint in joints)] for unit in ("deg", "N·m"))
    return {
        **Plot(errors, e, np.column_stack([run.t, np.degrees(run.e)])).files(f"{name}_errors"),
        **Plot(torques, tau, np.column_stack([run.t, run.tau])).files(f"{name}_torques"),
        **Plot(falling, ["t [s]", "V [J]", "dV/dt [W]"], np.column_stack([run.t, run.V, run.dV])).files(
            f"{name}_lyapunov"
        ),
    }


def draw_comparisons(epsilon: Sequence[EpsilonRow], runs: Sequence[RunRow]) -> Files:
    """Gain sets side by side; a comparison that has nothing to compare is left out."""
    from lyapcheck.report.plots_of_runs import epsilon_plot, indices_plot

    figures: Files = {}
    if runs:
        figures |= indices_plot([run.name for run in runs], _indices(runs)).files("indices")
    known = [row for row in epsilon if any(row.eps0(kind) is not None for kind in KINDS)]
    if known:
        values = {kind: [_float(row.eps0(kind)) for row in known] for kind in KINDS}
        figures |= epsilon_plot([row.name for row in known], values).files("epsilon")
    return figures


def draw_damping(gate: Sequence[GateResult]) -> Files:
    """Condition (19) of each gain set to which it applies; nothing where it applies to none."""
    from lyapcheck.report.plots_of_runs import damping_plot

    rows = {}
    for result in gate:
        checks = [check for check in result.checks if check.id == "19"]
        admitted = [float(check.limit.lower) for check in checks if check.limit is not None]
        if admitted:
            rows[result.name] = max(float(check.value or 0) for check in checks), admitted[0]
    if not rows:
        return {}
    values, limits = zip(*rows.values(), strict=True)
    return damping_plot(list(rows), values, limits).files("damping")


def _indices(runs: Sequence[RunRow]) -> dict[str, list[float | None]]:
    """The L2 index of each run by where it is from; a source without any number is left out."""
    bars = {
        "simulation of (11)": [run.L2 for run in runs],
        "measured in the paper": [run.printed["L2"] if run.printed else None for run in runs],
    }
    return {source: values for source, values in bars.items() if any(value is not None for value in values)}


def file_stem(name: str) -> str:
    """A gain set's name as part of a file name: letters, digits, dash and underscore; never a path."""
    return "".join(c if c.isalnum() or c in "-_" else "_" for c in name)


def _float(text: str | None) -> float | None:
    return None if text is None else float(text)
