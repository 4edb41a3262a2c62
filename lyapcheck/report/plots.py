"""The figures: the family, one simulated run as in Figs. 3 to 10 of the paper, the four ε₀.

Colours are those that colour-blind readers can tell apart; equal data give equal bytes.
"""

from __future__ import annotations

from collections.abc import Sequence
from io import BytesIO, StringIO
from typing import TYPE_CHECKING, Any

import numpy as np

from lyapcheck._types import Array
from lyapcheck.files.fields import file_stem
from lyapcheck.output.escapes import plot_text
from lyapcheck.report.model import KINDS

if TYPE_CHECKING:
    from lyapcheck.report.jobs import GainData
    from lyapcheck.report.model import EpsilonRow
    from lyapcheck.simulate.run import Motion

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
"""Okabe and Ito's palette, strongest contrasts first."""
DASHES = ("-", "--", "-.", ":")
"""A line style for each curve as well, for grey prints."""
DOTS_PER_INCH = 200
Files = dict[str, str]
SETTINGS = {
    "svg.hashsalt": "lyapcheck",
    "svg.fonttype": "none",
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans", "Arial", "Helvetica"],
    "font.size": 9,
    "axes.titlesize": 10,
    "axes.titlelocation": "left",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#dddddd",
    "grid.linewidth": 0.6,
    "lines.linewidth": 1.6,
    "legend.frameon": False,
    "path.simplify": True,
    "path.simplify_threshold": 0.3,
}


def panels(rows: int, columns: int, width: float = 7.2, height: float = 3.0) -> tuple[Any, Any]:
    """A figure of ``rows`` × ``columns`` axes, sizes in inches; drawn without any global state."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, height), layout="constrained")
    return figure, figure.subplots(rows, columns, squeeze=False)


def svg(figure: Any) -> str:
    """The figure as SVG text: no date, no random ids, so that equal data give equal bytes."""
    text = StringIO()
    with styled():
        figure.savefig(text, format="svg", metadata={"Date": None, "Creator": None})
    return "\n".join(line.rstrip() for line in text.getvalue().splitlines()) + "\n"


def png(figure: Any) -> bytes:
    """The figure as PNG for print, 200 dots an inch, without the version of what drew it.

    It has 256 colours: a drawing of lines needs no more, and a third of the bytes.
    """
    from PIL import Image

    data = BytesIO()
    with styled():
        figure.savefig(data, format="png", dpi=DOTS_PER_INCH, metadata={"Software": None})
    flat = Image.open(data).convert("RGB")
    few = flat.quantize(method=Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE)
    paper, colours = 3 * few.tobytes()[0], few.getpalette() or []
    colours[paper : paper + 3] = flat.tobytes()[:3]  # rounding must not tint it
    few.putpalette(colours)
    smaller = BytesIO()
    few.save(smaller, format="png", dpi=(DOTS_PER_INCH, DOTS_PER_INCH))
    return smaller.getvalue()


def styled() -> Any:
    """The context in which figures are built: the settings above, undone afterwards."""
    import matplotlib as mpl

    return mpl.rc_context(SETTINGS)


# --- One run over time.


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
            axis.plot(t, np.degrees(e[:, i]), label=plot_text(joint), **_look(i))
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
        figure, axes = _per_joint(title, "torque [N·m]", t, joints)
        for i, (axis, limit) in enumerate(zip(axes, limits, strict=True)):
            axis.plot(t, tau[:, i], color=COLOURS[i % len(COLOURS)])
            for sign in (1.0, -1.0):
                if limit is not None and np.max(sign * tau[:, i]) > 0.25 * limit:
                    axis.axhline(sign * limit, color="black", linestyle=":", linewidth=1.0)
        return figure


def draw_tracking(title: str, t: Array, q: Array, goal: Array, joints: Sequence[str]) -> Any:
    """Joint angles in degrees beside what they should follow; ``q`` and ``goal`` (N, n) in rad."""
    with styled():
        figure, axes = _per_joint(title, "angle [°]", t, joints)
        for i, axis in enumerate(axes):
            axis.plot(t, np.degrees(goal[:, i]), color="black", linestyle="--", label="reference")
            axis.plot(t, np.degrees(q[:, i]), color=COLOURS[i % len(COLOURS)], label="joint")
        figure.legend(*axes[0].get_legend_handles_labels(), loc="outside upper right", ncols=2)
        return figure


def _per_joint(title: str, label: str, t: Array, joints: Sequence[str]) -> tuple[Any, list[Any]]:
    """A panel a joint, three in a row, with the label at the left of each row."""
    rows, columns = -(-len(joints) // ABREAST), min(len(joints), ABREAST)
    figure, axes = panels(rows, columns, height=0.6 + 2.0 * rows)
    figure.suptitle(plot_text(title), x=0.01, ha="left", fontsize=10)
    used = list(axes.flat)[: len(joints)]
    for axis in list(axes.flat)[len(joints) :]:
        axis.set_axis_off()
    for axis, joint in zip(used, joints, strict=True):
        axis.set(xlabel="t [s]", title=plot_text(joint), xlim=(t[0], t[-1]))
    for axis in used[::columns]:
        axis.set_ylabel(label)
    return figure, used


def _look(index: int) -> dict[str, str]:
    return {"color": COLOURS[index % len(COLOURS)], "linestyle": DASHES[index % len(DASHES)]}


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
            look = {"color": COLOURS[2], "linestyle": "--", "label": "promised at least"}
            axes[0, 1].semilogy(t, _positive(-bound), **look)
            axes[0, 1].legend()
        return figure


def _positive(values: Array) -> Array:
    """The values where they can be drawn on a logarithmic axis, gaps elsewhere."""
    return np.where(values > 0.0, values, np.nan)


def drawn(title: str, run: Motion) -> dict[str, Any]:
    """The figures of a run by what they show; of one along a reference also the angles beside it."""
    goal, bound = (getattr(run, name, None) for name in ("goal", "bound"))
    if run.t.size < 2:
        return {}
    figures = {
        "errors": draw_errors(title, run.t, run.e, run.joints),
        "torques": draw_torques(title, run.t, run.tau, run.joints, run.torque_limit),
        "lyapunov": draw_lyapunov(title, run.t, run.V, run.dV, bound),
    }
    return (
        figures
        if goal is None
        else figures | {"angles": draw_tracking(title, run.t, run.q, goal, run.joints)}
    )


# --- Figures of a report: the four ε₀, the family, the run of each gain set.


TICK = 24
"""Characters of a name that fit beside or below an axis."""
MARKERS = ("o", "s", "D", "X")


def draw_epsilon(epsilon: Sequence[EpsilonRow]) -> Files:
    """The four ε₀ of each gain set that has any, on one logarithmic axis; one that is missing has no mark."""
    rows = [row for row in epsilon if any(getattr(row, kind) is not None for kind in KINDS)]
    if not rows:
        return {}
    names = [row.name for row in rows]
    values = {
        kind: [None if (text := getattr(row, kind)) is None else float(text) for row in rows]
        for kind in KINDS
    }
    with styled():
        figure, axes = panels(1, 1, height=0.8 + 0.45 * len(names))
        axis = axes[0, 0]
        for index, (kind, some) in enumerate(values.items()):
            known = [(value, place) for place, value in enumerate(some) if value is not None]
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
    return {"epsilon.svg": svg(figure)}


def draw_family(ms: Sequence[int]) -> Files:
    """h and h' of each member over x ∈ [−4, 4] rad, with γ as a thin line.

    References: Fig. 1 of reyes2019family.
    """
    from lyapcheck.family import hyperbolic

    x = np.linspace(-4.0, 4.0, 801)
    with styled():
        figure, axes = panels(1, 2)
        for index, m in enumerate(ms):
            look = _look(index)
            family = hyperbolic(m)
            axes[0, 0].plot(x, family.h(x), label=f"m = {m}", **look)
            axes[0, 1].plot(x, family.dh(x), label=f"m = {m}", **look)
            if (gamma := family.constants().gamma) is not None:
                axes[0, 0].axhline(float(gamma.mid), color=look["color"], linewidth=0.6)
        axes[0, 0].set(xlabel="x [rad]", ylabel="h(x)", title="The family; thin lines: γ")
        axes[0, 1].set(xlabel="x [rad]", ylabel="h′(x)", title="Its derivative")
        axes[0, 0].legend()
    return {"family.svg": svg(figure)}


def draw_set(data: GainData) -> Files:
    """Errors and torques of the simulated run of a gain set."""
    run, row = data.run, data.row
    label = row.name if row.m is None else f"{row.name} (m = {row.m})"
    figures = {
        "errors": draw_errors(label, run.t, run.e, row.joints),
        "torques": draw_torques(label, run.t, run.tau, row.joints, row.torque_limit),
    }
    return {f"{file_stem(row.name)}_{what}.svg": svg(figure) for what, figure in figures.items()}
