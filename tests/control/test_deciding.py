"""Which conditions decide: the command line's, else the set's, else the file's, else (10p) and (19)."""

import json

import pytest

from lyapcheck import gate
from lyapcheck.control.gains import paper_gain_file, read_gain_file
from lyapcheck.pytest_plugin import assert_accepted
from tests.helpers.command import invoke

SETS = """\
{file}robot = "buap3"
[[gains]]
name = "breaks (19)"
m = 1
kp = [20, 38, 5]
kv = [8, 19, 1]
{own}
[[gains]]
name = "within (19)"
m = 1
kp = [28, 60, 5]
kv = [0.1, 0.1, 0.1]
"""


def written(folder, file="", own=""):
    path = folder / "gains.toml"
    path.write_text(SETS.format(file=file, own=own))
    return path


@pytest.mark.parametrize(
    ("file", "own", "asked", "first", "second"),
    [
        ("", "", None, ("10p", "19"), ("10p", "19")),
        ('condition = ["10p", "scalar"]\n', "", None, ("10p", "scalar"), ("10p", "scalar")),
        ("", 'condition = ["10p", "scalar"]', None, ("10p", "scalar"), ("10p", "19")),
        ('condition = ["10"]\n', 'condition = ["lasalle"]', None, ("lasalle",), ("10",)),
        ('condition = ["10"]\n', 'condition = ["lasalle"]', ("10i",), ("10i",), ("10i",)),
    ],
)
def test_what_is_nearest_to_the_user_decides(tmp_path, file, own, asked, first, second):
    results = gate(written(tmp_path, file, own), deciding=asked)
    assert [one.deciding for one in results] == [first, second]


def test_the_command_the_fixture_and_the_sweep_read_the_same_key(tmp_path):
    named = written(tmp_path, own='condition = ["10p", "scalar"]')
    assert invoke("gate", str(named)).exit_code == 0
    assert invoke("gate", str(named), "--condition", "19").exit_code == 1
    assert len(assert_accepted(named)) == 2
    with pytest.raises(AssertionError, match=r"\(19\)"):
        assert_accepted(named, conditions=("10p", "19"))
    plan = tmp_path / "plan.toml"
    sets = named.read_text().partition("\n")[2]
    plan.write_text(f'robots = ["buap3"]\nquestions = ["gate"]\n{sets}')
    assert invoke("sweep", str(plan), "--out", str(tmp_path / "out")).exit_code == 0
    rows = [json.loads(line) for line in (tmp_path / "out" / "rows.jsonl").read_text().splitlines()]
    assert [row["verdict"] for row in rows] == ["accepted", "accepted"]


def test_each_set_has_the_certificates_of_its_own_conditions(tmp_path):
    first, second = gate(written(tmp_path, own='condition = ["scalar", "lasalle"]'))
    assert [check.id for check in first.checks if check.joint is None] == ["10", "scalar", "lasalle"]
    assert [check.id for check in second.checks if check.joint is None] == ["10"]


def test_a_file_without_the_key_names_nothing():
    assert {one.condition for one in read_gain_file(paper_gain_file()).gains} == {()}
