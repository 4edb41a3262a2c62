"""What every robot model must satisfy: the built-in arms and random chains of links, exactly."""

from fractions import Fraction
from itertools import product

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lyapcheck import robots
from lyapcheck.errors import InputError
from lyapcheck.robots import trig
from tests.helpers.costly import costly
from tests.helpers.robot_cases import BUILT_IN, angles, model_of, plain_links, rates

models = st.one_of(st.sampled_from(BUILT_IN).map(robots.load), plain_links().map(model_of))


def check_symmetric(model):
    assert all(model.mass[i][j] == model.mass[j][i] for i, j in product(range(model.n), repeat=2))


def check_mass_rate(model):
    """(3): ∂M_ij/∂q_k = c_ijk + c_jik for every k is Ṁ = C + Cᵀ for every velocity."""
    c = model.christoffel
    for i, j, k in product(range(model.n), repeat=3):
        assert trig.derivative(model.mass[i][j], k) == c[i][j][k] + c[j][i][k]


def check_exchange(model):
    """C(q,x)y = C(q,y)x."""
    c = model.christoffel
    for i, j, k in product(range(model.n), repeat=3):
        assert c[i][j][k] == c[i][k][j]


@pytest.mark.slow
@costly
@given(plain_links().map(model_of))
def test_identities_of_random_chains(model):
    check_symmetric(model)
    check_mass_rate(model)
    check_exchange(model)


@costly
@given(st.data())
def test_mass_is_positive_definite(data):
    model = data.draw(models)
    sin, cos = zip(*data.draw(angles(model.n)), strict=True)
    mass = model.at(sin, cos, Fraction).mass()
    w = data.draw(rates(model.n).filter(any))
    assert sum(w[i] * mass[i][j] * w[j] for i, j in product(range(model.n), repeat=2)) > 0


def test_fixing_an_unknown_parameter_is_refused():
    with pytest.raises(InputError, match=r"no such parameter.*base_inertia"):
        robots.load("buap3").fixed(tail_inertia=1)
