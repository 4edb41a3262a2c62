"""Numbers of an arm within ± a share: what gets a range, and what a certificate over it is about."""

from fractions import Fraction
from pathlib import Path

import pytest

from lyapcheck.answers.epsilon import epsilon
from lyapcheck.check.loop.proof import proves
from lyapcheck.control.gains import paper_gain_file, read_gain_file
from lyapcheck.errors import InputError
from lyapcheck.robots import load, names
from lyapcheck.search.certified import certify
from lyapcheck.search.controlled_arm import ControlledArm
from lyapcheck.search.cover import SchurProblem
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


def test_no_spread_is_the_arm_itself():
    assert load("reyes-kelly2", spread=F(0)) is load("reyes-kelly2")


def test_what_the_inertia_does_not_depend_on_is_no_side_of_the_boxes():
    model = load("reyes-kelly2", spread=F(1, 20))
    loop = ControlledArm(GAINS[0], model, ranges=True).loop(F(1, 10))
    free = [low < high for low, high in loop.parameters]
    assert dict(zip(model.parameters, free, strict=True)) == {
        name: name.startswith("inertia") for name in model.parameters
    }


def test_a_certificate_over_the_spread_is_refused_for_a_wider_one():
    narrow, wide = (
        ControlledArm(GAINS[0], load("reyes-kelly2", spread=x), ranges=True) for x in (F(1, 20), F(1, 4))
    )
    outcome = certify(SchurProblem(narrow.loop(F(6, 10))), 60_000)
    assert outcome.proved
    assert proves(narrow.loop(F(6, 10)), outcome.tree)
    assert not proves(wide.loop(F(6, 10)), outcome.tree)


@pytest.mark.slow
def test_a_wider_spread_certifies_and_refutes_less():
    result = [
        epsilon(GAINS[0], load("reyes-kelly2", spread=x), ranges=True, starts=3, max_boxes=1500)
        for x in (F(1, 100), F(1, 10))
    ]
    assert result[0].certified is not None
    assert result[1].certified is not None
    assert result[0].falsified is not None
    assert result[1].falsified is not None
    assert result[1].certified < result[0].certified
    assert result[1].falsified < result[0].falsified < F("0.8106")
    assert any(number != load("reyes-kelly2").numbers.get(name) for name, number in result[1].corner.items())


@pytest.mark.parametrize("percent", ["0", "100", "-5", "nan"])
def test_percentages_out_of_range_are_refused(percent):
    gains = str(paper_gain_file("table2_shoulder_elbow"))
    result = invoke("epsilon", gains, f"--spread={percent}")
    assert isinstance(result.exception, InputError)
    assert "above 0 and below 100" in str(result.exception)


def test_masses_and_friction_of_urdf_files_are_spread(tmp_path):
    urdf = Path(__file__).parents[2] / "examples" / "ur5.urdf"
    overlay = tmp_path / "arm.toml"
    joint = '[[joints]]\nname = "elbow_joint"\nviscous = 2\n'
    overlay.write_text(f'title = "UR5"\nurdf = "{urdf}"\n{joint}')
    for file in (urdf, overlay):
        model = load(file, spread=F(1, 20))
        assert len(model.parameters) == 6
        assert all(x.bounds == (F(19, 20) * x.value, F(21, 20) * x.value) for x in model.parameters.values())
    assert model.viscous[2].bounds == (F("1.9"), F("2.1"))
