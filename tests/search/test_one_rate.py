"""Before the search for failing states goes on, two ways to dV/dt are held against each other."""

from dataclasses import replace

import pytest

from lyapcheck.control.gains import paper_gain_file, read_gain_file
from lyapcheck.robots import load
from lyapcheck.search import worst_states
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.search.falsify import falsify
from lyapcheck.search.worst_states import Disagreement


def test_a_wrong_term_stops_the_search(monkeypatch):
    gains = read_gain_file(paper_gain_file("table2_shoulder_elbow")).gains[0]
    controlled, right = ControlledArm(gains, load("reyes-kelly2")), worst_states.quadratic

    def wrong(*asked):
        known = right(*asked)  # type: ignore[arg-type]
        return replace(known, a1=known.a1 * 1.01)

    monkeypatch.setattr(worst_states, "quadratic", wrong)
    with pytest.raises(Disagreement):
        falsify(controlled, starts=2, samples=100)
