"""Numbers beside words of proof are rounded to the side on which they stay true."""

import re

import pytest

from lyapcheck.answers.derive import derivation
from lyapcheck.answers.gate import GateAnswer
from lyapcheck.answers.sweep.result import SweepAnswer, Tally, files
from lyapcheck.answers.table import build_table
from lyapcheck.report.build import render
from lyapcheck.report.model import MapCell, Report
from lyapcheck.report.notes import published_notes
from lyapcheck.robots import load

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
    text = SweepAnswer("plan.toml", maps).written("text")
    shown = re.findall(r"^ *1 +(.*)$", text, re.MULTILINE)[0].split()
    assert shown == ["0.102", "0.102", "0.0999"]


def test_the_drawing_shows_none_either(maps):
    drawing = str(files(SweepAnswer("plan.toml", maps, figures=True))["figures/map1_eps0.svg"])
    assert {">0.102<", ">0.0999<"} <= set(re.findall(r">0\.\d+<", drawing))
    assert ">0.103<" not in drawing


def test_the_map_of_a_report_shows_an_eps0_as_it_is_proved():
    cells = tuple(MapCell(1, kv, eps0, 1.0, 0.5, True) for kv, eps0 in PROVED.items())
    empty = dict.fromkeys(("epsilon", "claims", "others", "by_size", "runs", "findings"), ())
    empty |= {"sensitivity": None, "figures": {}}
    about = {"robot": load("buap3"), "table": build_table((1,)), "gate": GateAnswer(()), "map": cells}
    about |= {"derived": derivation(1)}
    page = render(Report(notes=published_notes(), own=True, ms=(1,), **about, **empty), ("html",))  # type: ignore[arg-type]
    shown = str(page["index.html"]).split('class="map"')[1]
    assert re.findall(r"<b>(0\.\d+)</b>", shown) == list(PROVED.values())
