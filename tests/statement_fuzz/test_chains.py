"""C(q, x) of chains of links: no bound is proved below what it reaches, whatever forms come with it."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from random import Random
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from lyapcheck.robots.dynamics import Chain
from lyapcheck.verdicts import Verdict
from tests.statement_fuzz.generators import FALSE, Made, draw
from tests.statement_fuzz.generators.proposed import link
from tests.statement_fuzz.judge import judge
from tests.statement_fuzz.oracle.chains import torques

KINDS = "ChainCoriolisBelow", "ByRates"


def credulous(statement: Any) -> Any:
    """Proves everything."""
    return SimpleNamespace(verdict=Verdict.PROVED, method="faith", reason="", witness=None)


def judged(made: list[Made]) -> set[str]:
    """The verdicts, of which none has a fault; and the oracle sees by itself what is false of them."""
    result = [judge(one, k) for k, one in enumerate(made)]
    assert not [one.text() for one in result if one.fault]
    for k, one in enumerate(made):
        if one.truth == FALSE:
            assert judge(replace(one, truth=None), k, by=credulous).fault.startswith("false at")
    return {one.verdict for one in result}


def test_the_oracle_has_the_coriolis_torques_that_derivatives_of_the_mass_matrix_give() -> None:
    links = tuple(link(Random(k)) for k in range(4))
    chain = Chain(links, (Fraction(0),) * 3)
    q, x = np.random.default_rng(1).uniform(-3, 3, (2, 4))

    def at(angles: Any) -> Any:
        sines, cosines = np.sin(angles).tolist(), np.cos(angles).tolist()
        return np.array(chain.at(sines, cosines, {}, float).mass(), float)

    step = 1e-5
    slopes = [(at(q + step * e) - at(q - step * e)) / (2 * step) for e in np.eye(4)]
    along = sum(rate * slope for rate, slope in zip(x, slopes, strict=True))
    expected = along @ x - np.array([x @ slope @ x for slope in slopes]) / 2
    assert torques(links, q[:, None], x[:, None])[:, 0] == pytest.approx(expected, rel=1e-6)


def test_forms_are_accepted_for_no_bound_that_is_exceeded() -> None:
    made = [draw(20, k, "ByRates") for k in (3, 6)]
    assert judged(made) == {"proved", "undecided, and not true"}


def test_a_bound_beside_the_largest_value_is_proved_or_refuted() -> None:
    assert judged([draw(20, k, "ChainCoriolisBelow") for k in (1, 3)]) == {"proved", "refuted"}


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
def test_many_bounds_of_chains_have_no_faults(kind: str) -> None:
    made = [draw(20, k, kind) for k in range(12)]
    assert "proved" in judged(made)
    assert any(one.truth == FALSE for one in made)
