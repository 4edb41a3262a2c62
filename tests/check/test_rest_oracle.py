"""Every committed statement of where an arm comes to rest, against an own search for torques that hold it."""

import pytest

from tests.helpers.committed import certificates
from tests.helpers.rest_oracle import farthest, holds_beyond


def committed(verdict):
    return {name: data["statement"] for name, data in certificates(["Resting"], verdict).items()}


PROVED, REFUTED = committed("proved"), committed("refuted")


def broken(statement):
    """Whether a state of rest beyond a bound is found and confirmed at 60 digits."""
    return any(holds_beyond(statement, e) for e in farthest(statement))


def test_none_is_forgotten():
    assert PROVED
    assert REFUTED


@pytest.mark.slow
@pytest.mark.parametrize("name", PROVED)
def test_nothing_breaks_what_is_proved(name):
    assert not broken(PROVED[name])


@pytest.mark.slow
@pytest.mark.parametrize("name", REFUTED)
def test_the_hunter_refutes_what_is_refuted(name):
    assert broken(REFUTED[name])


@pytest.mark.slow
def test_what_is_a_little_stronger_is_broken():
    """artanh(6/20) and artanh(2/8) are 0.310 and 0.255."""
    held = {"family": "tanh", "m": None, "kp": ["20", "8"], "torque": ["6", "2"]}
    assert not broken({**held, "errors": ["1/3", "1/3"]})
    assert broken({**held, "errors": ["3/10", "1/3"]})
