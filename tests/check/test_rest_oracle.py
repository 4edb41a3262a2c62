"""Every committed statement of where an arm comes to rest, against motions that stick and slip."""

from fractions import Fraction

import numpy as np
import pytest

from tests.helpers.committed import certificates
from tests.helpers.rest_oracle import Sticking, farthest, holds_beyond

KINDS = "Resting", "ComesToRest"


def committed(verdict):
    return {name: data["statement"] for name, data in certificates(KINDS, verdict).items()}


PROVED, REFUTED = committed("proved"), committed("refuted")
RUNS, SECONDS = 4, 40.0
TWO_JOINTS = {
    "kind": "ComesToRest", "family": "tanh", "m": None, "kp": ["20", "8"], "kv": ["1", "1"],
    "dry": ["6", "2"], "errors": ["1/3", "1/3"], "parameters": [], "viscous": [["1", "1"], ["1/2", "1/2"]],
    "mass": [
        [[[[0, 0, 0, 0], "2"], [[0, 0, 0, 1], "1"]], [[[0, 0, 0, 0], "1/2"], [[0, 0, 0, 1], "1/2"]]],
        [[[[0, 0, 0, 0], "1/2"], [[0, 0, 0, 1], "1/2"]], [[[0, 0, 0, 0], "1/2"]]],
    ],
}  # fmt: skip
"""artanh(6/20) and artanh(2/8) are 0.310 and 0.255: this is true."""


def ends_of_motions(statement):
    """Where some motions with all of the dry friction, or a share of it, come to rest; none goes on."""
    random = np.random.default_rng(9)
    n = len(statement["kp"])
    dry = np.array([float(Fraction(x)) for x in statement["dry"]])
    for run in range(RUNS):
        arm = [
            np.array([float(Fraction(pair[int(random.integers(2))])) for pair in statement[name]])
            for name in ("viscous", "parameters")
        ]
        moving = Sticking(statement, *arm, dry * (1.0 if run % 2 else random.uniform(0.3, 1, n)))
        start = np.concatenate(
            [random.uniform(-3, 3, n), random.uniform(-2, 2, n), random.uniform(-3, 3, n) * (run > 1)]
        )
        e, w, still = moving.ends(start, SECONDS)
        assert np.abs(w).max() < 1e-2
        yield e, still


def broken(statement):
    """What is found against a statement, confirmed at 60 digits."""
    kind = statement["kind"]
    found = {"state"} if any(holds_beyond(statement, kind, e) for e in farthest(statement, kind)) else set()
    if kind == "ComesToRest":
        ends = ends_of_motions(statement)
        found |= {"motion"} if any(still and holds_beyond(statement, kind, e) for e, still in ends) else set()
    return found


def test_none_is_forgotten():
    for statements in (PROVED, REFUTED):
        assert {one["kind"] for one in statements.values()} == set(KINDS)


@pytest.mark.slow
@pytest.mark.parametrize("name", PROVED)
def test_nothing_breaks_what_is_proved(name):
    assert broken(PROVED[name]) == set()


@pytest.mark.slow
@pytest.mark.parametrize("name", REFUTED)
def test_the_hunter_refutes_what_is_refuted(name):
    assert "state" in broken(REFUTED[name])


@pytest.mark.slow
def test_motions_break_what_is_a_little_stronger():
    assert broken(TWO_JOINTS) == set()
    assert "motion" in broken({**TWO_JOINTS, "errors": ["1/10", "1/10"]})
    assert "state" in broken({**TWO_JOINTS, "errors": ["3/10", "1/3"]})
