"""All figures of a report, by file name: each as SVG and PNG, with its data as CSV."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from lyapcheck.report.model import KINDS

if TYPE_CHECKING:
    from lyapcheck.answers.gate.judge import GateResult
    from lyapcheck.report.figures.style import Files
    from lyapcheck.report.jobs import GainData
    from lyapcheck.report.model import EpsilonRow, RunRow


def draw_family(ms: Sequence[int]) -> Files:
    """The functions h of the members and their derivatives."""
    from lyapcheck.family import hyperbolic
    from lyapcheck.report.figures.constants import family_plot

    return family_plot([(f"m = {m}", hyperbolic(m)) for m in ms]).files("family")


def draw_set(data: GainData) -> Files:
    """Errors, torques, V and dV/dt of the simulated run of a gain set."""
    import numpy as np

    from lyapcheck.report.figures.motion import draw_errors, draw_lyapunov, draw_torques
    from lyapcheck.report.figures.style import Plot

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
    from lyapcheck.report.figures.motion import epsilon_plot, indices_plot

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
    from lyapcheck.report.figures.motion import damping_plot

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
