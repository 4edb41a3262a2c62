"""Numbers of an arm within ± a share: what gets a range, and what a certificate over it is about."""

from fractions import Fraction

import pytest

from lyapcheck.control.gains import paper_gain_file, read_gain_file
from lyapcheck.errors import InputError
from lyapcheck.robots import load, names
from lyapcheck.search.controlled_arm import ControlledArm
from tests.helpers.command import invoke

F = Fraction
GAINS = read_gain_file(paper_gain_file("table2_shoulder_elbow")).gains


@pytest.mark.parametrize("name", names())
def test_numbers_without_a_range_get_one_and_the_others_keep_theirs(name):
    exact, spread = load(name), load(name, spread=F(1, 20))
    for key, number in spread.parameters.items():
        before = exact.numbers[key]
        if before.ranged:
            assert number.bounds == before.bounds
        else:
            assert number.bounds == tuple(sorted((before.value * F(19, 20), before.value * F(21, 20))))
    for number, before in zip(spread.viscous, exact.viscous, strict=True):
        assert number.ranged
        assert number.value == before.value
    assert spread.fixed().mass == exact.fixed().mass


def test_what_the_inertia_does_not_depend_on_is_no_side_of_the_boxes():
    model = load("reyes-kelly2", spread=F(1, 20))
    loop = ControlledArm(GAINS[0], model, ranges=True).loop(F(1, 10))
    free = [low < high for low, high in loop.parameters]
    assert dict(zip(model.parameters, free, strict=True)) == {
        name: name.startswith("inertia") for name in model.parameters
    }


@pytest.mark.parametrize("percent", ["0", "100", "-5", "nan"])
def test_percentages_out_of_range_are_refused(percent):
    gains = str(paper_gain_file("table2_shoulder_elbow"))
    result = invoke("epsilon", gains, f"--spread={percent}")
    assert isinstance(result.exception, InputError)
    assert "above 0 and below 100" in str(result.exception)
