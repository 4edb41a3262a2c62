"""The constants of an arm of any size, and the command that prints them."""

import csv
import io
import json
from dataclasses import replace
from fractions import Fraction
from xml.etree import ElementTree as ET

import numpy as np
import pytest

from lyapcheck import robots
from lyapcheck.answers.robot import RobotReport, build
from lyapcheck.answers.robot.certified import CertifiedBounds
from lyapcheck.answers.robot.properties import PropertyResult
from lyapcheck.check.numbers.polynomials import Enclosure
from lyapcheck.claims.decision import undecided
from lyapcheck.constants import ConstantResult, arm_constants
from lyapcheck.errors import InputError
from lyapcheck.output import text as plain
from lyapcheck.output.answer import JUDGED_FORMATS, Level
from lyapcheck.robots.numeric import NumericModel
from lyapcheck.robots.vary import Vary
from tests.helpers.command import invoke
from tests.helpers.shares import but
from tests.helpers.urdf_texts import ARMS, TWO, generic

pytestmark = pytest.mark.usefixtures("in_this_process")


def run(*arguments):
    result = invoke("robot", *arguments)
    if isinstance(result.exception, InputError):
        raise result.exception
    return result.exit_code, result.stdout


def coriolis(model, q, x):
    size = np.linalg.norm(x, axis=-1)
    return np.linalg.norm(model.coriolis(q, x), 2, axis=(-2, -1)) / size


@pytest.mark.parametrize("name", but(["pelican2"], [*robots.names(), "ur5"]))
def test_every_constant_is_shown_by_its_state(name):
    arm = robots.load(ARMS / "ur5.urdf" if name == "ur5" else name)
    model = NumericModel(arm)
    for constant in arm_constants(arm, 100):
        state = np.array(constant.state)
        q, x = state[: arm.n], state[arm.n :]
        inside = float(
            constant.enclosure.upper if constant.name == "lambda_min" else constant.enclosure.lower
        )
        values, gravity = np.linalg.eigvalsh(model.mass(q)), model.gravity(q)
        shown = {"lambda_min": values[0], "lambda_max": values[-1], "k_g": np.linalg.norm(gravity)}
        shown |= {f"k_g{i + 1}": abs(gravity[i]) for i in range(arm.n)}
        value = float(coriolis(model, q, x)) if constant.name == "k_c" else float(shown[constant.name])
        assert value == pytest.approx(inside, rel=1e-6, abs=1e-9)


@pytest.mark.parametrize(
    ("name", "advice"),
    [
        ("pelican2", "try a larger --max-boxes"),
        ("ur5", "bounded by the best forms along the links, which more boxes do not change"),
        ("generic8", "bounded by the best forms along the links, which more boxes do not change"),
    ],
)
def test_what_is_wide_comes_with_a_word_about_it(tmp_path, name, advice):
    (tmp_path / "generic8.urdf").write_text(generic(8))
    path = {"ur5": ARMS / "ur5.urdf", "generic8": tmp_path / "generic8.urdf"}.get(name, name)
    arm = robots.load(path)
    wide, narrow = (
        ConstantResult(of, "kg·m²", Enclosure(Fraction(low), Fraction(2)), (0.0,) * 2 * arm.n)
        for of, low in (("k_c", "1"), ("lambda_max", "1.9"))
    )
    row = PropertyResult("2.1", "M(q) = M(q)ᵀ", undecided("not asked", ""))
    ends = {one.name: CertifiedBounds(one.enclosure.lower, one.enclosure.upper) for one in (wide, narrow)}
    text = plain.render(RobotReport(arm, (row,), (wide, narrow), certified=ends).document())
    assert f"k_c is wide, 50 %: {advice}" in " ".join(text.split())
    assert "λmax(M) = β_M is wide" not in text


@pytest.mark.parametrize(
    ("low", "gap"),
    [("0", "100 %"), ("0.001", "100 %"), ("1", "50 %"), ("1.8124", "9.4 %"), ("1.9999", "0.005 %")],
)
def test_a_gap_is_written_without_an_exponent(low, gap):
    arm = robots.load("pelican2")
    constant = ConstantResult("k_c", "kg·m²", Enclosure(Fraction(low), Fraction(2)), (0.0,) * 4)
    row = PropertyResult("2.1", "M(q) = M(q)ᵀ", undecided("not asked", ""))
    ends = {"k_c": CertifiedBounds(Fraction(low), Fraction(2))}
    text = " ".join(plain.render(RobotReport(arm, (row,), (constant,), certified=ends).document()).split())
    assert f" {gap.removesuffix(' %')} " in text
    assert "e+0" not in text


def test_the_gap_is_that_of_the_certified_ends_and_none_where_one_is_missing():
    """That a norm is not negative needs no certificate, that λmin(M) is not does."""
    names = ("lambda_min", "k_c", "k_g", "k_g1")
    constants = tuple(
        ConstantResult(name, "N·m", Enclosure(Fraction(99), Fraction(100)), (0.0,) * 4) for name in names
    )
    ends = {
        "lambda_min": CertifiedBounds(None, Fraction(100)),
        "k_c": CertifiedBounds(Fraction(90), Fraction(100)),
        "k_g": CertifiedBounds(None, Fraction(200)),
        "k_g1": CertifiedBounds(Fraction(50), None),
    }
    row = PropertyResult("2.1", "M(q) = M(q)ᵀ", undecided("not asked", ""))
    facts = RobotReport(robots.load("pelican2"), (row,), constants, certified=ends)
    text = plain.render(facts.document())
    rows = {line.split()[0]: line.split()[-1] for line in text.splitlines() if " N·m " in line}
    assert rows == {"λmin(M)": "–", "k_c": "10", "k_g": "100", "k_g1": "–"}
    assert "k_g is wide, 100 %: try a larger --max-boxes" in " ".join(text.split())
    assert "k_g1 is wide" not in text


def test_progress_names_what_is_done_along_a_chain(tmp_path):
    (tmp_path / "arm.urdf").write_text(generic(4))
    steps = []
    arm_constants(
        robots.load(tmp_path / "arm.urdf"),
        100,
        on_progress=lambda *step: steps.append(step),
        names=("lambda_min",),
    )
    kinds = ("posture", "forms along the links")
    assert [note for _, note in steps] == [f"lambda_min: {kind}" for kind in kinds]
    assert steps == sorted(steps)


# The command -----


@pytest.mark.parametrize(
    "name", but(["reyes-kelly2"], [name for name in robots.names() if name != "buap3-small"])
)
def test_built_in_arms_have_the_properties(name):
    code, out = run(name, "--format", "json", "--max-boxes", "100")
    result = json.loads(out)
    assert (code, result["schema"], result["robot"]) == (0, "lyapcheck/robot/1", name)
    assert [row["verdict"] for row in result["properties"]] == ["proved"] * 8
    for constant in result["constants"]:
        assert Fraction(constant["lower"]) <= Fraction(constant["upper"])
        assert len(constant["q"]) == result["n"]
    assert all(
        {"value", "unit", "source", "assumed"} <= number.keys() for number in result["numbers"].values()
    )


def test_friction_that_a_file_gives_as_0_is_named(tmp_path):
    file = tmp_path / "two.urdf"
    file.write_text(TWO.replace('damping="0.25"', 'damping="0"'))
    code, out = run(str(file), "--max-boxes", "300")
    assert code == 1
    assert "the viscous friction of elbow is 0 in the file; where that means unknown" in " ".join(out.split())


def test_friction_that_a_file_does_not_tell_is_not_refuted(tmp_path):
    file = tmp_path / "two.urdf"
    file.write_text(TWO.replace('<dynamics damping="0.25"/>', ""))
    code, out = run(str(file), "--max-boxes", "300")
    assert code == 3
    assert out.startswith("? two: property 2.7 undecided\n")
    assert "no viscous friction is known of elbow; state it in an arm file" in " ".join(out.split())


@pytest.mark.slow
def test_panda_with_its_hand():
    code, out = run(str(ARMS / "panda.urdf"), "--tip", "panda_hand", "--max-boxes", "300", "--format", "json")
    result = json.loads(out)
    assert (code, result["n"]) == (0, 7)
    assert result["properties"][0]["grade"] == "exact"
    assert Fraction(result["constants"][0]["lower"]) >= 0
    assert result["joints"][0]["torque_limit"]["value"] == "87"
    held = "are held, at zero where nothing else is said: panda_finger_joint1 (prismatic)"
    assert any(held in x for x in result["assumptions"])


@pytest.mark.slow
def test_what_was_not_proved_is_seen_first_and_fails_at_its_file():
    file = str(ARMS / "ur5.urdf")
    model = robots.load(file)
    report = replace(build(model, 20), path=file)
    lines = str(report).splitlines()
    assert lines[0] == "✗ ur5: property 2.7 refuted"
    assert sum(line.startswith("- property 2.7: refuted") for line in lines) == 1
    cases = {case.rule: case for case in report.annotations()}
    assert [case.level for case in cases.values()].count(Level.FAILED) == 1
    assert (cases["2.7"].level, cases["2.7"].path) == (Level.FAILED, file)
    assert cases["2.1"].level is Level.PASSED
    suite = ET.fromstring(report.written("junit"))[0]
    assert (suite.get("name"), suite.get("tests"), suite.get("failures")) == ("ur5", "8", "1")
    for form in JUDGED_FORMATS:
        assert report.written(form) == report.written(form)
    rows = list(csv.DictReader(io.StringIO(report.written("csv")), strict=True))
    assert [row["id"] for row in rows if row["kind"] == "property"] == [f"2.{k}" for k in range(1, 9)]
    for row, constant in zip(rows[8:], report.data()["constants"], strict=True):
        assert (row["kind"], row["id"], row["gap"]) == ("constant", constant["name"], constant["gap"])
        assert row["numeric_lower"] == constant["lower"]
    assert max(map(len, lines[:12])) <= 100


def test_a_refuted_print_is_a_remark_and_no_failure():
    report = build(robots.load("reyes-kelly2"), 40)
    assert report.document().title == "✓ reyes-kelly2: properties 2.1–2.8 proved"
    (remark,) = [case for case in report.annotations() if case.level is not Level.PASSED]
    assert (remark.level, remark.rule) == (Level.REMARK, "print-C-rates")
    assert remark.message.startswith("refuted: ")


NOMINAL, RANGES = "nominal numbers", "all values of the ranges"


@pytest.mark.parametrize(
    ("name", "varies", "nominal", "title"),
    [
        (
            "buap3",
            (),
            {"2.1", "2.2", "2.6", "2.7", "2.8"},
            "! buap3: properties 2.3–2.5 proved for its ranges",
        ),
        (
            "reyes-kelly2",
            ("viscous=-10%..+10%",),
            {"2.7"},
            "! reyes-kelly2: properties 2.1–2.6, 2.8 proved for its ranges",
        ),
        ("reyes-kelly2", (), None, "✓ reyes-kelly2: properties 2.1–2.8 proved"),
    ],
)
def test_each_row_says_for_which_arms_it_is_proved(name, varies, nominal, title):
    """Half of the rows of an arm with ranges are about its nominal numbers; the title claims no more."""
    report = build(robots.load(name, vary=tuple(map(Vary.parsed, varies))), 20)
    told = {row["id"]: row["for"] for row in report.data()["properties"]}
    assert report.document().title == title
    ids = {f"2.{k}" for k in range(1, 9)}
    if nominal is None:
        assert set(told.values()) == {None}
        return
    assert told == {key: NOMINAL if key in nominal else RANGES for key in ids}
    bounds = report.model.ranges
    for key in ids - nominal - {"2.7", "2.8"}:
        statement = report.certificates[f"{key}.json"].statement
        parts = [part for _, part in getattr(statement, "parts", [("", statement)])]
        assert all(part.parameters == bounds for part in parts)
    shown = next(one for one in report.document().details if getattr(one, "title", "") == "Properties")
    assert {row[0]: row[2] for row in shown.blocks[0].rows} == told
