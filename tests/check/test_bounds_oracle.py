"""Every committed bound of M, C or g against an optimiser and bodies that share no code with lyapcheck."""

import json

import pytest

from tests.helpers.bounds_oracle import KINDS, Bound
from tests.helpers.committed import certificates


def committed(verdict):
    """The statements about the constants of an arm, each once, by file."""
    found = {}
    for name, data in certificates(KINDS, verdict).items():
        found.setdefault(json.dumps(data["statement"]), name)
    return {name: json.loads(statement) for statement, name in found.items()}


PROVED, REFUTED = committed("proved"), committed("refuted")
QUICK = {
    "tests/arena/good/ext.chain-lambda_min.json",
    "tests/arena/good/ext.mass-range.json",
    "tests/arena/good/ext.chain-large.json",
}


def cases(statements):
    return [pytest.param(name, marks=() if name in QUICK else pytest.mark.slow) for name in statements]


def test_none_is_forgotten():
    assert set(PROVED) | set(REFUTED) > QUICK
    kinds = {statement["kind"] for statement in (*PROVED.values(), *REFUTED.values())}
    assert kinds == KINDS


@pytest.mark.parametrize("name", cases(PROVED))
def test_nothing_refutes_what_is_proved(name):
    bound = Bound(PROVED[name])
    place, excess = bound.hunt()
    assert excess < 1e-9 or not bound.confirmed(place)


@pytest.mark.parametrize("name", cases(REFUTED))
def test_the_hunter_refutes_what_is_refuted(name):
    bound = Bound(REFUTED[name])
    place, _ = bound.hunt()
    assert bound.confirmed(place)
