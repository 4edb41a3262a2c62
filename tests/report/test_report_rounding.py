"""Numbers beside words of proof are rounded to the side on which they stay true."""

import re

import pytest

from lyapcheck.answers.sweep.result import SweepAnswer, Tally, files

PROVED = {"0.05": "0.10279", "0.1": "0.1025702", "0.2": "0.09999999"}
"""ε₀ that are proved, by k_v: to the nearest each would be shown as more."""


@pytest.fixture
def maps():
    result = Tally()
    row = {"robot": "a", "variation": (), "ask": "epsilon", "verdict": "proved", "reason": "", "m": 1}
    for kv, value in PROVED.items():
        result.add({**row, "family": "hyperbolic", "kv": [kv], "eps0": value})
    return result


def test_a_map_shows_no_eps0_above_what_is_proved(maps):
    text = SweepAnswer("plan.toml", maps).written("markdown")
    shown = re.findall(r"^\| 1 \| (.*) \|$", text, re.MULTILINE)[0].split(" | ")
    assert shown == ["0.102", "0.102", "0.0999"]


def test_the_page_shows_none_either(maps):
    page = str(files(SweepAnswer("plan.toml", maps))["index.html"])
    assert {">0.102<", ">0.0999<"} <= set(re.findall(r">0\.\d+<", page))
    assert ">0.103<" not in page
