"""The long computations of a report, as functions of names and paths: each can run in its own process."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots import RobotModel
    from lyapcheck.simulate.run import Run

REST = 0.7853981633974483
"""45° in rad: the step of every joint of an arm that the paper's experiment does not fit."""


BOXES = 100_000
"""Budget of branch and bound for one gain set: a report takes half a minute, ``epsilon`` goes further."""


"""The study of the experiment where nothing can be compiled: a bench run then takes 50 times longer."""


@dataclass(frozen=True)
class RunData:
    """One simulated run: its facts as plain data, its signals as arrays for the figures."""

    facts: dict[str, Any]
    t: Any
    e: Any
    tau: Any
    V: Any
    dV: Any


@dataclass(frozen=True)
class GainData:
    """What was computed for one gain set."""

    epsilon: dict[str, Any]
    run: RunData


def claims_job(proof: str, m: int, robot: str, gains: str) -> list[dict[str, Any]]:
    """Every claim of a proof for one m, as rows with their details in words."""
    from lyapcheck.claims import run_proof

    result = run_proof(proof, (m,), robot, None, gains)
    about = {"proof": result.name, "title": result.title}
    return [{**row.data(), **about, "details": [row.words, *row.support]} for row in result.claims]


def gains_job(gains: str, name: str, robot: str, seed: int) -> GainData:
    """The four ε₀ of one gain set, its worst states, and the reference simulation."""
    from lyapcheck.control.gains import read_gain_file
    from lyapcheck.robots import load

    gain_set = next(item for item in read_gain_file(gains).gains if item.name == name)
    model = load(robot)
    row = _epsilon(gain_set, model, seed)
    eps0 = float(row["certified"] or row["scalar"] or 0.0)
    return GainData(row, _run_data(_simulated(gain_set, model, eps0)))


def _epsilon(gain_set: GainSet, model: RobotModel, seed: int) -> dict[str, Any]:
    """The four ε₀, and the states of largest dV/dt at the certified one."""
    from lyapcheck.answers.epsilon import epsilon
    from lyapcheck.answers.epsilon.data import result_data
    from lyapcheck.answers.epsilon.words import reasons
    from lyapcheck.search.falsify import worst_states
    from lyapcheck.search.setting import Setting

    result = epsilon(gain_set, model, max_boxes=BOXES, seed=seed)
    at = result.certified or result.scalar or result.falsified
    setting = Setting(gain_set, model)
    states = [asdict(state) for state in (worst_states(setting, float(at), seed=seed) if at else ())]
    return {**result_data(result), "remarks": reasons(result), "worst_states": states}


def _simulated(gain_set: GainSet, model: RobotModel, eps0: float) -> Run:
    """The paper's experiment where the arm has its three joints, else a step of 45° in every joint."""
    from lyapcheck.simulate.closed_loop import simulate
    from lyapcheck.simulate.task import PAPER_TASK

    if model.n == len(PAPER_TASK.q_d):
        task = PAPER_TASK
        return simulate(gain_set, model, task.q_d, task.q0, task.w0, task.T, eps0=eps0, stop=False)
    return simulate(gain_set, model, [REST] * model.n, eps0=eps0, stop=False)


def _run_data(run: Run) -> RunData:
    from lyapcheck.answers.simulate.runs import SetPointRuns

    (facts,) = SetPointRuns((run,)).data()["results"]
    return RunData(facts, run.t, run.e, run.tau, run.V, run.dV)
