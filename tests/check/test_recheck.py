"""The recheck command: what it accepts and refuses, collections of certificates, and its independence."""

import json
import os
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

import lyapcheck.check.verify as verify_module
from lyapcheck.answers.recheck import Recheck
from lyapcheck.check.__main__ import main
from lyapcheck.check.certificate import digest_of, judged
from lyapcheck.check.guard import Guard
from lyapcheck.check.judgement import Judgement
from lyapcheck.check.kinds.constant import Constant, SeparateBalls
from lyapcheck.check.recheck import Alarm, Checked, Document, Unreadable, gather, recheck, summed
from lyapcheck.check.refusal import Refused
from lyapcheck.check.statement import Relation
from lyapcheck.check.verify import each_once, verify
from lyapcheck.claims import run_proof
from lyapcheck.claims.decision import file_name
from lyapcheck.rechecking import GENERAL, as_json, text
from tests.helpers.command import lyapcheck as command
from tests.helpers.json_schema import follows

SCRIPT = """
from lyapcheck.claims import *
proof = Proof("mine", "My proof")
x = var("x")
proof.add("a", "tanh x ≤ x", for_all(tanh(x) <= x, 0))
proof.add("b", "1 ≤ 2", Constant(expr(1) <= 2), uses=["a"])
proof.add("c", "√2 ≤ 3", Constant(sqrt(2) <= 3), uses=["b"])
proof.add("d", "3 ≤ 1", Constant(expr(3) <= 1), uses=["a"])
proof.add("e", "open", identity(log((1 + x**2) ** 2), 2 * log(1 + x**2)))

@proof.claim("f", "h_m ≤ 1.06", uses=["c"])
def _(case):
    return for_all(h(case.m, x) <= "1.06")

proof.add("P", "2 ≤ 3", Constant(expr(2) <= 3), uses=["b"])
"""

pytestmark = pytest.mark.usefixtures("in_this_process")


@pytest.fixture(scope="module")
def certificates(in_this_process, tmp_path_factory):
    script = tmp_path_factory.mktemp("script") / "mine.py"
    script.write_text(SCRIPT, encoding="utf-8")
    return {name: one.text() for name, one in run_proof(script, ms=(2, 3), n=1).certificates.items()}


@pytest.fixture
def folder(tmp_path, certificates):
    made = tmp_path / "made"
    made.mkdir()
    for name, text_ in certificates.items():
        (made / name).write_text(text_, encoding="utf-8")
    return made


def outcome(*paths):
    return {one.file: one for one in recheck(gather(paths)).checked}


def sealed(data):
    """The text of a document with the digest of what it says now."""
    content = {key: value for key, value in data.items() if key != "digest"}
    return json.dumps({**content, "digest": digest_of(content)})


def rewrite(path, change, seal=True):
    data = json.loads(path.read_text(encoding="utf-8"))
    change(data)
    path.write_text(sealed(data) if seal else json.dumps(data), encoding="utf-8")


def test_all_of_a_proof_is_accepted_and_undecided_claims_have_no_certificate(folder):
    result = outcome(folder)
    assert recheck(gather([folder])).code == 0
    assert recheck(gather([folder.parent])).code == 0, "a folder of folders, as a report has it"
    assert set(result) == {"P.json", "a.json", "b.json", "c.json", "d.json", "f.m2.json", "f.m3.json"}
    assert all(one.accepted and not one.given for one in result.values())
    assert [result[name].verdict for name in ("d.json", "f.m2.json", "f.m3.json")] == [
        "refuted",
        "proved",
        "refuted",
    ]
    assert result["b.json"].finding.grade == "exact"
    assert result["b.json"].grade == "enclosure", "the weakest link is that of a"


def test_a_certificate_is_undecided_while_one_that_it_uses_is_not_at_hand(folder):
    alone = recheck(gather([folder / "c.json"]))
    assert alone.code == 3
    (result,) = alone.checked
    assert (result.status, result.given, result.verdict) == ("undecided", ("b",), "")
    assert result.reason.startswith("rests on b, whose certificate (")
    both = outcome(folder / "c.json", folder / "b.json")
    assert both["c.json"].reason == "rests on b, which is undecided"
    assert both["c.json"].given == both["b.json"].given == ("a",)


def test_in_a_directory_it_is_the_same(folder):
    (folder / "a.json").unlink()
    result = outcome(folder)
    assert {name for name, one in result.items() if one.status == "undecided"} == {
        "b.json",
        "c.json",
        "f.m2.json",
        "P.json",
    }
    assert result["d.json"].accepted, "a witness rests on nothing"
    assert recheck(gather([folder])).code == 3
    rewrite(folder / "d.json", lambda data: data.update(verdict="proved"))
    assert recheck(gather([folder])).code == 1, "refused outranks undecided"


def test_a_changed_certificate_takes_down_what_rests_on_it(folder):
    rewrite(folder / "a.json", lambda d: d["claim"].update(n=7), seal=False)
    result = outcome(folder)
    assert result["a.json"].reason.startswith("digest")
    rewrite(folder / "a.json", lambda d: None)
    result = outcome(folder)
    assert result["a.json"].accepted, "true as it is, but no longer what b names"
    assert result["b.json"].status == "undecided"
    assert "is not here" in result["b.json"].reason


@pytest.mark.parametrize("lie", [{"grade": "exact"}, {"statement": {"kind": "Everything"}}, {"more": 1}])
def test_a_certificate_with_a_right_digest_that_is_refused_takes_down_what_uses_it(folder, lie):
    rewrite(folder / "a.json", lambda data: data.update(lie))
    digest = json.loads((folder / "a.json").read_text(encoding="utf-8"))["digest"]
    rewrite(folder / "b.json", lambda data: data["uses"].update(a=digest))
    result = outcome(folder)["b.json"]
    assert (result.status, result.reason) == ("refused", "rests on a, whose certificate is refused")


@pytest.mark.parametrize(
    ("claim", "file", "m", "reason"),
    [
        ("x", "d", 2, "about d"),
        ("d", "d", 2, "which is refuted"),
        ("f", "f.m2", 3, "for m = 2"),
        ("f", "f.m2", None, "for m = 2"),
        ("f", "f.m2", 2, ""),
    ],
)
def test_uses_must_be_proved_and_of_that_claim(folder, claim, file, m, reason):
    digest = json.loads((folder / f"{file}.json").read_text(encoding="utf-8"))["digest"]

    def change(data):
        data["uses"][claim] = digest
        data["claim"]["m"] = m

    rewrite(folder / "P.json", change)
    result = outcome(folder)["P.json"]
    assert result.accepted if not reason else reason in result.reason


# The command ----------------------------------------------------------------------------------------------


def test_check_writes_and_recheck_accepts(tmp_path):
    made = tmp_path / "deep" / "made"
    checked = command(
        "check", "published.py", "--m", "2", "--only", "9", "--certificates", made, folder=tmp_path
    )
    assert checked.returncode == 0, checked.stderr
    assert sorted(os.listdir(made)) == ["2.8.json", "6.m2.json", "7a.m2.json", "9.m2.json"]
    rechecked = command("recheck", made, folder=tmp_path)
    assert rechecked.returncode == 0, rechecked.stderr
    lines = rechecked.stdout.splitlines()
    assert lines[0] == "✓ 4 accepted (4 proved)"
    assert [line.split()[:4] for line in lines if "2.8.json" in line] == [
        ["✓", "2.8.json", "proved", "exact"]
    ]


def test_json_is_versioned_and_complete(folder):
    rewrite(folder / "d.json", lambda d: d.update(verdict="proved"))
    (folder / "P.json").write_text("{")
    data = json.loads(command("recheck", folder, "--format", "json", "--trusted").stdout)
    follows(data, "recheck-3")
    assert data["schema"] == "lyapcheck/recheck/3"
    assert data["counts"] == {"accepted": 5, "refused": 2, "undecided": 0, "proved": 4, "refuted": 1}
    rows = {row["file"]: row for row in data["certificates"]}
    assert rows["d.json"]["reason"] == "verdict = proved: the proof gives refuted"
    assert rows["P.json"]["reason"].startswith("is not JSON in UTF-8 (")
    assert rows["f.m2.json"] | {"digest": "", "statement_digest": ""} == {
        "file": "f.m2.json",
        "status": "accepted",
        "accepted": True,
        "reason": "",
        "id": "f",
        "m": 2,
        "n": None,
        "statement": "h_2(x) ≤ 1.06 for all x in (−∞, ∞)",
        "statement_digest": "",
        "comment": "h_m ≤ 1.06",
        "verdict": "proved",
        "grade": "enclosure",
        "granted": [],
        "rules": rows["f.m2.json"]["rules"],
        "uses": ["c"],
        "given": [],
        "digest": "",
    }
    assert "ForAll by pieces of the domain" in rows["f.m2.json"]["rules"]


def test_the_other_formats_say_what_the_checker_says(folder):
    rewrite(folder / "d.json", lambda d: d.update(verdict="proved"))
    (folder / "a.json").unlink()
    result = recheck(gather([folder]))
    document = Recheck(result, trusted=True).document()
    assert document.title == "✗ 1 refused, 4 undecided, 1 accepted (1 refuted)"
    table, said, code = document.blocks
    assert table.rows[0][:3] == ("✗", "d.json", "refused")
    assert [row[0] for row in table.rows] == ["✗", "?", "?", "?", "?", "✓"]
    statement = "h_3(x) ≤ 1.06 for all x in (−∞, ∞)"
    assert table.rows[-1] == ("✓", "f.m3.json", "refuted", "enclosure", statement)
    assert said.items[0] == "d.json: verdict = proved: the proof gives refuted"
    whole = {section.title.split()[1].rstrip(":"): section.blocks[0].items for section in document.details}
    assert {file: items[0] for file, items in whole.items() if file not in ("d.json", "f.m3.json")} == {
        one.file: one.reason for one in result.checked if one.status == "undecided"
    }
    assert whole["f.m3.json"][0] == statement
    assert whole["f.m3.json"][1].endswith("the author's words: f (m = 3): “h_m ≤ 1.06”")
    rules, _, modules = code.blocks
    assert rules.rows == (("ForAll by witness", "lyapcheck.check.kinds.for_all, lyapcheck.check.statement"),)
    assert "lyapcheck.check.verify" in modules.items
    assert not [name for name in modules.items if name.startswith("lyapcheck.check.letters")]
    assert {f"Every verdict: {text}" for text in GENERAL} <= {*document.notes}


def test_a_genuine_certificate_under_other_words_is_shown_by_what_it_states(folder):
    def boast(data):
        data["claim"].update(id="Riemann", says="All zeros lie on the line.")

    rewrite(folder / "d.json", boast)
    shown = command("recheck", folder / "d.json").stdout
    assert shown.splitlines()[3].split() == ["✓", "d.json", "refuted", "exact", "3", "≤", "1"]
    assert "Riemann" not in shown
    shown = command("recheck", folder / "d.json", "-v").stdout
    assert "; the author's words: Riemann: “All zeros lie on the line.”" in shown
    (row,) = json.loads(command("recheck", folder / "d.json", "--format", "json").stdout)["certificates"]
    assert (row["statement"], row["comment"]) == ("3 ≤ 1", "All zeros lie on the line.")


# A contradiction ------------------------------------------------------------------------------------------

TRUE = {"kind": "Constant", "relation": {"left": ["num", "1"], "operator": "<=", "right": ["num", "2"]}}
FALSE = {"kind": "Constant", "relation": {"left": ["num", "2"], "operator": "<=", "right": ["num", "1"]}}


def certificate(statement, proof, verdict="proved", grade="exact", **claim):
    about = {"id": "a", "says": "words", "m": None, "n": None, "proof": "p"} | claim
    data = {"schema": "lyapcheck/certificate/1", "claim": about, "statement": statement, "proof": proof}
    return sealed({**data, "verdict": verdict, "grade": grade, "uses": {}, "versions": {}})


def shows(file, verdict, *parts):
    """A certificate that was judged, with what it decides."""
    finding = Judgement(digest=file, verdict=verdict, statement="S", shows=parts)
    return Checked(Document(file, Path(file)), finding, "accepted", "", "exact")


def test_a_pair_of_statement_and_proof_is_judged_once_and_a_refused_one_never_taken(monkeypatch):
    asked = []
    plain = verify_module._verified
    monkeypatch.setattr(verify_module, "_verified", lambda *pair: asked.append(pair) or plain(*pair))
    stated = Constant(Relation(("num", "0"), "<", ("num", "1")))
    proof, no_proof = SeparateBalls(128), SeparateBalls(1)
    with each_once():
        assert verify(stated, proof) == verify(stated, proof)
        for _ in range(2):
            with pytest.raises(Refused):
                verify(stated, no_proof)
    assert asked == [(stated, proof), (stated, no_proof), (stated, no_proof)]
    verify(stated, proof)
    verify(stated, proof)
    assert len(asked) == 5


def test_proved_and_refuted_is_an_alarm_that_names_both(monkeypatch):
    """No rule decides a statement both ways, we hope; so the outcomes are planted."""
    one = shows("one.json", "proved", ("A", "proved", ""), ("B", "proved", "part 1"))
    two = shows("two.json", "refuted", ("C", "refuted", ""), ("B", "refuted", "part 2"))
    three = shows("three.json", "proved", ("C", "proved", ""))
    made = summed((one, two, three), {}, ("seconds", "memory"))
    assert made.code == 4
    assert made.alarms == (
        Alarm("B", "part 1 of: S", ("one.json (part 1)",), ("two.json (part 2)",)),
        Alarm("C", "S", ("three.json",), ("two.json",)),
    )
    shown = text(made)
    assert shown.startswith(
        "ALARM: one statement is both proved, in one.json (part 1), and refuted, in two.json (part 2)"
    )
    assert [alarm["refuted"] for alarm in json.loads(as_json(made))["alarms"]] == [
        ["two.json (part 2)"],
        ["two.json"],
    ]
    shown = Recheck(made)
    assert shown.document().title.startswith("✗ ALARM: the checker is wrong; trust none of these verdicts")
    _, said = shown.document().blocks
    assert ["one.json (part 1)" in item for item in said.items] == [True, False]
    assert [case.level.value for case in shown.annotations() if case.rule == "alarm"] == ["failed"] * 2
    assert summed((one, three), {}, ()).code == 0
    refused = replace(two, status="refused", reason="rests on x, which is refuted")
    assert summed((one, refused), {}, ()).code == 4, "its own proof was accepted"


def test_a_conjunction_decides_its_parts_and_a_refutation_one_of_them():
    both = {
        "kind": "AllOf",
        "parts": [["one", TRUE], ["two", {"kind": "AllOf", "parts": [["three", FALSE]]}]],
    }
    exact = {"rule": "exact numbers"}
    deep = {"rule": "one part", "part": 1, "proof": {"rule": "one part", "part": 0, "proof": exact}}
    result = judged(certificate(both, deep, "refuted").encode())
    assert result.reason == ""
    assert result.shows == (
        (digest_of(both), "refuted", ""),
        (digest_of(both["parts"][1][1]), "refuted", "part 2"),
        (digest_of(FALSE), "refuted", "part 2.1"),
    )
    true = {"kind": "AllOf", "parts": [["one", TRUE]]}
    result = judged(certificate(true, {"rule": "every part", "parts": [exact]}).encode())
    assert result.shows == ((digest_of(true), "proved", ""), (digest_of(TRUE), "proved", "part 1"))


def test_the_alarm_is_the_exit_code_of_the_command(folder, monkeypatch, capsys):
    def contradicting(self, content, full):
        return replace(
            judged(content, full), shows=(("A", "proved" if b'"id":"a"' in content else "refuted", ""),)
        )

    monkeypatch.setattr(Guard, "judge", contradicting)
    assert main([str(folder / "a.json"), str(folder / "d.json")]) == 4
    assert capsys.readouterr().out.count("ALARM") == 2


def test_every_path_that_cannot_be_used_is_named(tmp_path):
    (tmp_path / "none").mkdir()
    with pytest.raises(Unreadable) as caught:
        gather([tmp_path / "none", tmp_path / "nowhere", "nul\0"])
    assert len(caught.value.problems) == 3


def test_files_of_one_name_are_told_apart(folder, tmp_path):
    (tmp_path / "other").mkdir()
    shutil.copy(folder / "a.json", tmp_path / "other")
    result = outcome(folder, tmp_path / "other")
    assert {str(folder / "a.json"), str(tmp_path / "other" / "a.json"), "b.json"} <= set(result)
    assert all(one.accepted for one in result.values())
    assert [one.status for one in recheck(gather([folder / "a.json"] * 2)).checked] == ["accepted"] * 2


def test_file_names_are_safe_for_any_id():
    assert file_name("16.6", 2) == "16.6.m2.json"
    assert file_name("../up", None) == "%2E.%2Fup.json"
    assert file_name("a b", 1) == "a%20b.m1.json"


# Independence ---------------------------------------------------------------------------------------------

ALONE = """
import sys
from importlib.abc import MetaPathFinder
class OnlyTheChecker(MetaPathFinder):
    def find_spec(self, name, path, target=None):
        root = name.partition(".")[0]
        if root in sys.stdlib_module_names or root == "flint" or name == "lyapcheck":
            return None
        if f"{name}.".startswith(("lyapcheck.check.", "lyapcheck.rechecking.")):
            return None
        raise ImportError(f"the checker must not import {name}")
sys.meta_path.insert(0, OnlyTheChecker())
from pathlib import Path
from lyapcheck.check.__main__ import main
from lyapcheck.check.certificate import judged
for path in Path(sys.argv[1]).iterdir():
    assert not judged(path.read_bytes()).reason
sys.exit(main(sys.argv[1:]))
"""


def test_the_checker_imports_only_the_standard_library_and_flint(folder):
    alone = subprocess.run(
        [sys.executable, "-c", ALONE, str(folder)], capture_output=True, text=True, timeout=120, check=False
    )
    assert alone.returncode == 0, alone.stderr
    assert alone.stdout == text(recheck(gather([folder])))
