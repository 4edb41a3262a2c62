"""The benchmarks compare like with like, and say what they measured."""

import json
import re

import numpy as np
import pytest

from lyapcheck import load_robot
from lyapcheck.robots.numeric import NumericModel

from . import batches, commands, throughput
from .__main__ import HEAD, description, markdown
from .by_hand import arms
from .measure import Disagreement, Timing, states_per_second


def test_a_row_has_the_times_and_their_ratio():
    alone = commands.row("explain", Timing(0.2, 0.18, 3, ""))
    beside = commands.row("gate", Timing(0.25, 0.2, 5, ""), Timing(0.5, 0.4, 5, ""), "NumPy")
    text = markdown([("## Commands\n", commands.HEAD, [beside, alone])])
    assert "| gate | 0.25 s | 0.20 s | 5 | 0.50 s | 2.00 | NumPy |" in text
    assert "| explain | 0.20 s | 0.18 s | 3 | — | — | nothing compares |" in text
    for block in re.findall(r"(?:^\|.*\n)+", text, re.MULTILINE):
        assert len({line.count("|") for line in block.splitlines()}) == 1


def test_the_machine_is_described_without_naming_it():
    text = "\n".join(description())
    assert "processors" in text
    assert "numpy" in text
    assert "/" not in text
    assert text.splitlines()[0] in markdown([])
    assert markdown([]).startswith(HEAD[:20])


@pytest.mark.slow
def test_many_gain_sets_by_hand_give_the_same_verdicts(tmp_path):
    path = tmp_path / "gains.toml"
    path.write_text(commands.gain_sets(300))
    assert commands.gate(path)[0] == "gate, 300 gain sets"


def test_other_verdicts_are_noticed():
    ours = json.dumps({"results": [{"name": "a", "verdict": "rejected"}]})
    with pytest.raises(Disagreement):
        commands.compare(ours, "a accepted\n")


@pytest.mark.parametrize("name", sorted(arms.ARMS))
def test_the_arms_by_hand_are_those_of_lyapcheck(name):
    model = NumericModel(load_robot(name))
    q, x = np.random.default_rng(7).normal(size=(2, 20, model.n))
    M, dM = arms.ARMS[name](q)
    np.testing.assert_allclose(M, model.mass(q), rtol=0, atol=1e-14)
    np.testing.assert_allclose(arms.coriolis(dM, x), model.coriolis(q, x), rtol=0, atol=1e-14)
    np.testing.assert_array_equal(arms.VISCOUS[name], model.viscous)


def test_other_values_are_noticed():
    one = np.ones(3)
    assert len(list(throughput.compared("V", "arm", {"a": lambda: one, "b": lambda: one + 1e-12}, 3))) == 2
    with pytest.raises(Disagreement):
        list(throughput.compared("V", "arm", {"a": lambda: one, "b": lambda: 1.1 * one}, 3))


def test_states_per_second_counts_states_and_not_calls():
    few, many = (states_per_second(lambda: sum(range(20_000)), states) for states in (1, 1000))
    assert many > 50 * few


@pytest.mark.slow
def test_every_way_to_the_rates_gives_the_same_values():
    rows = list(throughput.rows(400))
    assert {(row[0], row[1]) for row in rows} == {(f, arm) for f in ("V", "dV/dt") for arm in arms.ARMS}
    assert all(float(row[-1]) < 1e-12 and float(row[3]) > 0 for row in rows)


@pytest.mark.slow
def test_an_arm_of_four_joints_is_proved_for_half_of_what_is_refuted():
    (row,) = commands.epsilon((("px100", 1),))
    assert row[:2] == ["px100", 1]
    assert 50 < float(row[4].removesuffix("%")) < 100


@pytest.mark.slow
def test_every_way_to_many_runs_ends_alike():
    ours, *others = batches.rows(20, 1)
    assert ours[:2] == ["lyapcheck", 20]
    assert any("CVODES" in other[0] for other in others)
    assert all(0 < float(other[-1]) < 1e-5 for other in others)
