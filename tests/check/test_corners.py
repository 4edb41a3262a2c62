"""Proofs at the corners of the ranges of M's parameters decide only where M is affine in each."""

from fractions import Fraction as F

import pytest

from lyapcheck.check.kinds.inertia import Bisection, MassAbove, MassAtCorners
from lyapcheck.check.refusal import Refused
from lyapcheck.check.verify import verify

RANGING = (((((0, 0, 1), F(1)),),),)
"""M of one joint is a parameter."""


def test_corners_decide_only_where_m_is_affine():
    mass, corners = RANGING, MassAtCorners((Bisection(),) * 2)
    above = MassAbove(mass, ((F(9, 10), F(1)),), F(1, 2))
    assert verify(above, corners).verdict == "proved"
    hollow = (((((0, 0, 2), F(1)), ((0, 0, 0), F(-1, 4))),),)
    with pytest.raises(Refused, match="affine"):
        verify(MassAbove(hollow, ((F(-1), F(1)),), F(0)), corners)  # positive at both ends, −1/4 at 0
    with pytest.raises(Refused, match="must be 2"):
        verify(above, MassAtCorners((Bisection(),)))
    many = ((((tuple([0, 0] + [int(i == k) for i in range(9)]), F(1)) for k in range(9)),),)
    nine = tuple(tuple(tuple(entry) for entry in row) for row in many)
    with pytest.raises(Refused, match="must not exceed 256"):
        verify(MassAbove(nine, ((F(1), F(2)),) * 9, F(0)), MassAtCorners((Bisection(),) * 512))
