"""The long computations of a report, each a function of names and paths so that it can run in its own process."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class RunData:
    """One simulated run: its facts as plain data, its signals as arrays for the figures."""

    facts: dict[str, Any]
    t: Any
    e: Any
    tau: Any
    V: Any
    dV: Any


def claims_job(proof: str, m: int, robot: str, gains: str) -> list[dict[str, Any]]:
    """Every claim of a proof for one m, as rows with their details in words."""
    from lyapcheck.claims import run_proof
    from lyapcheck.claims.render import details

    result = run_proof(proof, (m,), robot, None, gains)
    return [{**row.to_json(), "details": details(row)} for row in result.claims]


def epsilon_job(gains: str, name: str, robot: str, seed: int) -> dict[str, Any]:
    """The four ε₀ of one gain set."""
    from lyapcheck.control import read_gain_file
    from lyapcheck.robots import load
    from lyapcheck.search.epsilon import epsilon

    gain_set = next(item for item in read_gain_file(gains).gains if item.name == name)
    return epsilon(gain_set, load(robot), seed=seed).to_json()


def run_job(gains: str, name: str, robot: str, eps0: float) -> RunData:
    """The reference simulation of one gain set."""
    from lyapcheck.control import read_gain_file
    from lyapcheck.robots import load
    from lyapcheck.simulate import PAPER_TASK, simulate
    from lyapcheck.simulate.render import result_json

    gain_set = next(item for item in read_gain_file(gains).gains if item.name == name)
    model = load(robot)
    if model.n == len(PAPER_TASK.q_d):
        task = PAPER_TASK
        run = simulate(gain_set, model, task.q_d, task.q0, task.w0, task.T, eps0=eps0)
    else:
        run = simulate(gain_set, model, [0.7853981633974483] * model.n, eps0=eps0)
    return RunData(result_json(run), run.t, run.e, run.tau, run.V, run.dV)
