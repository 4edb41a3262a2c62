"""Position errors and torques of one simulated run, as in Figs. 3 to 10 of the paper."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lyapcheck.report.figures.style import COLOURS, DASHES, panels, styled, svg

Array = NDArray[np.float64]


def errors_figure(title: str, t: Array, e: Array, joints: Sequence[str]) -> str:
    """Position errors in degrees over time; ``t`` (N,) in s, ``e`` (N, n) in rad.

    References: Figs. 3, 5, 7 and 9 of reyes2019family.
    """
    return svg(draw_errors(title, t, e, joints))


def draw_errors(title: str, t: Array, e: Array, joints: Sequence[str]) -> Any:
    """The figure of `errors_figure` itself."""
    with styled():
        figure, axes = panels(1, 1, height=2.8)
        axis = axes[0, 0]
        for i, joint in enumerate(joints):
            axis.plot(
                t, np.degrees(e[:, i]), label=joint, color=COLOURS[i], linestyle=DASHES[i % len(DASHES)]
            )
        axis.axhline(0.0, color="black", linewidth=0.6)
        axis.set(xlabel="t [s]", ylabel="position error [°]", title=title, xlim=(t[0], t[-1]))
        axis.legend(ncols=len(joints))
        return figure


def torques_figure(
    title: str, t: Array, tau: Array, joints: Sequence[str], limits: Sequence[float | None]
) -> str:
    """Applied torques in N·m over time, a panel a joint, with the joint's limit; ``tau`` (N, n).

    References: Figs. 4, 6, 8 and 10 of reyes2019family.
    """
    return svg(draw_torques(title, t, tau, joints, limits))


def draw_torques(
    title: str, t: Array, tau: Array, joints: Sequence[str], limits: Sequence[float | None]
) -> Any:
    """The figure of `torques_figure` itself."""
    with styled():
        figure, axes = panels(1, len(joints), height=2.6)
        for i, joint in enumerate(joints):
            axis = axes[0, i]
            axis.plot(t, tau[:, i], color=COLOURS[i])
            _mark_limit(axis, tau[:, i], limits[i])
            axis.set(xlabel="t [s]", title=joint, xlim=(t[0], t[-1]))
        axes[0, 0].set_ylabel("torque [N·m]")
        figure.suptitle(title, x=0.01, ha="left", fontsize=10)
        return figure


def draw_tracking(title: str, t: Array, q: Array, goal: Array, joints: Sequence[str]) -> Any:
    """Joint angles in degrees beside what they should follow; ``q`` and ``goal`` (N, n) in rad."""
    with styled():
        figure, axes = panels(1, len(joints), height=2.6)
        for i, joint in enumerate(joints):
            axis = axes[0, i]
            axis.plot(t, np.degrees(goal[:, i]), color="black", linestyle="--", label="reference")
            axis.plot(t, np.degrees(q[:, i]), color=COLOURS[i], label="joint")
            axis.set(xlabel="t [s]", title=joint, xlim=(t[0], t[-1]))
        axes[0, 0].set_ylabel("angle [°]")
        figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside upper right", ncols=2)
        figure.suptitle(title, x=0.01, ha="left", fontsize=10)
        return figure


def _mark_limit(axis: object, tau: Array, limit: float | None) -> None:
    if limit is None:
        return
    for sign in (1.0, -1.0):
        if np.max(sign * tau) > 0.25 * limit:
            axis.axhline(sign * limit, color="black", linestyle=":", linewidth=1.0)  # type: ignore[attr-defined]
