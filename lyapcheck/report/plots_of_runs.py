"""The figures: the family, one simulated run as in Figs. 3 to 10 of the paper, gain sets compared."""

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


# --- Comparisons between gain sets: performance indices, condition (19) and the four ε₀.


TICK = 24
"""Characters of a name that fit beside or below an axis."""
MARKERS = ("o", "s", "D", "X")
HATCHES = ("", "///", "\\\\\\")
"""One for each source, for grey prints."""
Values = Mapping[str, Sequence[float | None]]
"""By where they are from, one of each gain set; ``None`` where there is none."""


def indices_plot(names: Sequence[str], bars: Values) -> Plot:
    """The L2 index in degrees of each gain set, one bar a source (simulated, printed).

    References: (20) and Fig. 11 of reyes2019family.
    """
    with styled():
        figure, axis = _bars(names, bars, ".1f", width=7.2, height=2.9)
        axis.set(ylabel="L2 index [°]", title="Performance index (20), T = 5 s")
        axis.margins(y=0.15)
        figure.legend(ncols=len(bars), loc="outside lower center")
    return _compared(figure, names, bars, "deg")


def damping_plot(names: Sequence[str], bars: Values) -> Plot:
    """The largest k_v of each gain set beside the largest that (19) admits, both in N·m.

    References: (19) of reyes2019family.
    """
    with styled():
        figure, axis = _bars(names, bars, ".4g", width=4.6, height=2.4)
        most = max(value or 0.0 for values in bars.values() for value in values)
        axis.set(ylabel="N·m", ylim=(0, 1.25 * most))
        axis.legend(loc="upper right", ncols=2, fontsize=8)
    return _compared(figure, names, bars, "N·m")


def epsilon_plot(names: Sequence[str], epsilons: Values) -> Plot:
    """The four ε₀ of each gain set on one logarithmic axis; an ε₀ that does not exist has no mark."""
    with styled():
        figure, axes = panels(1, 1, height=0.8 + 0.45 * len(names))
        axis = axes[0, 0]
        for index, (kind, values) in enumerate(epsilons.items()):
            known = [(value, place) for place, value in enumerate(values) if value is not None]
            if known:
                across, up = zip(*known, strict=True)
                look = {"color": COLOURS[index], "marker": MARKERS[index]}
                axis.scatter(across, up, label=kind, s=42, zorder=3, **look)
        axis.set_xscale("log")
        axis.set_yticks(range(len(names)), [plot_text(name, TICK) for name in names])
        axis.invert_yaxis()
        axis.margins(y=0.3)
        axis.set(xlabel="ε₀ [1/s]", title="ε₀: what is published, proved and refuted")
        figure.legend(ncols=4, loc="outside lower center")
    return _compared(figure, names, epsilons, "1/s")


def _bars(names: Sequence[str], bars: Values, form: str, **size: float) -> tuple[Any, Any]:
    """Bars side by side for each gain set, each with its number."""
    figure, axes = panels(1, 1, **size)
    axis, width = axes[0, 0], 0.8 / len(bars)
    for index, (source, values) in enumerate(bars.items()):
        places = [i + (index - (len(bars) - 1) / 2) * width for i in range(len(names))]
        look = {"color": COLOURS[index], "hatch": HATCHES[index % len(HATCHES)], "edgecolor": "white"}
        drawn = axis.bar(places, [value or 0.0 for value in values], width, label=source, **look)
        texts = ["" if value is None else format(value, form) for value in values]
        axis.bar_label(drawn, texts, fontsize=8, padding=2)
    axis.set_xticks(range(len(names)), [plot_text(name, TICK) for name in names])
    axis.grid(axis="x", visible=False)
    return figure, axis


def _compared(figure: Any, names: Sequence[str], values: Values, unit: str) -> Plot:
    rows = [[name, *(values[kind][i] for kind in values)] for i, name in enumerate(names)]
    return Plot(figure, ["gains", *(f"{kind} [{unit}]" for kind in values)], rows)


# --- All figures of a report, by file name: each as SVG and PNG, with its data as CSV.


def draw_family(ms: Sequence[int]) -> Files:
    """h and h' of each member over x ∈ [−4, 4] rad, with γ as a thin line.

    References: Fig. 1 of reyes2019family.
    """
    from lyapcheck.family import hyperbolic

    x = np.linspace(-4.0, 4.0, 801)
    header, columns = ["x [rad]"], [x]
    with styled():
        figure, axes = panels(1, 2)
        for index, m in enumerate(ms):
            look = {"color": COLOURS[index % len(COLOURS)], "linestyle": DASHES[index % len(DASHES)]}
            family, label = hyperbolic(m), f"m = {m}"
            h, dh = family.h(x), family.dh(x)
            axes[0, 0].plot(x, h, label=label, **look)
            axes[0, 1].plot(x, dh, label=label, **look)
            header, columns = [*header, f"h ({label})", f"h' ({label})"], [*columns, h, dh]
            if (gamma := family.constants().gamma) is not None:
                axes[0, 0].axhline(float(gamma.mid), color=look["color"], linewidth=0.6)
        axes[0, 0].set(xlabel="x [rad]", ylabel="h(x)", title="The family; thin lines: γ")
        axes[0, 1].set(xlabel="x [rad]", ylabel="h′(x)", title="Its derivative")
        axes[0, 0].legend()
    return Plot(figure, header, np.column_stack(columns)).files("family")


def draw_set(data: GainData) -> Files:
    """Errors, torques, V and dV/dt of the simulated run of a gain set."""
    run, row = data.run, data.row
    name, joints = file_stem(row.name), row.joints
    label = row.name if row.m is None else f"{row.name} (m = {row.m})"
    e, tau = (["t [s]", *(f"{joint} [{unit}]" for joint in joints)] for unit in ("deg", "N·m"))
    plots = {
        "errors": Plot(draw_errors(label, run.t, run.e, joints), e, _columns(run.t, np.degrees(run.e))),
        "torques": Plot(
            draw_torques(label, run.t, run.tau, joints, row.torque_limit), tau, _columns(run.t, run.tau)
        ),
        "lyapunov": Plot(
            draw_lyapunov(label, run.t, run.V, run.dV),
            ["t [s]", "V [J]", "dV/dt [W]"],
            _columns(run.t, run.V, run.dV),
        ),
    }
    return {file: text for what, plot in plots.items() for file, text in plot.files(f"{name}_{what}").items()}


def _columns(*parts: Array) -> Array:
    return np.column_stack(parts)


def draw_comparisons(epsilon: Sequence[EpsilonRow], runs: Sequence[RunRow]) -> Files:
    """Gain sets side by side; a comparison that has nothing to compare is left out."""
    figures: Files = {}
    if runs:
        bars = {
            "simulation of (11)": [run.L2 for run in runs],
            "measured in the paper": [run.printed["L2"] if run.printed else None for run in runs],
        }
        known = {source: values for source, values in bars.items() if any(x is not None for x in values)}
        figures |= indices_plot([run.name for run in runs], known).files("indices")
    rows = [row for row in epsilon if any(row.eps0(kind) is not None for kind in KINDS)]
    if rows:
        values = {
            kind: [None if (text := row.eps0(kind)) is None else float(text) for row in rows]
            for kind in KINDS
        }
        figures |= epsilon_plot([row.name for row in rows], values).files("epsilon")
    return figures


def draw_damping(gate: Sequence[GateResult]) -> Files:
    """Condition (19) of each gain set to which it applies; nothing where it applies to none."""
    bars: dict[str, list[float | None]] = {"λmax(K_v)": [], "λmin(B)/(√n γ)": []}
    names = []
    for result in gate:
        checks = [check for check in result.checks if check.id == "19"]
        admitted = [float(check.limit.lower) for check in checks if check.limit is not None]
        if admitted:
            names.append(result.name)
            largest = max(float(check.value or 0) for check in checks)
            for values, value in zip(bars.values(), (largest, admitted[0]), strict=True):
                values.append(value)
    return damping_plot(names, bars).files("damping") if names else {}


def file_stem(name: str) -> str:
    """A gain set's name as part of a file name: letters, digits, dash and underscore; never a path."""
    return "".join(c if c.isalnum() or c in "-_" else "_" for c in name)
