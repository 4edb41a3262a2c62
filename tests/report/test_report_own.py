"""A report on one's own arm and gains says the same of one gain set and one condition in every place."""

import json
import re
from fractions import Fraction

import pytest

from lyapcheck.answers.gate.judge import judged_sets
from lyapcheck.control.gains import GainFile, GainSet, read_gain_file
from lyapcheck.report import build as building
from lyapcheck.report.build import build, render
from lyapcheck.report.findings import as_the_gate_judges
from lyapcheck.report.model import Report, Subject
from lyapcheck.report.verdict import badges, sentences
from lyapcheck.robots import load
from tests.helpers.arm_texts import ONE_JOINT
from tests.helpers.heard import unnamed
from tests.helpers.one_process import one_process
from tests.report.conftest import AtOnce
from tests.report.test_report import KEPT, claim_row, dead_links, epsilon_row

PENDULUM = """
robot = "pendulum1"
[[gains]]
name = "nominal"
m = 1
kp = [3]
kv = [0.05]
[[gains]]
name = "well damped"
m = 1
kp = [3]
kv = [2]
"""
"""Of (10p) the heaviest pendulum admits 0.19 N·m, the nominal one 5.095."""
VERDICTS = {"accepted": "proved", "rejected": "refuted", "undecided": "undecided"}


def built(folder, gains, robot="pendulum1"):
    """A report, with all computations in this process."""
    path = folder / "mine.toml"
    path.write_text(gains, encoding="utf-8")
    with one_process() as patch:
        patch.setattr(building, "pool", AtOnce)
        return build(Subject(robot, (1,), (read_gain_file(path),), own=True))


def said(rows, gate):
    """Gain set, condition, the gate's verdict and that of the claim."""
    for result in gate:
        for condition in ("10p", "19"):
            one = result.verdict_of((condition,))
            for row in rows:
                if (row.id, row.gains) == (f"{condition}.gains", result.name):
                    yield result.name, condition, VERDICTS[one], row.verdict.value


@pytest.mark.usefixtures("in_this_process")
def test_claims_about_gains_are_the_gates_one_a_set():
    gate = judged_sets(read("pendulum1", {"light": ("0.1", "0.05"), "damped": ("3", "2")}))
    rows = [
        claim_row(name, m=m, proof="published", n=1)
        for name, m in (("10p.gains", 1), ("10p.gains", 1), ("19.gains", 1), ("19.gains", 2))
    ]
    result, certificates = as_the_gate_judges(rows, gate)
    assert list(said(result, gate)) == [
        ("light", "10p", "proved", "proved"),
        ("light", "19", "proved", "proved"),
        ("damped", "10p", "refuted", "refuted"),
        ("damped", "19", "refuted", "refuted"),
    ]
    assert result[-1] is rows[-1]
    assert {row.certificate for row in result[:-1]} == set(certificates)
    assert len(certificates) == 4


def read(robot, sets):
    """A gain file with the same k_p and k_v in every joint of an arm of one or three."""
    n = {"pendulum1": 1, "buap3": 3}[robot]
    gains = (
        GainSet(name, 1, (Fraction(kp),) * n, (Fraction(kv),) * n, index=k)
        for k, (name, (kp, kv)) in enumerate(sets.items())
    )
    return GainFile("gains.toml", robot, tuple(gains))


@pytest.mark.slow
def test_every_place_of_a_page_says_the_same(tmp_path):
    report = built(tmp_path, PENDULUM)
    places = list(said(report.claims, report.gate))
    assert sorted((name, condition) for name, condition, _, _ in places) == [
        (name, condition) for name in ("nominal", "well damped") for condition in ("10p", "19")
    ]
    assert [(gate, claim) for _, _, gate, claim in places if gate != claim] == []
    document = json.loads(str(render(report, ("json",))["report.json"]))
    for row in document["gate"]:
        failed = {check["id"] for check in row["checks"] if check["verdict"] == "rejected"} & {"10p", "19"}
        (badge,) = [one for one in document["verdict"] if one["subject"] == row["name"]]
        assert badge["word"].startswith(row["verdict"])
        own = [one for one in document["claims"] if one["gains"] == row["name"]]
        refuted = {one["id"] for one in own if one["verdict"] == "refuted"}
        assert refuted - {"18.gains"} == {f"{condition}.gains" for condition in failed}
    about = [row for row in report.every_claim if row.gains and row.id not in ("10p.gains", "19.gains")]
    assert {row.gains for row in about} == {"nominal", "well damped"}
    files = render(report, ("html",))
    page = str(files["index.html"])
    assert dead_links(page, files) == []
    assert unnamed(page) == []
    ids = re.findall(r' id="(?![pmh][0-9a-f]{10}")([^"]*)"', page)
    assert len(set(ids)) == len(ids)
    # It is about these gains alone.
    claims = {row.id for row in report.claims}
    assert not claims & {"16", "P", "T1.torque.m1.base"}
    assert claims >= {"2.1", "10p.gains", "19.gains"}
    assert {badge.subject for badge in badges(report)} == {"nominal", "well damped"}
    assert report.versions.keys() >= {"lyapcheck", "casadi", "numpy", "python-flint"}
    assert not re.search("printed proof|fig. 4|table 2 ", page.casefold())


def on_the_gate(sets, robot="buap3"):
    return judged_sets(read(robot, sets))


def words_of(gate, certified):
    """The sentence and the badges of a report that has nothing but a gate and ε₀."""
    rows = tuple(
        epsilon_row(name=name, m=1, certified=eps0, promise=KEPT) for name, eps0 in certified.items()
    )
    blank = dict.fromkeys(Report.__dataclass_fields__)
    report = Report(
        **(
            blank
            | {"gate": gate, "epsilon": rows, "own": True, "claims": (), "others": (), "robot": load("buap3")}
        )
    )
    return " ".join(sentences(report)), {one.subject: one.word for one in badges(report)}


def test_each_gain_set_breaks_what_it_breaks():
    gate = on_the_gate({"strong": ("9", "0.1"), "damped": ("1", "0.9"), "fit": ("1", "0.1")})
    sentence, _ = words_of(gate, {})
    assert "strong (m = 1) breaks (10p), damped (m = 1) breaks (19)" in sentence
    assert "fit (m = 1) meets (10p) and (19)" in sentence
    assert "and damped" not in sentence


def test_stable_is_said_only_where_no_motor_saturates():
    gate = on_the_gate({"strong": ("100", "0.1"), "damped": ("1", "0.9")})
    sentence, words = words_of(gate, {"strong": "0.1", "damped": "0.1"})
    assert words == {one.name: one.standing for one in gate}
    assert "stab" not in words["strong"]
    assert "dV/dt < 0 at every state is proved for damped" in sentence
    assert "of strong it is proved for motors without a limit" in sentence
    sentence, words = words_of(gate, {"strong": "0.1"})
    assert words["strong"] == "rejected"
    assert "of strong dV/dt < 0 at every state is proved for motors without a limit" in sentence


@pytest.mark.slow
def test_an_arm_without_friction_has_a_report_with_what_is_undecided(tmp_path):
    arm = tmp_path / "free.toml"
    arm.write_text(ONE_JOINT.format(viscous=0, torque=10, more=""), encoding="utf-8")
    gains = f'robot = "{arm}"\n[[gains]]\nname = "one"\nm = 1\nkp = [2]\nkv = [0.5]\n'
    report = built(tmp_path, gains, str(arm))
    (row,) = report.epsilon
    assert (row.certified, row.falsified) == (None, None)
    assert "no viscous friction" in row.reasons["certified"]
    assert "no viscous friction" in str(render(report, ("md",))["report.md"])
