"""Set points: one run a gain set, by the equations or as on the bench."""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from functools import partial
from typing import TYPE_CHECKING, Any

from lyapcheck.answers.running import running_sentences
from lyapcheck.answers.simulate import (
    BREACH,
    Simulation,
    accuracy,
    degrees,
    headline,
    lower,
    motion,
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
from lyapcheck.control.sampling import time_text
from lyapcheck.output.answer import Level
from lyapcheck.output.digits import NONE, shown
from lyapcheck.output.document import Block, Bullets, Section
from lyapcheck.output.fields import Field
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.simulate.results import BAND, SETTLING_BAND, printed_for
from lyapcheck.simulate.run import Run

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet
    from lyapcheck.control.sampling import LoopRecord
    from lyapcheck.robots import RobotModel

EXPERIMENT = "experiment"
SETTLED = f"Settled: within {100 * SETTLING_BAND:g} % of the step for good; {NONE} where that is not reached."
TORQUES = f"Estimated: the bound (9) of ‖τ‖ and of each joint; {NONE} where h is unbounded and there is none."
INSIDE = {True: "yes", False: "NO", None: ""}


def _falls(rises_at: float | None) -> str:
    return "never rose" if rises_at is None else f"ROSE at {shown(rises_at, '.4g')} s"


def _printed(key: str, one: Run) -> Any:
    return (_paper(one) or {}).get(key)


def _paper(one: Run) -> dict[str, Any] | None:
    paper = printed_for(one)
    if paper is None:
        return None
    settling = None if paper.settling is None else list(paper.settling)
    return {"L2": paper.L2, "settling": settling, "final_error": list(paper.final_error)}


def _loop_text(loop: LoopRecord) -> str:
    unknown = "" if loop.knows_gravity else f", {loop.unknown_text} unknown"
    return loop.text + unknown


FIELDS = (
    Field("name", "name", "gains", align="l"),
    *(Field(key, key) for key in ("m", "robot", "kind", "complete")),
    Field("time", "task.T"),
    Field("reached", lambda one: plain(one.t[-1])),
    Field("joints", "joints", "joint", to=list, align="l", each=True, csv="joint"),
    Field("start", "task.q0", to=degrees, each=True),
    Field("target", "task.q_d", to=degrees, each=True),
    Field("settling", "indices.settling", "settling [s]", "z.3f", plains, each=True),
    Field("overshoot", "indices.overshoot", "overshoot [%]", "z.2f", plains, each=True),
    Field("final_error", "indices.final_error", "final error [°]", "z.4f", plains, each=True),
    Field("peak_torque", "indices.peak_torque", "peak torque [N·m]", "z.2f", plains, each=True),
    Field(
        "joint_bounds", "promises.joint_bounds", "bound [N·m]", upper, plains, each=True, csv="joint_bound"
    ),
    Field("torque_limit", "torque_limit", "limit [N·m]", lower, list, each=True),
    Field(
        "inside_limits",
        "promises.inside_limits",
        "inside limit",
        INSIDE.__getitem__,
        list,
        "l",
        True,
        "inside_limit",
    ),
    Field("L2", "indices.L2", "L2 [°]", ".4f", plain),
    Field("settling_band", lambda one: SETTLING_BAND),
    Field("eps0", "eps0", "ε₀", lower),
    Field("V_start", lambda one: one.V[0], "V(0) [J]", ".5g", plain),
    Field("V_end", lambda one: plain(one.V[-1])),
    Field("V_decreases", "promises.V_decreases"),
    Field("V_rises_at", "promises.V_rises_at", "V", _falls, align="l"),
    Field("torque_norm", "promises.torque_norm", "largest ‖τ‖ [N·m]", upper, plain),
    Field("torque_bound", "promises.torque_bound", "bound (9) [N·m]", upper, plain),
    Field("inside_bound", "promises.inside_bound"),
    Field("accuracy", "accuracy", to=plain),
    Field("energy_balance", "energy_balance", to=plain),
    Field("printed", _paper, csv=None),
    *(
        Field("", partial(_printed, key), each=key != "L2", csv=f"printed_{key}")
        for key in ("L2", "settling", "final_error")
    ),
    Field("loop", "loop", to=_loop_text),
    Field("unrest", "unrest", to=vars, csv=None),
    Field("", "unrest.sentence", csv="unrest"),
    *BREACH,
)
"""Angles in degrees; names and units as in `Run`."""


class SetPointRuns(Simulation[Run]):
    """Runs from a start to a set point, with their indices beside what theory promises."""

    fields = FIELDS
    legend = (SETTLED, TORQUES)
    promised = "V falls, ‖τ‖ stays within the bound (9), every motor within its limit"

    @property
    def against(self) -> str:  # type: ignore[override]
        """Which kinds of unrest were seen."""
        kinds = dict.fromkeys(one.unrest.kind for one in self.results if one.unrest is not None)
        return f"{' or '.join(kinds)} seen in" if kinds else super().against

    def about(self) -> str:
        """How the loop was sampled."""
        return "; ".join(f"as run: {_loop_text(loop)}" for loop in self._loops)

    @property
    def _loops(self) -> list[LoopRecord]:
        return [loop for loop in dict.fromkeys(one.loop for one in self.results) if loop]

    @property
    def unknown(self) -> str:
        """As every sampled run has it."""
        said = dict.fromkeys(loop.unknown_text for loop in self._loops if not loop.knows_gravity)
        return "".join(f", {text} unknown" for text in said)

    @property
    def far_off(self) -> str:
        """Also the joint."""
        sampled = [one for one in self.results if one.loop is not None and one.complete]
        ends = [(float(abs(x)), i) for one in sampled for i, x in enumerate(one.indices.final_error)]
        angle, i = max(ends, default=(0.0, 0))
        if angle <= math.degrees(BAND):
            return ""
        return f"ends up to {shown(angle, '.3g')}° from the goal ({self.results[0].joints[i]})"

    def level(self, name: str) -> Level:
        """Also failed where a sampled run shows unrest."""
        return Level.FAILED if self._seen(name) else super().level(name)

    def complaints(self) -> list[str]:
        """Unrest goes first."""
        return [
            *(f"{one.name}: {text}" for one in self.results for text in self._seen(one.name)),
            *super().complaints(),
        ]

    def missing(self, name: str) -> list[str]:
        """Also what was seen against a gain set."""
        return [*self._seen(name), *super().missing(name)]

    def _seen(self, name: str) -> list[str]:
        return [one.unrest.sentence for one in self.results if one.name == name and one.unrest is not None]

    def watches(self, name: str) -> bool:
        """Only runs by the equations are held against theory."""
        return any(one.name == name and one.kind != EXPERIMENT for one in self.results)

    def motions(self) -> Sequence[str]:
        """From where to where and at which period, first of runs that were cut short."""
        runs = sorted(self.results, key=lambda one: one.complete)
        said = dict.fromkeys(f"simulated{_rate(one.loop)}: {motion(one, _way(one))}" for one in runs)
        return tuple(said)[: 1 if self.far_off else 2]

    def section(self, one: Run) -> Section:
        """A row a joint, and how far the run can be trusted."""
        blocks: tuple[Block, ...] = (self.by_joint(one), Bullets((*_facts(one), *self._as_run(one))))
        return Section(f"{self.mark(one.name)} {headline(one, _way(one))}".strip(), blocks)

    def plain_data(self, one: Run) -> dict[str, Any]:
        """Also what the checker says of the loop."""
        return {**super().plain_data(one), "as_run": self._as_run(one)}

    def _as_run(self, one: Run) -> list[str]:
        return running_sentences(self.judged.get(one.name, ()), one.joints)


def _rate(loop: LoopRecord | None) -> str:
    return "" if loop is None or loop.period is None else f" at {time_text(loop.period)}, {loop.late}"


def _way(one: Run) -> str:
    return " to ".join(_angles(ends) for ends in (one.task.q0, one.task.q_d))


def _angles(angles: Sequence[float]) -> str:
    """One angle where all joints have the same."""
    same = len(angles) > 1 and len(set(angles)) == 1
    return f"{shown(math.degrees(angles[0]), 'g')}° each" if same else f"{row(map(math.degrees, angles))}°"


def _facts(one: Run) -> tuple[str, ...]:
    rates = f"initial rates {row(math.degrees(x) for x in one.task.w0)} °/s" if any(one.task.w0) else ""
    beyond = "‖τ‖ went BEYOND the bound (9)" if one.promises.inside_bound is False else ""
    balance = "" if math.isnan(one.energy_balance) else f"; energy balance {sized(one.energy_balance)}"
    checks = accuracy(one) + ("" if math.isnan(one.accuracy) else balance)
    return tuple(filter(None, (rates, beyond, checks, _beside(one))))


def _beside(one: Run) -> str:
    """What the paper measured on its bench, where it ran the same."""
    paper = printed_for(one)
    if paper is None or not one.complete:
        return ""
    error = ", ".join(f"{x:g}" for x in paper.final_error)
    when = "below 1.4" if paper.settling is None else ", ".join(f"{x:g}" for x in paper.settling)
    settled = f"settling {when} s (band not printed)"
    return f"the paper measured L2 {paper.L2:.4f}°, {settled}, final error {error}°"


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
