"""A chain of links evaluated along the links, in every arithmetic, against its polynomials."""

from fractions import Fraction

import numpy as np
import pytest

from lyapcheck import robots
from lyapcheck.errors import InputError
from lyapcheck.robots.dynamics import Chain
from lyapcheck.robots.numeric import NumericModel
from tests.helpers.arm_texts import arm_of
from tests.helpers.robot_cases import circle
from tests.helpers.urdf_texts import generic

N = 4


@pytest.fixture(scope="module")
def arm(tmp_path_factory):
    file = tmp_path_factory.mktemp("chain") / "arm.urdf"
    file.write_text(generic(N, seed=4))
    return robots.load(file)


def all_of(place, x):
    """Every number of M, C, g and U."""
    rows = [*place.mass(), *place.coriolis(x), place.gravity(), [place.potential()]]
    return [entry for row in rows for entry in row]


def both(arm, sin, cos, x, lift):
    """Along the links, and by the polynomials."""
    chain = arm.dynamics
    assert isinstance(chain, Chain)
    return all_of(chain.at(sin, cos, {}, lift), x), all_of(chain.polynomials.at(sin, cos, {}, lift), x)


def test_rational_points_of_the_circle_give_the_same_rationals(arm):
    sin, cos = zip(*(circle(Fraction(k - 2, 3)) for k in range(N)), strict=True)
    along, expanded = both(arm, sin, cos, [Fraction(k, 2) for k in range(N)], Fraction)
    assert along == expanded


def test_parameters_enter_along_the_links_as_in_the_polynomials(tmp_path):
    """Four joints, the mass and the inertia of the last one uncertain."""
    ranged = {"value": 2, "low": 1, "high": 3}, {"value": 0.3, "low": 0.25, "high": 0.35}
    links = [
        (f"j{k}", axis, (0.1, 0.2, 0.3), mass, (0.1, 0, 0.2), {"ixx": ixx, "iyy": 0.3, "izz": 0.2}, 1)
        for k, (axis, (mass, ixx)) in enumerate(
            zip(((0, 0, 1), (0, 1, 0), (0.6, 0.8, 0), (1, 0, 0)), (*[(1, 0.3)] * 3, ranged), strict=True)
        )
    ]
    file = tmp_path / "arm.toml"
    file.write_text(arm_of(*links))
    arm = robots.load(file)
    assert set(arm.parameters) == {"j3_mass", "j3_ixx"}
    sin, cos = zip(*(circle(Fraction(k - 2, 3)) for k in range(4)), strict=True)
    x, values = [Fraction(k, 2) for k in range(4)], {"j3_mass": Fraction(3, 2), "j3_ixx": Fraction(1, 4)}
    along = all_of(arm.dynamics.at(sin, cos, values, Fraction), x)
    assert along == all_of(arm.dynamics.polynomials.at(sin, cos, values, Fraction), x)
    assert along == all_of(arm.fixed(**values).at(sin, cos, Fraction), x)
    assert along != all_of(arm.at(sin, cos, Fraction), x)


@pytest.mark.parametrize("seed", [47, 59])
def test_twelve_skew_joints_load_though_their_numbers_are_long(seed, tmp_path):
    file = tmp_path / "arm.urdf"
    file.write_text(generic(12, seed))
    mass = NumericModel(robots.load(file)).mass(np.zeros(12))
    assert np.linalg.eigvalsh(mass)[0] > 0


def test_white_space_before_the_declaration_is_read(tmp_path):
    file = tmp_path / "arm.urdf"
    declared = '\n  <?xml version="1.0"?>\n'
    file.write_text(declared + generic(2))
    assert robots.load(file).n == 2
    file.write_text(declared + generic(2).replace("<mass", "\n<mss", 1))
    with pytest.raises(InputError, match=r"arm\.urdf:3"):
        robots.load(file)
