"""Committed statements about motions, and about states within limits, against dynamics that share no code.

The motions are those of `tests.helpers.state_oracle` from random starts. Statements with dry friction or
other torques are not asked here.
"""

import json
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests.helpers.state_oracle import Loop, confirmed

GOOD = Path(__file__).parents[1] / "arena" / "good"
MOTIONS = "Settling", "StaysWithin"
RUNS = 12
LONG = 60.0
"""Seconds after the last time of a statement."""


def committed(kinds, verdict="proved"):
    """The statements of some kinds, by file."""
    found = {path.name: json.loads(path.read_text(encoding="utf-8")) for path in sorted(GOOD.glob("*.json"))}
    return {
        name: data["statement"]
        for name, data in found.items()
        if data.get("statement", {}).get("kind") in kinds and data["verdict"] == verdict
    }


STATEMENTS = {
    name: statement
    for name, statement in committed(MOTIONS).items()
    if not any(Fraction(x) for key in ("torque", "dry") for x in statement.get(key, []))
}


def test_none_is_forgotten():
    assert {statement["kind"] for statement in STATEMENTS.values()} == set(MOTIONS)
    assert committed(["DecreasingNearby"])
    assert committed(["DecreasingNearby"], "refuted")


def numbers(statement, name):
    return np.array([float(Fraction(x)) for x in statement[name]])


def one_within(ranges, random):
    """A number of each range, mostly an end of it."""
    shares = random.choice([0.0, 1.0, 0.0, 1.0, 0.5], len(ranges))
    ends = np.array([[float(Fraction(x)) for x in pair] for pair in ranges]).reshape(-1, 2)
    return ends[:, 0] + (ends[:, 1] - ends[:, 0]) * shares


def motions(statement):
    """Times, errors and levels of V of some motions that the statement speaks of."""
    as_rate = {"kind": "Decreasing", "coupling": [], "parameters": [], "viscous": []}
    loop, random = Loop({"eps0": "0", **statement, **as_rate}), np.random.default_rng(7)
    n = loop.n
    starts = [numbers(statement, f"{name}_at_start") for name in ("errors", "rates")]
    times = [float(Fraction(t)) for t, _ in statement.get("envelope", statement.get("within"))]
    grid = np.unique(np.concatenate([times, np.linspace(0, times[-1] + LONG, 400)]))

    def slope(t, y, viscous, parameters):
        q, e, w = np.split(y, 3)
        return np.concatenate([w, -w, loop.acceleration(q, e, w, viscous, np.zeros(n), parameters)])

    for run in range(RUNS):
        shares = [random.choice([-1.0, 1.0], n) if run % 2 else random.uniform(-1, 1, n) for _ in range(2)]
        e, w = (size * share for size, share in zip(starts, shares, strict=True))
        arm = [one_within(statement[name], random) for name in ("viscous", "parameters")]
        begin = np.concatenate([random.uniform(-np.pi, np.pi, n), e, w])
        path = solve_ivp(slope, (0, grid[-1]), begin, "LSODA", grid, args=arm, rtol=1e-9, atol=1e-12).y
        q, e, w = path[:n].T, path[n : 2 * n].T, path[2 * n :].T
        yield grid, e, loop.level(q, e, w, arm[1])


def broken(statement):
    """What the motions do that the statement says they do not."""
    found = set()
    for t, e, V in motions(statement):
        for time, level in statement.get("envelope", []):
            late = t >= float(Fraction(time))
            found |= {"envelope"} if V[late].max() > float(Fraction(level)) + 1e-9 else set()
        within = statement.get("within") or [
            (statement["envelope"][0][0], statement["largest_errors"]),
            (statement["envelope"][-1][0], statement["errors"]),
        ]
        for time, errors in within:
            bound = np.array([float(Fraction(x)) for x in errors])
            late = t >= float(Fraction(time))
            found |= {"errors"} if (np.abs(e[late]) > bound + 1e-9).any() else set()
    return found


@pytest.mark.slow
@pytest.mark.parametrize("name", STATEMENTS)
def test_no_motion_breaks_what_is_proved(name):
    assert broken(STATEMENTS[name]) == set()


@pytest.mark.slow
def test_motions_break_what_is_a_little_stronger():
    """Errors below those at the start, and levels below that of the start."""
    settling, phases = STATEMENTS["ext.settling.json"], STATEMENTS["ext.phases.json"]
    assert "errors" in broken({**settling, "largest_errors": ["1/4"]})
    assert "envelope" in broken({**settling, "envelope": [["0", "1/40"], ["1", "1/80"]]})
    assert "errors" in broken({**phases, "within": [["0", ["1"]], ["1", ["1/10"]]]})


@pytest.mark.slow
@pytest.mark.parametrize("name", committed(["DecreasingNearby"]))
def test_no_state_within_the_limits_refutes_what_is_proved(name):
    statement = committed(["DecreasingNearby"])[name]
    state, steepness = limited(statement).hunt(seed=1)
    assert steepness < 1e-9 or not confirmed(statement["everywhere"], state)


@pytest.mark.slow
@pytest.mark.parametrize(
    "name", [name for name in committed(["DecreasingNearby"], "refuted") if "no-arm" not in name]
)
def test_a_state_within_the_limits_refutes_what_is_refuted(name):
    statement = committed(["DecreasingNearby"], "refuted")[name]
    state, steepness = limited(statement).hunt(seed=1)
    assert steepness > 0
    assert confirmed(statement["everywhere"], state)


def limited(statement):
    """A hunter that keeps to the limits."""
    limits = [numbers(statement, name) if statement[name] else np.inf for name in ("errors", "speeds")]
    return Loop(statement["everywhere"], *limits)
