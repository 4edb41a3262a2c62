"""All figures of a report, by file name."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from lyapcheck.report.model import Data

if TYPE_CHECKING:
    from lyapcheck.report.jobs import RunData

KINDS = ("published", "scalar", "certified", "falsified")


def draw(
    ms: Sequence[int], claims: Sequence[Data], epsilon: Sequence[Data], runs: Sequence[RunData]
) -> dict[str, str]:
    """SVG text by file name; a comparison that has nothing to compare is left out."""
    from lyapcheck.family import hyperbolic
    from lyapcheck.report.figures.claims import claims_figure
    from lyapcheck.report.figures.family import family_figure

    figures = {"family.svg": family_figure([(f"m = {m}", hyperbolic(m)) for m in ms])}
    for m in ms:
        figures[f"claims_m{m}.svg"] = claims_figure([row for row in claims if row["m"] in (m, None)])
    for run in runs:
        figures |= _of_run(run)
    return figures | _comparisons(epsilon, [run.facts for run in runs])


def _of_run(run: RunData) -> dict[str, str]:
    from lyapcheck.report.figures.lyapunov import lyapunov_figure
    from lyapcheck.report.figures.motion import errors_figure, torques_figure

    facts, name = run.facts, file_stem(run.facts["name"])
    label = facts["name"] if facts["m"] is None else f"{facts['name']} (m = {facts['m']})"
    return {
        f"{name}_errors.svg": errors_figure(label, run.t, run.e, facts["joints"]),
        f"{name}_torques.svg": torques_figure(label, run.t, run.tau, facts["joints"], facts["torque_limit"]),
        f"{name}_lyapunov.svg": lyapunov_figure(label, run.t, run.V, run.dV),
    }


def _comparisons(epsilon: Sequence[Data], runs: Sequence[Data]) -> dict[str, str]:
    from lyapcheck.report.figures.bars import epsilon_figure, indices_figure

    figures = {}
    if runs:
        bars = {"simulated": [run["L2"] for run in runs]}
        printed = [run["printed"]["L2"] if run["printed"] else None for run in runs]
        if any(value is not None for value in printed):
            bars["measured in the paper"] = printed
        figures["indices.svg"] = indices_figure([run["name"] for run in runs], bars)
    known = [row for row in epsilon if any(row[kind] is not None for kind in KINDS)]
    if known:
        values = {kind: [_float(row[kind]) for row in known] for kind in KINDS}
        figures["epsilon.svg"] = epsilon_figure([row["name"] for row in known], values)
    return figures


def file_stem(name: str) -> str:
    """A gain set's name as part of a file name: letters, digits, dash and underscore; never a path."""
    return "".join(c if c.isalnum() or c in "-_" else "_" for c in name)


def _float(text: str | None) -> float | None:
    return None if text is None else float(text)
