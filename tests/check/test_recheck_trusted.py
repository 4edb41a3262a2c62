"""``recheck --trusted``: the rules and modules that each verdict rests on."""

import json
import re
import sys

import pytest

from lyapcheck.check import certificate
from lyapcheck.rechecking import ROOT, lies_in, modules, source
from tests.arena.run import ARENA
from tests.helpers.command import lyapcheck


def smallest():
    """For each kind by each rule the smallest certificate among the good ones of the arena."""
    result = {}
    for path in sorted((ARENA / "good").glob("*.json"), key=lambda path: path.stat().st_size):
        content = path.read_bytes()
        data = json.loads(content)
        result.setdefault((data["statement"]["kind"], data["proof"]["rule"]), (path.name, content))
    return result.values()


def run_by(content):
    """The files of the checker of which judging a certificate runs something, and what it finds."""
    run = set()

    def note(frame, event, _):
        if event == "call" and frame.f_code.co_filename.startswith(f"{ROOT}/"):
            run.add(frame.f_code.co_filename)

    sys.setprofile(note)
    try:
        return certificate.judged(content), run
    finally:
        sys.setprofile(None)


@pytest.mark.slow
def test_whatever_runs_is_listed():
    """The list is read off the imports; here certificates of every kind are judged, and what runs is seen."""
    certificate.judged(b"{}")
    seen = set()
    for name, content in smallest():
        finding, run = run_by(content)
        assert not finding.reason, name
        assert run <= {str(source(module)) for module in modules(finding.rules)}, name
        seen |= run
    assert len(seen) > 50


def test_what_no_certificate_names_is_not_listed():
    core = modules(())
    assert "lyapcheck.check.verify" in core
    assert not [name for name in core if name.startswith("lyapcheck.check.kinds.")]
    assert not [name for name in core if not source(name).exists()]
    (theirs,) = lies_in("lyapcheck.check.kinds.chain:ChainAbove lyapcheck.check.kinds.chain:OwnMoments")
    assert {theirs, "lyapcheck.check.loop.chain"} <= {*modules((("", f"{theirs}:ChainAbove"),))}
    decreasing = modules((("", "lyapcheck.check.kinds.decreasing:Decreasing"),))
    assert "lyapcheck.check.numbers.functions" in decreasing


@pytest.fixture(scope="module")
def shown(in_this_process):
    """What recheck says of a proof with theorems, as text and as data."""
    made = ARENA / "good" / "with-premises.sca.arms.all.m1"
    text, data = (
        lyapcheck("recheck", made, "--trusted", "--explain", "--format", form).stdout
        for form in ("text", "json")
    )
    return text, json.loads(data)


def test_a_theorem_rests_on_the_rules_of_its_obligations(shown):
    text, data = shown
    rows = {row["id"]: row["rules"] for row in data["certificates"]}
    assert "Stable by obligations" in rows["arms.all"]
    assert any(rule.startswith("BoundEveryN") or rule.startswith("ForAll") for rule in rows["arms.all"])
    trusted = data["trusted"]["proved"]
    assert set(trusted["rules"]) == {rule for rules in rows.values() for rule in rules}
    assert trusted["rules"]["Stable by obligations"] == ["lyapcheck.check.kinds.stability"]
    assert {place for places in trusted["rules"].values() for place in places} <= {*trusted["modules"]}
    assert "lyapcheck.check.systems.obligations" in trusted["modules"]
    assert f"{len(trusted['modules'])} modules" in text
    assert re.search(r"Stable by obligations +lyapcheck.check.kinds.stability", text)
    assert "Trusted for all that is proved" in text


def test_what_a_headline_takes_for_granted_stands_with_it(shown):
    text, data = shown
    rows = {row["id"]: row for row in data["certificates"]}
    granted = rows["arms.all"]["granted"]
    assert granted
    assert all(sentence in " ".join(text.split()) for sentence in (*granted, *data["granted"]))
    about_arms = {"Stable by obligations", "Property by obligations"}
    assert all(not row["granted"] for row in rows.values() if not about_arms & {*row["rules"]})
