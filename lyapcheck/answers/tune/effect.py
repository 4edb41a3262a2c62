"""What m does, seen in runs: error, torque and speed of the members of the family on one motion."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from lyapcheck.output.digits import at_most, shown
from lyapcheck.output.document import Block, Paragraph, Section, Table

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots import RobotModel
    from lyapcheck.simulate.task import Task

HEADS = ("m", "L2 [°]", "error at the end [°]", "torque share", "top speed [rad/s]", "friction leaves [°]")


@dataclass(frozen=True)
class Effect:
    """One member's run: degrees, the largest share of a motor's limit, rad/s; the worst joint each.

    ``rest`` is how far from the goal dry friction may hold a joint; infinite where it holds it anywhere.
    """

    m: int
    L2: float
    final: float
    share: float
    speed: float
    rest: float

    @property
    def data(self) -> dict[str, Any]:
        """Numbers to six digits; none for infinity."""
        return {"m": self.m} | {
            name: _six(getattr(self, name)) for name in ("L2", "final", "share", "speed", "rest")
        }


def effects(sets: Sequence[GainSet], model: RobotModel, task: Task) -> tuple[Effect, ...]:
    """A run by the equations for each member; one that could not be finished is left out.

    Soundness: floating point; one motion says nothing of others.
    """
    # what runs is loaded only by those who have no runs yet
    import numpy as np

    from lyapcheck.answers.gate.friction import rest_errors
    from lyapcheck.simulate.closed_loop import simulate
    from lyapcheck.simulate.run import SimulationFailed

    result = []
    for gains in sets:
        try:
            run = simulate(gains, model, task.q_d, task.q0, task.w0, task.T, stop=False)
        except SimulationFailed:
            continue
        limits = np.array([np.nan if most is None else most for most in run.torque_limit])
        share = float(np.nanmax(run.peak_torque / limits)) if not np.all(np.isnan(limits)) else math.nan
        rest = max(math.inf if e is None else math.degrees(e) for e in rest_errors(gains, model))
        final, speed = float(np.max(np.abs(run.indices.final_error))), float(np.max(np.abs(run.w)))
        result.append(Effect(gains.m or 0, run.L2, final, share, speed, rest))
    return tuple(result)


def effect_section(result: Sequence[Effect], target: Sequence[float], time: float) -> Section:
    """Runs to a target, degrees, in a time, s, beside each other, and what they show in one sentence."""
    rows = tuple(
        (
            str(one.m),
            shown(one.L2, ".2f"),
            shown(one.final, ".2f"),
            shown(one.share, ".2f"),
            shown(one.speed, ".2f"),
            "anywhere" if math.isinf(one.rest) else at_most(one.rest, 3) if one.rest > 0 else "—",
        )
        for one in result
    )
    goal = ", ".join(shown(x, "g") for x in target)
    first, last = result[0], result[-1]
    L2, final, speed = (
        f"from {shown(getattr(first, name), '.1f')}{unit} to {shown(getattr(last, name), '.1f')}{unit}"
        for name, unit in (("L2", "°"), ("final", "°"), ("speed", ""))
    )
    says = (
        f"Simulated by (11), without dry friction: in {shown(time, 'g')} s from rest to ({goal})°, from "
        f"m = {first.m} to m = {last.m}: L2 goes {L2}, the error at the end {final}, the top speed {speed} "
        "rad/s. For m ≥ 2 h is flat at the goal."
    )
    blocks: tuple[Block, ...] = (Table(HEADS, rows), Paragraph(says))
    return Section("Simulated: what m does", blocks)


def _six(value: float) -> float | None:
    return float(f"{value:.6g}") if math.isfinite(value) else None
