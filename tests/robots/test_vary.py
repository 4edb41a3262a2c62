"""``--vary``: ranges that a user puts on numbers of an arm, on arm files and on URDF files alike."""

from fractions import Fraction as F
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lyapcheck import robots
from lyapcheck.control.limits import arm_limits
from lyapcheck.errors import InputError
from lyapcheck.robots.fields import Vary
from lyapcheck.robots.numeric import NumericModel
from lyapcheck.robots.vary import corners, outside
from tests.helpers.arm_texts import PLANAR

UR5 = str(Path(__file__).parents[2] / "examples" / "ur5.urdf")


def varied(name, *texts):
    return robots.load(name, vary=texts)


@pytest.mark.parametrize("vary", ["payload=0..3", ["payload=0..3"], [Vary.parsed("payload=0..3")]])
def test_ranges_are_given_as_texts_or_as_data(vary):
    arm = robots.load("ur5", vary=vary)
    assert arm.ranges == ((F("0.1879"), F("3.1879")),)  # the mass of the last link, with the payload
    assert arm.varies == (Vary("payload", F(0), F(3)),)


@pytest.mark.parametrize(
    ("text", "name", "low", "high", "relative"),
    [
        ("viscous=-30%..+0%", "viscous", F(7, 10), F(1), True),
        ("viscous = −30% .. 10%", "viscous", F(7, 10), F(11, 10), True),
        ("payload=0..3", "payload", F(0), F(3), False),
        ("base_inertia=0.4..0.6", "base_inertia", F("0.4"), F("0.6"), False),
    ],
)
def test_what_is_typed_is_read_exactly(text, name, low, high, relative):
    result = Vary.parsed(text)
    assert (result.name, result.low, result.high, result.relative) == (name, low, high, relative)
    assert Vary.parsed(result.text) == result


@pytest.mark.parametrize(
    "text",
    [
        *("viscous", "viscous=30%", "viscous=1..30%", "viscous=2..1", "v=1..2..3", "v=a..1"),
        *("payload=5%..10%", "payload=-1..3"),
    ],
)
def test_text_of_another_form_is_refused(text):
    with pytest.raises(InputError, match="--vary"):
        Vary.parsed(text)


def test_friction_and_numbers_of_an_arm_file_get_ranges():
    model = varied("buap3", "viscous=-30%..+0%", "shoulder_gravity=30..40")
    assert [number.bounds[0] for number in model.viscous] == [F("0.2842"), F("1.6016"), F("0.2842")]
    assert model.parameters["shoulder_gravity"].bounds == (30, 40)
    assert robots.load("buap3").viscous[0].bounds[0] == F("0.406")


def test_masses_and_payload_of_a_urdf_arm_move_its_dynamics():
    """At the ends of the range M is that of the arm with those masses."""
    nominal, model = robots.load(UR5), varied(UR5, "mass=-10%..+10%", "payload=0..3")
    own = nominal.chain.links[-1].mass
    assert model.parameters["wrist_3_joint_mass"].bounds == (own * F(9, 10), own * F(11, 10) + 3)
    q = np.random.default_rng(1).uniform(-3, 3, (5, 6))
    exact = nominal.chain
    heavy = model.fixed(**{name: number.bounds[1] for name, number in model.parameters.items()})
    links = tuple(
        type(link)(link.axis, link.origin, mass, link.com, link.inertia, link.turn)
        for link, mass in zip(exact.links, (n.bounds[1] for n in model.parameters.values()), strict=True)
    )
    assert heavy.chain.links == links
    same = model.fixed(**{name: link.mass for name, link in zip(model.parameters, exact.links, strict=True)})
    np.testing.assert_allclose(
        NumericModel(same).mass(q), NumericModel(nominal).mass(q), rtol=1e-13, atol=1e-15
    )


@pytest.mark.parametrize("masses", [(), ("elbow_mass=3..4",), ("mass=-50%..50%",)])
def test_a_payload_of_links_in_an_arm_file_is_carried(masses, tmp_path):
    file = tmp_path / "planar.toml"
    file.write_text(PLANAR, encoding="utf-8")
    before, after = varied(str(file), *masses), varied(str(file), "payload=0..10", *masses)
    low, high = before.parameters["elbow_mass"].bounds if masses else (F("3.88"), F("3.88"))
    assert after.parameters["elbow_mass"].bounds == (low, high + 10)
    weight = F("9.81") * F("0.498")
    bare, loaded = (
        arm_limits(str(file), tuple(map(Vary.parsed, one))) for one in (masses, (*masses, "payload=0..10"))
    )
    assert float(loaded.gravity[0] - bare.gravity[0]) == pytest.approx(float(10 * weight))


@pytest.mark.parametrize("text", ["payload=2..2", "mass=20%..20%"])
def test_a_range_of_one_value_is_that_value(text):
    nominal, model = robots.load(UR5), varied(UR5, text)
    assert model.chain is not None
    own = [link.mass for link in nominal.chain.links]
    expected = [*own[:-1], own[-1] + 2] if "payload" in text else [F(6, 5) * mass for mass in own]
    assert [link.mass for link in model.chain.links] == expected


@pytest.mark.parametrize("texts", [("payload=0..3",), ("mass=-5%..5%",), ("mass=-5%..5%", "payload=0..3")])
def test_bounds_of_gravity_over_masses_hold_and_are_those_of_the_heaviest(texts):
    varies = tuple(map(Vary.parsed, texts))
    limits, model = arm_limits(UR5, varies), robots.load(UR5, vary=varies)
    heavy = model.fixed(**{name: number.bounds[1] for name, number in model.parameters.items()})
    q = np.random.default_rng(2).uniform(-np.pi, np.pi, (4000, 6))
    worst = np.abs(NumericModel(heavy).gravity(q)).max(axis=0)
    bounds = np.array([float(bound) for bound in limits.gravity])
    assert np.all(worst <= bounds * (1 + 1e-12) + 1e-12)
    assert np.all(bounds[1:3] <= 1.2 * worst[1:3])


def test_the_corners_are_the_ends_of_all_that_varies():
    varies = tuple(map(Vary.parsed, ("viscous=-30%..+0%", "base_inertia=0.4..0.6")))
    model = robots.load("buap3", vary=varies)
    result = dict(corners(model)[1])
    assert len(result) == 16
    assert {float(arm.viscous[0].value) for arm in result.values()} == {0.2842, 0.406}
    assert not any(arm.parameters or arm.viscous[0].ranged for arm in result.values())
    many = tuple(map(Vary.parsed, ("viscous=-30%..+0%", "mass=-10%..+10%")))
    assert len(corners(robots.load("ur5", vary=many))[1]) == 4
    assert len(corners(robots.load(UR5, vary=many))[1]) == 2  # friction that is 0 stays 0


@pytest.mark.parametrize(
    ("name", "text", "said"),
    [
        ("buap3", "foo=1..2", "has no number of that name"),
        ("buap3", "foo=1..2", "gravity_bound, inertia, torque_limit, viscous, or"),
        ("buap3", "payload=0..1", "has no number of that name"),
        ("buap3", "viscous=-130%..0%", "must not be negative"),
        (UR5, "mass=-100%..0%", "must be positive"),
        (UR5, "ixx=-10%..10%", "cannot vary on ur5"),
        (UR5, "gravity_z=-9.9..-9.7", "cannot vary on ur5"),
        (UR5, "upper_arm_link_mass=1..2", "such as wrist_3_joint_mass"),
        (UR5, "foo=1..2", "cannot vary on ur5"),
        (UR5, "elbow_joint_viscos=1..2", "did you mean elbow_joint_viscous?"),
        ("buap3", "Viscos=1..2", "did you mean viscous?"),
    ],
)
def test_ranges_that_no_arm_has_are_refused(name, text, said):
    with pytest.raises(InputError, match=said):
        varied(name, text)


def test_a_name_has_one_range():
    with pytest.raises(InputError, match=r"payload: has more than one range; keep one of them"):
        varied(UR5, "payload=0..1", "mass=-5%..5%", "payload=0..2")


@pytest.mark.parametrize("order", [1, -1])
def test_the_range_of_one_number_goes_before_that_of_all_in_any_order(order):
    model = varied("buap3", *("viscous=-30%..+0%", "base_viscous=0.4..0.5")[::order])
    assert [number.bounds[0] for number in model.viscous] == [F("0.4"), F("1.6016"), F("0.2842")]


@given(low=st.integers(-99, 300), width=st.integers(0, 300))
def test_the_arm_of_the_file_is_named_unless_it_is_in_the_ranges(low, width):
    named = outside(robots.load("buap3"), varied("buap3", f"viscous={low}%..{low + width}%"))
    assert bool(named) == (not low <= 0 <= low + width)


@pytest.mark.parametrize(
    ("name", "texts", "said"),
    [
        ("buap3", ("viscous=-30%..+0%",), "all 8 corners of the ranges"),
        ("buap3", ("elbow_viscous=0.4..0.4",), "the corner of the ranges"),
        ("ur5", ("viscous=-30%..+0%", "mass=-10%..+10%"), "4 of 4096 corners of the ranges (numbers of one"),
        ("ur5", ("viscous=-30%..+0%", "elbow_joint_viscous=1..2"), "4 of 64 corners of the ranges (numbers"),
        ("ur5", ("viscous=-30%..+0%",), "2 of 64 corners of the ranges (numbers of one name move together)"),
    ],
)
def test_it_is_said_how_many_corners_of_how_many_are_tried(name, texts, said):
    varies = tuple(map(Vary.parsed, texts))
    text, arms = corners(robots.load(name, vary=varies))
    assert text.startswith(said)
    assert len(arms) == next((int(word) for word in text.split() if word.isdigit()), 1)
