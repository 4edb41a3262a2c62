"""Every committed certificate of ε₀ against an optimiser and dynamics that share no code with lyapcheck."""

from fractions import Fraction

import pytest

from tests.helpers.committed import certificates
from tests.helpers.state_oracle import Loop, confirmed


def committed(verdict):
    """The certificates that dV/dt < 0 everywhere, or that a state refutes it, by file."""
    found = certificates(["Decreasing"], verdict).items()
    return {name: data for name, data in found if data["proof"]["rule"] != "posture"}


PROVED, REFUTED = committed("proved"), committed("refuted")
QUICK = {
    "tests/arena/good/ext.boxes.json",
    "tests/kernel/certificates/reyes-kelly2.m1.certified.json",
    "tests/kernel/certificates/reyes-kelly2.m1.falsified.json",
}


def test_none_is_forgotten():
    assert set(PROVED) | set(REFUTED) > QUICK
    assert len(PROVED) >= 13
    assert len(REFUTED) >= 6


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=() if name in QUICK else pytest.mark.slow) for name in PROVED]
)
def test_nothing_refutes_what_is_proved(name):
    statement = PROVED[name]["statement"]
    state, steepness = Loop(statement).hunt(seed=1)
    assert steepness < 1e-9 or not confirmed(statement, state)


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=() if name in QUICK else pytest.mark.slow) for name in REFUTED]
)
def test_the_hunter_refutes_what_is_a_little_larger(name):
    """The same hunter and the same judge find the faults that there are, 2 % above the falsified ε₀."""
    statement = REFUTED[name]["statement"]
    larger = {**statement, "eps0": str(Fraction(statement["eps0"]) * Fraction(102, 100))}
    state, steepness = Loop(larger).hunt(seed=1)
    assert steepness > 0
    assert confirmed(larger, state)


def test_the_judge_refutes_at_the_states_of_certificates():
    """Both dynamics agree at every committed witness, and at none with a hundredth of its ε₀."""
    for data in REFUTED.values():
        statement, proof = data["statement"], data["proof"]
        state = [[float(Fraction(x)) for x in proof[name]] for name in "qew"]
        state.append([float(Fraction(low)) for low, _ in statement["viscous"]])
        assert confirmed(statement, state)
        assert not confirmed({**statement, "eps0": str(Fraction(statement["eps0"]) / 100)}, state)
