"""Set points: one run a gain set, by the equations or as on the bench."""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np

from lyapcheck.answers.simulate.simulation import (
    Simulation,
    breach_record,
    cell,
    lower,
    plain,
    plains,
    row,
    sized,
    upper,
)
from lyapcheck.certificate import Certificate
from lyapcheck.check.certificate import About
from lyapcheck.check.kinds.decreasing import StateWitness, statement_of
from lyapcheck.check.refusal import Refused
from lyapcheck.check.verify import verify
from lyapcheck.output.digits import NONE
from lyapcheck.output.document import Block, Bullets, Section, Table
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.simulate.indices import SETTLING_BAND
from lyapcheck.simulate.printed import printed_for
from lyapcheck.simulate.run import Run

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots import RobotModel

EXPERIMENT = "experiment"
SETTLED = f"Settled: within {100 * SETTLING_BAND:g} % of the step for good; {NONE} where that is not reached."
TORQUES = f"Estimated: the bound (9) of ‖τ‖ and of each joint; {NONE} where h is unbounded and there is none."
OVERVIEW = ("gains", "L2 [°]", "ε₀", "V(0) [J]", "V", "largest ‖τ‖ [N·m]", "bound (9) [N·m]", "promises")
HEADS = (
    "joint",
    "settling [s]",
    "overshoot [%]",
    "final error [°]",
    "peak torque [N·m]",
    "bound [N·m]",
    "limit [N·m]",
    "inside limit",
)
INSIDE = {True: "yes", False: "NO", None: ""}
PER_JOINT = ("settling", "overshoot", "final_error", "peak_torque", "torque_limit")
PER_RUN = (
    "L2",
    "settling_band",
    "torque_norm",
    "torque_bound",
    "inside_bound",
    "eps0",
    "V_start",
    "V_end",
    "V_decreases",
    "V_rises_at",
    "accuracy",
    "energy_balance",
)


class SetPointRuns(Simulation[Run]):
    """Runs from a start to a set point, with their indices beside what theory promises."""

    promised = "V falls, ‖τ‖ stays within the bound (9), every motor within its limit"

    def about(self) -> str:
        """Whether it is the experiment."""
        kinds = {one.kind for one in self.results}
        return ", as on the bench" if kinds == {EXPERIMENT} else ""

    def watches(self, name: str) -> bool:
        """Only runs by the equations are held against theory."""
        return any(one.name == name and one.kind != EXPERIMENT for one in self.results)

    def legend(self) -> Sequence[str]:
        """Settling, and the bound of the torque."""
        return SETTLED, TORQUES

    def overview(self) -> Table:
        """L2, V and ‖τ‖ of each run."""
        rows = []
        for one in self.results:
            seen = one.promises
            fall = "never rose" if seen.V_rises_at is None else f"ROSE at {cell(seen.V_rises_at, '.4g')} s"
            norms = upper(seen.torque_norm), upper(seen.torque_bound)
            mark = self.mark(one.name) or NONE
            rows.append(
                (one.name, cell(one.L2, ".4f"), lower(one.eps0), cell(one.V[0], ".5g"), fall, *norms, mark)
            )
        return Table(OVERVIEW, tuple(rows), align="lrrrlrrl")

    def section(self, one: Run) -> Section:
        """A row a joint, and how far the run can be trusted."""
        blocks: tuple[Block, ...] = (Table(HEADS, tuple(_rows(one)), align="lrrrrrrl"), Bullets(_facts(one)))
        return Section(f"{self.mark(one.name)} {_headline(one)}".strip(), blocks)

    def plain_data(self, one: Run) -> dict[str, Any]:
        """Names and units as in `Run`, angles in degrees."""
        result, seen = one.indices, one.promises
        return {
            "name": one.name,
            "m": one.m,
            "robot": one.robot,
            "kind": one.kind,
            "complete": one.complete,
            "time": one.task.T,
            "reached": plain(one.t[-1]),
            "start": plains(np.degrees(one.task.q0)),
            "target": plains(np.degrees(one.task.q_d)),
            "joints": list(one.joints),
            "L2": plain(result.L2),
            "settling_band": SETTLING_BAND,
            "settling": plains(result.settling),
            "overshoot": plains(result.overshoot),
            "final_error": plains(result.final_error),
            "peak_torque": plains(result.peak_torque),
            "torque_limit": list(one.torque_limit),
            "inside_limits": list(seen.inside_limits),
            "joint_bounds": None if seen.joint_bounds is None else plains(seen.joint_bounds),
            "torque_norm": plain(seen.torque_norm),
            "torque_bound": plain(seen.torque_bound),
            "inside_bound": seen.inside_bound,
            "eps0": one.eps0,
            "V_start": plain(one.V[0]),
            "V_end": plain(one.V[-1]),
            "V_decreases": seen.V_decreases,
            "V_rises_at": seen.V_rises_at,
            "accuracy": plain(one.accuracy),
            "energy_balance": plain(one.energy_balance),
            "breach": None if one.breach is None else one.breach.data,
            "printed": _paper(one),
        }

    def rows_of(self, one: Run) -> list[dict[str, Any]]:
        """A row a run and joint; names and units as in `data`."""
        data = self.plain_data(one)
        head = {key: data[key] for key in ("name", "m", "robot", "kind", "complete", "time", "reached")}
        tail = {key: data[key] for key in PER_RUN}
        paper = data["printed"] or {}
        return [
            {
                **head,
                "joint": joint,
                "start": data["start"][i],
                "target": data["target"][i],
                **{key: data[key][i] for key in PER_JOINT},
                "inside_limit": data["inside_limits"][i],
                "joint_bound": None if data["joint_bounds"] is None else data["joint_bounds"][i],
                **tail,
                "printed_L2": paper.get("L2"),
                "printed_settling": paper["settling"][i] if paper.get("settling") else None,
                "printed_final_error": paper["final_error"][i] if paper else None,
                "breach": breach_record(one.breach),
            }
            for i, joint in enumerate(one.joints)
        ]


def _headline(one: Run) -> str:
    member = "" if one.m is None else f" (m = {one.m})"
    start, goal = (row(math.degrees(x) for x in ends) for ends in (one.task.q0, one.task.q_d))
    cut = "" if one.complete else f", CUT SHORT at {cell(one.t[-1], '.4g')} s"
    return f"{one.name}{member}: {start}° to {goal}° in {one.task.T:g} s{cut}"


def _facts(one: Run) -> tuple[str, ...]:
    rates = f"initial rates {row(math.degrees(x) for x in one.task.w0)} °/s" if any(one.task.w0) else ""
    beyond = "‖τ‖ went BEYOND the bound (9)" if one.promises.inside_bound is False else ""
    return tuple(filter(None, (rates, beyond, _checks(one), _beside(one))))


def _checks(one: Run) -> str:
    if math.isnan(one.accuracy):
        return "accuracy unknown: the run was cut short"
    balance = "" if math.isnan(one.energy_balance) else f"; energy balance {sized(one.energy_balance)}"
    return f"accuracy {sized(one.accuracy)} (rad, rad/s) by a second, tighter run{balance}"


def _beside(one: Run) -> str:
    """What the paper measured on its bench, where it ran the same."""
    paper = printed_for(one)
    if paper is None or not one.complete:
        return ""
    error = ", ".join(f"{x:g}" for x in paper.final_error)
    when = "below 1.4" if paper.settling is None else ", ".join(f"{x:g}" for x in paper.settling)
    settled = f"settling {when} s (band not printed)"
    return f"the paper measured L2 {paper.L2:.4f}°, {settled}, final error {error}°"


def _rows(one: Run) -> list[tuple[str, ...]]:
    result, bounds = one.indices, one.promises.joint_bounds
    return [
        (
            joint,
            cell(result.settling[i], "z.3f"),
            cell(result.overshoot[i], "z.2f"),
            cell(result.final_error[i], "z.4f"),
            cell(result.peak_torque[i], "z.2f"),
            upper(None if bounds is None else bounds[i]),
            lower(one.torque_limit[i]),
            INSIDE[one.promises.inside_limits[i]],
        )
        for i, joint in enumerate(one.joints)
    ]


def _paper(one: Run) -> dict[str, Any] | None:
    paper = printed_for(one)
    if paper is None:
        return None
    settling = None if paper.settling is None else list(paper.settling)
    return {"L2": paper.L2, "settling": settling, "final_error": list(paper.final_error)}


def breach_certificate(run: Run, gains: GainSet, model: RobotModel) -> Certificate | None:
    """That dV/dt < 0 fails for the run's ε₀, at the state where the run was seen to break it.

    Args:
        run: by the equations, to a set point.
        gains: of the run.
        model: the arm, at whose nominal numbers it ran.

    Returns:
        ``None`` where the run broke nothing, or a promise that is no statement: limits of torque.

    Soundness: the checker accepted it; that a motion comes to the state is simulated, and not said.
    """
    controlled = ControlledArm(gains, model)
    breach, eps0 = run.breach, Fraction(run.eps0)
    if breach is None or not breach.confirmed or eps0 <= 0 or not controlled.family.bounded:
        return None
    statement = statement_of(controlled.loop(eps0))
    q, e, w = (tuple(map(Fraction, row)) for row in (breach.at.q, breach.at.e, breach.at.w))
    against = StateWitness(controlled.arm.viscous, (), q, e, w)
    try:
        accepted = verify(statement, against)
    except Refused:
        return None
    says = f"not dV/dt < 0 at every state: {gains.name} on {model.name}, at a state of a run"
    about = About(f"{gains.name}.breach", says, gains.m, controlled.n, "simulate")
    return Certificate(about, statement, accepted.verdict, accepted.grade, against)
