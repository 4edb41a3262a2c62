"""The benchmarks compare like with like, and say what they measured."""

from __future__ import annotations

import json
import re
from fractions import Fraction

import numpy as np
import pytest

from lyapcheck import load_robot
from lyapcheck.robots.numeric import NumericModel

from . import batches, certificates, constants, epsilon, gate, simulate, table, throughput
from .by_hand import arms
from .machine import description
from .measure import Disagreement, states_per_second
from .render import markdown
from .results import (
    CertificateResult,
    CommandResult,
    ConstantsResult,
    Cost,
    ManyResult,
    RateResult,
    RunsResult,
)

MEASURED = [
    CommandResult("lyapcheck table", 0.25, 5, "mpmath", 0.5, "equal"),
    CommandResult("lyapcheck explain 7a", 0.2, 3),
]
RATES = [RateResult("V", "buap3", 3, {"lyapcheck": 2e7, "CasADi": 1e6}, 3e-16)]
PROOFS = [
    CertificateResult("buap3", 3, 2, 0.1665327, (Cost(0.9, 4019, 0.25, 0.5), Cost(0.995, 6000, 3.5, None)))
]
MANY = [ManyResult("ur5", 6, 1, 1.0, 1.25, 30.0, 56_400, 0.61)]
CONSTANTS = [ConstantsResult("panda", 7, (0.0024, 1.9e-5, 0.046, 7e-6), 32.9, 221_400, 10.5)]


def cells(text, first):
    (line,) = [line for line in text.splitlines() if line.startswith(f"| {first}")]
    return [cell.strip() for cell in line.strip("|").split("|")]


def test_a_row_has_the_times_and_their_ratio():
    text = markdown(["a machine"], MEASURED, RATES, PROOFS, MANY, CONSTANTS)
    assert "- a machine" in text
    assert cells(text, "`lyapcheck table`")[1:] == ["0.25 s", "5", "0.50 s", "2.00", "mpmath", "equal"]
    assert cells(text, "`lyapcheck explain")[1:] == ["0.20 s", "3", "—", "—", "nothing compares", "—"]
    assert cells(text, "V | buap3 (n = 3) | CasADi")[3:] == ["1.00e+06", "0.0500", "3e-16"]


def test_a_certificate_has_its_boxes_and_seconds_or_a_dash():
    text = markdown(["a machine"], MEASURED, RATES, PROOFS, [])
    assert cells(text, "arm | m | falsified ε₀ | 90")[3:] == ["90.0%", "99.5%"]
    assert cells(text, "buap3 (n = 3) | 2")[2:] == ["0.166533", "4019 / 0.25 s / 0.50 s", "— (6000)"]


def test_an_arm_of_many_joints_has_one_line():
    text = markdown(["a machine"], MEASURED, RATES, PROOFS, MANY, CONSTANTS)
    assert cells(text, "ur5 (n = 6)")[1:] == ["1", "1", "1.25", "80.0%", "30.00 s", "56 kB", "0.61 s"]


def test_the_constants_of_an_arm_have_one_line():
    text = markdown(["a machine"], MEASURED, RATES, PROOFS, MANY, CONSTANTS)
    gaps = ["0.24%", "0.00%", "4.60%", "0.00%"]
    assert cells(text, "panda (n = 7)")[1:] == [*gaps, "32.90 s", "221 kB", "10.50 s"]


@pytest.mark.slow
def test_certificates_are_measured_on_the_joints_an_arm_has():
    shares = (Fraction(9, 10), Fraction(99, 100))
    (result,) = certificates.benchmark(("pendulum1",), (4,), shares)
    assert (result.joints, result.m) == (1, 4)
    assert [cost.share for cost in result.costs] == [0.9, 0.99]
    assert 0 < result.costs[0].boxes < result.costs[1].boxes
    assert all(cost.checked is not None for cost in result.costs)


@pytest.mark.slow
def test_a_share_that_is_not_proved_has_no_time_of_the_checker():
    (result,) = certificates.benchmark(("reyes-kelly2",), (2,), (Fraction(101, 100), Fraction(99, 100)), 300)
    assert [cost.checked for cost in result.costs] == [None, None]


def test_runs_have_their_ratio():
    rows = [RunsResult("lyapcheck", 400, 1600.0, 1e-9), RunsResult("CVODES", 400, 160.0, 2e-7)]
    text = markdown(["a machine"], MEASURED, RATES, PROOFS, MANY, CONSTANTS, rows)
    assert cells(text, "CVODES")[1:] == ["400", "160", "0.100", "2e-07"]


def test_every_table_row_is_as_wide_as_its_head():
    text = markdown(["a machine"], MEASURED, RATES, PROOFS, MANY, CONSTANTS)
    for block in re.findall(r"(?:^\|.*\n)+", text, re.MULTILINE):
        assert len({line.count("|") for line in block.splitlines()}) == 1


def test_the_machine_is_described_without_naming_it():
    text = "\n".join(description())
    assert "processors" in text
    assert "numpy" in text
    assert "/" not in text


def test_gamma_5_by_hand_is_the_certified_one():
    result = table.benchmark(5, 5, 30, runs=1)
    assert result.agreement == "3 constants agree to 29 digits"
    assert result.seconds > 0
    assert result.by_hand_seconds > 0


def test_a_wrong_constant_is_noticed():
    bounds = {"lower": "1.17", "upper": "1.18"}
    ours = json.dumps({"rows": [{"m": 5, "gamma": bounds, "rho": bounds, "L": bounds}]})
    assert table.compare(ours, "5 1.171 1.172 1.175", 30) == 3
    with pytest.raises(Disagreement, match="rho_5"):
        table.compare(ours, "5 1.171 1.181 1.175", 30)


@pytest.mark.slow
def test_the_gate_by_hand_gives_the_same_verdicts():
    assert gate.benchmark(runs=1).agreement.startswith("the same 3 verdicts")


@pytest.mark.slow
def test_many_gain_sets_by_hand_give_the_same_verdicts():
    result = gate.many(sets=300, runs=1)
    assert result.agreement.startswith("the same 300 verdicts")
    assert "300 gain sets" in result.command


@pytest.mark.slow
def test_the_start_is_measured_beside_that_of_python():
    result = gate.start(gate.TABLE2, "pass", "Python alone", runs=2)
    assert float(result.agreement.split()[0]) > 0
    assert result.by_hand_seconds > 0
    assert result.seconds > 0


def test_short_times_are_told_in_milliseconds():
    text = markdown(["a machine"], [CommandResult("lyapcheck gate", 0.0312, 5, "python", 0.0118)], [], [], [])
    assert cells(text, "`lyapcheck gate`")[1:5] == ["31 ms", "5", "12 ms", "0.38"]


def test_other_verdicts_are_noticed():
    ours = json.dumps({"results": [{"name": "a", "verdict": "rejected"}]})
    with pytest.raises(Disagreement):
        gate.compare(ours, "a accepted\n")


def test_another_motion_is_noticed():
    ours = json.dumps({"results": [{"name": "a", "L2": 31.0}]})
    assert simulate.compare(ours, "a 31.0000001\n") < 1e-8
    with pytest.raises(Disagreement):
        simulate.compare(ours, "a 31.01\n")
    with pytest.raises(Disagreement):
        simulate.compare(ours, "b 31.0\n")


def test_a_sample_below_the_certificate_is_noticed():
    ours = json.dumps({"results": [{"certified": "0.13", "falsified": "0.14"}]})
    assert epsilon.compare(ours, "0.2\n") == (0.13, 0.14, 0.2)
    with pytest.raises(Disagreement):
        epsilon.compare(ours, "0.12\n")


@pytest.mark.parametrize("name", sorted(arms.ARMS))
def test_the_arms_by_hand_are_those_of_lyapcheck(name):
    model = NumericModel(load_robot(name))
    q, x = np.random.default_rng(7).normal(size=(2, 20, model.n))
    M, dM = arms.ARMS[name](q)
    np.testing.assert_allclose(M, model.mass(q), rtol=0, atol=1e-14)
    np.testing.assert_allclose(arms.coriolis(dM, x), model.coriolis(q, x), rtol=0, atol=1e-14)
    np.testing.assert_array_equal(arms.VISCOUS[name], model.viscous)


@pytest.mark.slow
def test_every_way_to_the_rates_gives_the_same_values():
    result = list(throughput.benchmark(throughput.Sizes(400, 200, 50)))
    assert {(rate.function, rate.joints) for rate in result} == {
        ("V", 2), ("V", 3), ("dV/dt", 2), ("dV/dt", 3)
    }  # fmt: skip
    assert all(rate.difference < 1e-12 for rate in result)
    assert all(len(rate.rates) >= 4 and min(rate.rates.values()) > 0 for rate in result)


def test_states_per_second_counts_states_and_not_calls():
    few, many = (states_per_second(lambda: sum(range(20_000)), states) for states in (1, 1000))
    assert many > 50 * few


@pytest.mark.slow
def test_the_motion_by_hand_is_the_simulated_one():
    assert "L2 indices agree" in simulate.benchmark(runs=1).agreement


@pytest.mark.slow
def test_an_arm_of_four_joints_is_proved_for_half_of_what_is_refuted():
    (result,) = certificates.many_joints((("px100", (1,)),))
    assert (result.joints, result.m) == (4, 1)
    assert 0.5 < result.certified / result.falsified < 1
    assert result.bytes > 1000
    assert 0 < result.checked < result.seconds


@pytest.mark.slow
def test_the_constants_of_an_arm_are_enclosed():
    (result,) = constants.benchmark(("pelican2",))
    assert (result.joints, len(result.gaps)) == (2, 4)
    assert all(0 <= gap < 0.1 for gap in result.gaps)  # that of k_c is 7 %
    assert result.bytes > 100
    assert result.seconds > 0
    assert result.checked > 0


@pytest.mark.slow
def test_every_way_to_many_runs_ends_alike():
    ours, *others = batches.benchmark(20, 1)
    assert (ours.way, ours.runs) == ("lyapcheck", 20)
    assert any("CVODES" in other.way for other in others)
    assert all(0 < other.difference < 1e-5 for other in others)


@pytest.mark.slow
def test_sampling_refutes_nothing_that_is_proved():
    assert "sampling proves nothing" in epsilon.benchmark(states=100_000).agreement
