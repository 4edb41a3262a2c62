"""The map over m and k_v rests on certificates that are judged."""

import json
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest

from lyapcheck.check.recheck import gather, recheck
from lyapcheck.control.gains import GainSet, paper_gain_file, read_gain_file
from lyapcheck.report import experiment
from lyapcheck.report.experiment import study_file
from lyapcheck.report.gain_map import gain_map, kept_map, map_eps0
from lyapcheck.robots import load


@pytest.mark.slow
def test_a_map_of_an_arm_of_ones_own_rests_on_certificates(tmp_path):
    """Each place that names an ε₀: the checker proves it, for that m and that k_v."""
    model, gains = load("pendulum1"), {1: GainSet("g", 1, (Fraction(4),), (Fraction(1),))}
    cells = gain_map(model, gains, [0.5], scales=("0.2", "1"))
    assert [(one.m, one.kv, one.within_19) for one in cells] == [
        (1, "0.2", True), (1, "1", False)
    ]  # fmt: skip
    for one in cells:
        assert one.certificate is not None
        (tmp_path / Path(one.path).name).write_text(one.certificate, encoding="utf-8")
        statement = json.loads(one.certificate)["statement"]
        assert [Fraction(kv) for kv in statement["kv"]] == [Fraction(one.kv)]
        assert map_eps0(Fraction(statement["eps0"])) == one.eps0
    outcome = recheck(gather([str(tmp_path)]))
    assert [one.verdict for one in outcome.checked] == ["proved", "proved"]


@pytest.mark.slow
def test_the_map_of_the_papers_arm_is_shown_where_the_checker_accepts_it(monkeypatch, tmp_path):
    """For the paper's arm and K_p alone, and not if one ε₀ is larger than its certificate says."""
    model = load("buap3")
    sets = {one.m: one for one in read_gain_file(paper_gain_file()).gains if one.m is not None}
    cells = kept_map(model, sets)
    assert {one.m for one in cells} == {1, 2, 3}
    assert all(cell.certificate for cell in cells)
    other = {1: replace(sets[1], kp=sets[2].kp)}
    assert kept_map(model, other) == []
    assert kept_map(load("reyes-kelly2"), sets) == []
    study = json.loads(study_file("gain_map").read_text(encoding="utf-8"))
    study["map"][0]["eps0"] = "0.9"
    file = tmp_path / "gain_map.json"
    file.write_text(json.dumps(study), encoding="utf-8")
    monkeypatch.setattr(experiment, "study_file", lambda name: file)
    assert kept_map(model, sets) == []
