"""Two reports side by side: what got worse is said first and makes the exit code 1."""

import json
from copy import deepcopy

import pytest

from lyapcheck.errors import InputError
from lyapcheck.report.compare import SCHEMA, ReportChange, ReportComparison, compare, read_report
from lyapcheck.report.page import compared_page
from tests.helpers.heard import unnamed

CHECK = {"id": "19", "joint": "base", "margin": "0.1"}
OLD = {
    "schema": "lyapcheck/report/2",
    "claims": [
        {"proof": "published", "id": "a", "m": 1, "verdict": "proved", "grade": "exact"},
        {"proof": "published", "id": "b", "m": None, "verdict": "undecided", "grade": "numeric"},
    ],
    "others": [],
    "gate": [{"name": "<g>", "verdict": "accepted", "checks": [CHECK]}],
    "tiles": [{"gains": "<g>", "subject": "Motors", "number": "9 % in reserve"}],
    "epsilon": [{"name": "<g>", "published": None, "scalar": "1", "certified": "2", "falsified": "3"}],
}


def changed(*places, to):
    """The old report with another value in one place."""
    new = deepcopy(OLD)
    inner = new
    for place in places[:-1]:
        inner = inner[place]
    inner[places[-1]] = to
    return new


def test_nothing_changed():
    result = compare(OLD, OLD, "old")
    assert result.changes == ()
    assert result.exit_code == 0
    assert "No verdict, tile, margin or ε₀ has changed" in str(result)


@pytest.mark.parametrize(
    ("new", "what", "worse"),
    [
        (changed("claims", 0, "verdict", to="refuted"), "claim", True),
        (changed("claims", 0, "verdict", to="undecided"), "claim", True),
        (changed("claims", 1, "verdict", to="proved"), "claim", False),
        (changed("claims", 0, "grade", to="kernel"), "claim", False),
        (changed("claims", to=OLD["claims"][1:]), "claim", True),
        (changed("gate", 0, "verdict", to="rejected"), "gate", True),
        (changed("gate", 0, "checks", 0, "margin", to="0.2"), "margin", False),
        (changed("tiles", 0, "number", to="5 % in reserve"), "tile", False),
        (changed("epsilon", 0, "certified", to="2.5"), "ε₀", False),
        (changed("epsilon", 0, "certified", to=None), "ε₀", True),
    ],
)
def test_a_change_is_found_and_weighed(new, what, worse):
    result = compare(OLD, new, "old")
    assert [(change.what, change.worse) for change in result.changes] == [(what, worse)]
    assert result.exit_code == int(worse)


def test_what_got_worse_comes_first_in_every_format():
    new = changed("claims", 1, "verdict", to="proved")
    new["gate"][0]["verdict"] = "rejected"
    result = compare(OLD, new, "old")
    assert [change.worse for change in result.changes] == [True, False]
    assert result.written("markdown").index("Worse (1)") < result.written("markdown").index("Changed (1)")
    assert "&lt;g&gt;" in result.written("html")
    assert json.loads(result.written("json"))["changes"][0]["new"] == "rejected"


@pytest.mark.parametrize("text", ["", "[]", "{}", '{"schema": "lyapcheck/report/1"}'])
def test_what_is_no_report_is_refused(text, tmp_path):
    path = tmp_path / "report.json"
    path.write_text(text)
    with pytest.raises(InputError, match=r"--compare"):
        read_report(tmp_path)


@pytest.mark.parametrize("rows", ["{}", "3", "[3]", '[{"name": "one"}]', '[{"name": ["one"], "checks": 3}]'])
@pytest.mark.parametrize("key", ["claims", "others", "gate", "epsilon"])
def test_a_report_with_other_rows_is_refused(key, rows, tmp_path):
    path = tmp_path / "report.json"
    whole = {"claims": [], "others": [], "gate": [], "epsilon": [], "schema": SCHEMA}
    path.write_text(json.dumps({**whole, key: json.loads(rows)}))
    if rows == "{}":  # no rows at all
        assert read_report(path)["schema"] == SCHEMA
        return
    with pytest.raises(InputError, match="has other rows than a report"):
        read_report(path)


def test_the_page_of_what_changed_is_whole():
    """With a language and a title, as those who hear it need them; names are escaped."""
    change = ReportChange("gate", "<b>&", "accepted", "rejected", worse=True)
    page = compared_page(ReportComparison((change,), "before").document())
    assert page.startswith('<!DOCTYPE html>\n<html lang="en">')
    assert "<title>✗ 1 worse verdict, 0 other changes since before</title>" in page
    assert page.count("<h1>") == 1
    assert "&lt;b&gt;&amp;" in page
    assert unnamed(page) == []
