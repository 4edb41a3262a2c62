"""Position errors and torques of one simulated run, as in Figs. 3 to 10 of the paper."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from lyapcheck._types import Array
from lyapcheck.output.escapes import plot_text
from lyapcheck.report.figures.style import COLOURS, DASHES, panels, styled

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
