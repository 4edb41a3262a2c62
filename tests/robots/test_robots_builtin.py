"""The built-in arms against what their sources print."""

from fractions import Fraction

import pytest

from lyapcheck import robots
from lyapcheck.errors import InputError
from lyapcheck.robots.bodies import impossible_state
from tests.helpers.arm_texts import PLANAR, arm_of

F = Fraction


def test_the_built_in_arms_can_be():
    """They are read without this look for slips."""
    assert not any(impossible_state(robots.load(name)) for name in robots.names())


def test_small_arm_gravity_is_the_print():
    """g = (0, 14.28 sin q2 + 1.14 sin(q2+q3), 1.14 sin(q2+q3)), limits 15, 50, 4 N·m."""
    arm = robots.load("buap3-small")
    assert arm.at([F(0), F(1), F(0)], [F(1), F(0), F(1)], Fraction).gravity() == [0, F("15.42"), F("1.14")]
    assert [limit.value for limit in arm.torque_limit] == [15, 50, 4]
    assert all(key.split("_", 1)[1] == "inertia" for key in arm.parameters)


def test_paper_arm_limits_and_encoders():
    """Table 1 of the paper."""
    arm = robots.load("buap3")
    assert arm.joints == ("base", "shoulder", "elbow")
    assert [limit.value for limit in arm.torque_limit] == [50, 150, 15]
    assert arm.encoder == (1024000, 1024000, 655360)
    assert not any(limit.assumed for limit in arm.torque_limit)


def test_paper_arm_gravity_reaches_the_printed_bounds():
    """k_g = (0, 40.28, 1.81), attained with the arm stretched out horizontally."""
    arm = robots.load("buap3")
    sin, cos = [F(0), F(1), F(0)], [F(1), F(0), F(1)]
    printed = [bound.value for bound in arm.gravity_bound]
    assert printed == [0, F("40.28"), F("1.81")]
    assert arm.at(sin, cos, Fraction).gravity() == printed


def test_two_joint_arm_is_the_print():
    """M11 = 2.351 + 0.168 cos q2 and so on, and the printed C and g."""
    arm = robots.load("reyes-kelly2")
    sin, cos, w = [F(3, 5), F(5, 13)], [F(4, 5), F(12, 13)], [F(2), F(-3)]
    c2, s2, s1, s12 = F(12, 13), F(5, 13), F(3, 5), F(3, 5) * F(12, 13) + F(4, 5) * F(5, 13)
    m12 = F("0.102") + F("0.084") * c2
    assert arm.at(sin, cos, Fraction).mass() == [[F("2.351") + F("0.168") * c2, m12], [m12, F("0.102")]]
    torque = [sum(row[k] * w[k] for k in range(2)) for row in arm.at(sin, cos, Fraction).coriolis(w)]
    a = F("0.084") * s2
    assert torque == [-2 * a * w[1] * w[0] - a * w[1] * w[1], a * w[0] * w[0]]
    g1, g2 = F("9.81") * F("3.921"), F("9.81") * F("0.186")
    assert arm.at(sin, cos, Fraction).gravity() == [g1 * s1 + g2 * s12, g2 * s12]


def test_two_joint_print_agrees_with_its_links(tmp_path):
    """Each printed coefficient is the one of the links to less than one unit of its last digit."""
    file = tmp_path / "links.toml"
    file.write_text(PLANAR)
    derived, printed = robots.load(file), robots.load("reyes-kelly2")
    unit = F("0.001")
    for row, print_row in zip(derived.mass, printed.mass, strict=True):
        for entry, print_entry in zip(row, print_row, strict=True):
            assert all(abs(F(int(c.p), int(c.q))) < unit for c in (entry - print_entry).coeffs())
    difference = derived.potential - printed.potential
    assert all(abs(F(int(c.p), int(c.q))) < unit * F("9.81") for c in difference.coeffs())
    assert derived.mass != printed.mass


def test_pelican_is_the_print():
    """M and g of two links in a plane, by hand from Table 5.1."""
    arm, ((s1, c1), (s2, c2)) = robots.load("pelican2"), ((F(3, 5), F(4, 5)), (F(5, 13), F(12, 13)))
    m1, m2, lc1, lc2, l1 = map(F, ("6.5225", "2.0458", "0.0983", "0.0229", "0.26"))
    second = F("0.0116") + m2 * lc2**2
    across = second + m2 * l1 * lc2 * c2
    first = F("0.1213") + m1 * lc1**2 + m2 * l1**2 + across + m2 * l1 * lc2 * c2
    assert arm.at([s1, s2], [c1, c2], Fraction).mass() == [[first, across], [across, second]]
    g2 = F("9.81") * m2 * lc2 * (s1 * c2 + c1 * s2)
    assert arm.at([s1, s2], [c1, c2], Fraction).gravity() == [F("9.81") * (m1 * lc1 + m2 * l1) * s1 + g2, g2]


def test_paper_arm_inertia_is_a_chain_of_slender_links(tmp_path):
    """The printed-form M of the file is the one that its links give, as polynomials."""
    file = tmp_path / "slender.toml"
    file.write_text(SLENDER)
    assert robots.load(file).mass == robots.load("buap3").fixed().mass


SLENDER = arm_of(
    ("base", (0, 0, 1), (0, 0, 0), 1, (0, 0, 0), {"ixx": 0.5, "iyy": 0.5, "izz": 0.5}, 1),
    ("shoulder", (0, -1, 0), (0, 0, 0), 23.902, (0, 0, -0.091), {"ixx": 1.266, "iyy": 1.266, "izz": 0}, 1),
    ("elbow", (0, -1, 0), (0, 0, -0.45), 3.880, (0, 0, -0.048), {"ixx": 0.093, "iyy": 0.093, "izz": 0}, 1),
)


def test_a_misspelt_arm_gets_a_suggestion():
    with pytest.raises(InputError, match=r"reyes_kelly2.*did you mean reyes-kelly2\?"):
        robots.load("reyes_kelly2")
