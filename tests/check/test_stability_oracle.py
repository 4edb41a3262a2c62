"""Every committed theorem of stability against motions of arms that share no code with lyapcheck.

A theorem for all arms and gains is asked on two arms with gains of its kind; one for an arm on that.
"""

import copy
import json
from fractions import Fraction
from functools import cache

import numpy as np
import pytest

from tests.helpers.bounds_oracle import Bound
from tests.helpers.committed import certificates
from tests.helpers.stability_oracle import System, holds
from tests.helpers.state_oracle import Loop, confirmed


def committed():
    """The statements, each once, by file: those of stability, and of all motions (not within a region)."""
    found = {}
    for name, data in certificates({"Stable", "StableArm"}, "proved").items():
        argument = data["statement"]["argument"]
        if argument["cascade"] is None and not argument["local"]:
            found.setdefault(json.dumps(data["statement"]), name)
    return {name: json.loads(statement) for statement, name in found.items()}


STATEMENTS = committed()
OF_ARMS = {name: one for name, one in STATEMENTS.items() if one["kind"] == "StableArm"}
PELICAN = "tests/arena/good/with-premises.lib.P.pelican/0.json"
SECONDS = 30.0
SWING = (0.4, 0.3, 0.5), (1.1, 0.7, 1.6)
"""Of q_d, so that ‖q̇_d‖ stays below 2 rad/s."""


@cache
def arms():
    """The arms of the statements that have one, by number of joints."""
    return {len(one["arm"]["mass"]): one["arm"] for one in OF_ARMS.values()}


def systems(statement):
    """What a statement speaks of, on arms and with gains that meet it; q_d moves where it may."""
    argument = statement["argument"]
    asked = [(statement["arm"], dict(statement["gains"]))] if "arm" in statement else list(drawn(argument))
    for arm, gains in asked:
        swing = [row[: len(arm["mass"])] for row in SWING] if argument["system"]["desired"] else None
        yield System(argument, arm, gains, swing)


def drawn(argument):
    """An arm of each size, with gains that a bench would use."""
    random = np.random.default_rng(11)
    for n, arm in arms().items():
        yield (
            arm,
            {name: [str(int(x)) for x in random.integers(5, 30, n)] for name in argument["system"]["gains"]},
        )


def broken(statement):
    """What is found against a statement."""
    found = set()
    for system in systems(statement):
        found |= {"linearised"} if system.grows() else set()
        found |= {"motion"} if system.stays_away(SECONDS) else set()
    return found


def test_none_is_forgotten():
    assert {one["kind"] for one in STATEMENTS.values()} == {"Stable", "StableArm"}
    assert PELICAN in OF_ARMS
    assert len(arms()) == 2


@pytest.mark.slow
@pytest.mark.parametrize("name", STATEMENTS)
def test_no_motion_breaks_what_is_proved(name):
    assert broken(STATEMENTS[name]) == set()


def without(statement, letter, instead):
    """The same theorem with another term where a letter stands in its torque."""
    false = copy.deepcopy(statement)
    text = json.dumps(false["argument"]["system"]["torque"])
    assert json.dumps(letter) in text
    false["argument"]["system"]["torque"] = json.loads(text.replace(json.dumps(letter), json.dumps(instead)))
    return false


@pytest.mark.slow
def test_motions_break_false_theorems():
    """Rates fed back with the wrong sign, and twice the gravity."""
    pelican = STATEMENTS[PELICAN]
    undamped = without(pelican, ["vec", "w"], ["scale", ["num", "-1"], ["vec", "w"]])
    assert "linearised" in broken(undamped)
    loose, gravity = (
        {**pelican, "gains": [["Kp", ["2", "2"]], ["Kv", ["7", "3"]]]},
        [["vec", "gd"], ["vec", "dg"]],
    )
    falling = without(loose, ["sum", *gravity], ["scale", ["num", "2"], ["sum", *gravity]])
    assert "motion" in broken(falling)


def numbers_of(statement):
    return {name: Fraction(value) for name, value in statement["numbers"]}


@pytest.mark.slow
@pytest.mark.parametrize("name", OF_ARMS)
def test_the_numbers_of_an_arm_meet_its_theorem(name):
    statement = OF_ARMS[name]
    numbers, mass = numbers_of(statement), statement["arm"]["mass"]
    assert all(holds(one, numbers) for one in statement["argument"]["where"])
    bounds = {"mu": ("MassAbove", "low"), "beta": ("MassBelow", "high"), "kc": ("CoriolisBelow", "high")}
    for letter in numbers.keys() & bounds.keys():
        kind, end = bounds[letter]
        bound = Bound({"kind": kind, "mass": mass, "parameters": [], end: str(numbers[letter])})
        place, excess = bound.hunt()
        assert excess < 1e-9 or not bound.confirmed(place)


def decreasing(statement):
    """dV/dt < 0 at every state, for q_d that stands still, as a statement of its own."""
    [h, _] = statement["argument"]["system"]["functions"]
    gains, arm = dict(statement["gains"]), statement["arm"]
    return {
        "kind": "Decreasing", "coupling": [], "parameters": [], "mass": arm["mass"], "family": "hyperbolic",
        "m": h["member"]["value"][1], "kp": gains["Kp"], "kv": gains["Kv"],
        "eps0": str(numbers_of(statement)["eps0"]), "viscous": [[b, b] for b in arm["viscous"]],
    }  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name, one in OF_ARMS.items() if "eps0" in numbers_of(one)])
def test_no_state_refutes_dV_of_an_arm(name):
    statement = decreasing(OF_ARMS[name])
    state, steepness = Loop(statement).hunt(seed=2)
    assert steepness < 1e-9 or not confirmed(statement, state)
    larger = {**statement, "eps0": str(20 * Fraction(statement["eps0"]))}
    assert confirmed(larger, Loop(larger).hunt(seed=2)[0])
