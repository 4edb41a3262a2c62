"""The committed report is about what today's code asks: statements, gains, gate, words and page."""

import json
import re
from fractions import Fraction
from pathlib import Path

import pytest

from lyapcheck.answers.check.run import paper_case_data
from lyapcheck.answers.gate import GateAnswer
from lyapcheck.answers.table import build_table
from lyapcheck.certificate import to_json
from lyapcheck.check.kinds.decreasing import statement_of
from lyapcheck.claims.handover import ScriptRequest
from lyapcheck.claims.script import ask, find_script
from lyapcheck.cli.commands.report import _subject
from lyapcheck.report.build import _judged
from lyapcheck.report.jobs import BOXES, OTHERS, PROOF
from lyapcheck.report.model import published_notes
from lyapcheck.report.page import raw
from lyapcheck.robots import load
from lyapcheck.search.controlled_arm import ControlledArm
from tests.helpers.heard import unnamed

FOLDER = Path(__file__).parents[2] / "reports"
REPORT = json.loads((FOLDER / "report.json").read_text(encoding="utf-8"))
PAGE = (FOLDER / "index.html").read_text(encoding="utf-8")
REPAIR = "make report, and commit reports/"


@pytest.mark.usefixtures("in_this_process")
@pytest.mark.parametrize("proof", [PROOF, *OTHERS])
def test_every_claim_is_the_one_that_its_script_makes_today(proof):
    ms = REPORT["m"]
    script = find_script(proof)
    handover = ask(ScriptRequest(str(script), script.name, tuple(paper_case_data(m) for m in ms)))
    claims = {claim.id: claim for claim in handover.claims}
    rows = [row for row in (*REPORT["claims"], *REPORT["others"]) if row["proof"] == handover.name]
    assert {row["id"] for row in rows} == set(OTHERS.get(proof, ()) or claims), REPAIR
    for row in rows:
        claim = claims[row["id"]]
        assert (row["comment"], row["place"], tuple(row["uses"])) == (claim.says, claim.place, claim.uses), (
            REPAIR
        )
        if row["certificate"]:
            stated = handover.stated(claim.answers[ms.index(row["m"] or ms[0])])
            assert _certificate(row["certificate"])["statement"] == to_json(stated), (row["id"], REPAIR)


def test_every_part_that_a_drawing_names_is_on_the_page():
    """A hatching that is not there is drawn as nothing, and so are its bars."""
    named = set(re.findall(r'(?:url\(|href=")#([^)"]+)', PAGE))
    assert named <= set(re.findall(r' id="([^"]*)"', PAGE)), REPAIR


@pytest.mark.slow
def test_everything_has_a_name_for_readers_of_the_screen():
    assert unnamed(PAGE) == [], REPAIR


def decided(row):
    """What the gate decides about gains, without its advice."""
    keys = ("id", "joint", "verdict", "value", "limit")
    return [row["name"], row["m"], row["verdict"], [[one[key] for key in keys] for one in row["checks"]]]


def test_arm_gains_gate_and_table_are_those_of_today():
    subject, arm = _subject("", None, None), load(REPORT["robot"]["name"])
    assert (subject.robot, list(subject.ms)) == (arm.name, REPORT["m"])
    assert [decided(row) for row in REPORT["gate"]] == [
        decided(row) for row in GateAnswer(_judged(subject)).data()["results"]
    ], REPAIR
    assert REPORT["table"] == json.loads(json.dumps(build_table(subject.ms).data()["rows"])), REPAIR


def test_every_eps0_is_of_the_arm_and_gains_of_today():
    arm = load(REPORT["robot"]["name"])
    sets = {one.name: one for file in _subject("", None, None).gain_files for one in file.gains}
    assert [row["name"] for row in REPORT["epsilon"]] == list(sets), REPAIR
    for row in REPORT["epsilon"]:
        assert row["boxes"] == BOXES, REPAIR
        for path in row["certificates"].values():
            stated = _certificate(path)["statement"]
            coupling = tuple(map(Fraction, stated["coupling"]))
            assert bool(coupling) == path.endswith(".weighted.json"), path
            loop = ControlledArm(sets[row["name"]], arm).loop(Fraction(stated["eps0"]), coupling)
            assert to_json(statement_of(loop)) == stated, (path, REPAIR)


def test_words_and_page_are_those_of_today():
    notes = published_notes()
    assert REPORT["paper"] == notes.paper.citation, REPAIR
    for finding in REPORT["findings"]:
        for note in notes.findings:
            if set(note.claims) & set(finding["claims"]):
                said = [finding[key] for key in ("title", "argument", "fails", "consequence", "repair")]
                assert said == [note.title, note.argument, note.fails, note.consequence, note.repair], REPAIR
    for name in ("style.css", "page.js"):
        assert raw(name) in PAGE, REPAIR


def _certificate(path):
    result = json.loads((FOLDER / path).read_text(encoding="utf-8"))
    return result
