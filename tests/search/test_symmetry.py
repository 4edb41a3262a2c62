"""Sign symmetries: what they leave unchanged, and the errors that they let the search skip."""

from dataclasses import replace
from fractions import Fraction
from itertools import product

import numpy as np
import pytest

from lyapcheck.control.gains import GainSet
from lyapcheck.robots import load
from lyapcheck.robots.numeric import NumericModel
from lyapcheck.search.controlled_arm import ControlledArm
from tests.helpers.robot_cases import BUILT_IN

F = Fraction
EXPECTED = {"pendulum1": (0,), "reyes-kelly2": (0,), "pelican2": (0,)}
"""One joint: M is constant. Two joints: M depends on cos q₂ and M₁₂ ≠ 0, so both signs change together."""


def controlled(name, m=2):
    model = load(name)
    gains = GainSet("some", m, (F(40), F(30), F(20))[: model.n], (F(3, 10), F(1, 5), F(1, 10))[: model.n])
    return ControlledArm(gains, model)


def loop(name):
    return controlled(name).loop(F(1, 10))


def seen_symmetries(name):
    """All σ for which M(σq) = Σ M(q) Σ at random angles, in doubles."""
    model, generator = NumericModel(load(name)), np.random.default_rng(3)
    q = generator.uniform(-np.pi, np.pi, (50, model.n))
    M, result = model.mass(q), []
    for signs in product((1.0, -1.0), repeat=model.n):
        s = np.array(signs)
        if np.allclose(model.mass(q * s), s[:, None] * M * s, rtol=0, atol=1e-12):
            result.append(s)
    return result


@pytest.mark.parametrize("name", BUILT_IN)
def test_every_error_has_an_image_with_the_one_sided_signs(name):
    symmetries, sided = seen_symmetries(name), list(loop(name).one_sided)
    for signs in product((1.0, -1.0, 0.0), repeat=load(name).n):
        assert any(np.all((np.array(signs) * s)[sided] >= 0) for s in symmetries)


@pytest.mark.parametrize("name", BUILT_IN)
def test_as_many_errors_are_halved_as_there_are_independent_symmetries(name):
    assert 2 ** len(loop(name).one_sided) == len(seen_symmetries(name))
    assert loop(name).one_sided == EXPECTED.get(name, loop(name).one_sided)


def test_a_sine_in_the_inertia_breaks_the_symmetry():
    """M₁₁ with sin q₂: the mirror image is another arm, and nothing may be skipped."""
    case = loop("reyes-kelly2")
    assert case.one_sided == (0,)
    (a, b), (c, d) = case.arm.mass
    tilted = (((*a, ((0, 1, 0, 0), F(1, 10))), b), (c, d))
    assert replace(case, arm=replace(case.arm, mass=tilted)).one_sided == ()
    square = (((*a, ((0, 2, 0, 0), F(1, 10))), b), (c, d))
    assert replace(case, arm=replace(case.arm, mass=square)).one_sided == (0,)
