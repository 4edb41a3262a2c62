"""The constants of an arm of any size, and the command that prints them."""

import json
from fractions import Fraction

import numpy as np
import pytest

from lyapcheck import robots
from lyapcheck.answers.robot import RobotReport, build
from lyapcheck.answers.robot.properties import CertifiedBounds, PropertyResult
from lyapcheck.check.numbers.polynomials import Enclosure
from lyapcheck.claims.decision import undecided
from lyapcheck.constants import ConstantResult, arm_constants
from lyapcheck.errors import InputError
from lyapcheck.output import text as plain
from lyapcheck.output.answer import Level
from lyapcheck.robots.fields import Vary
from lyapcheck.robots.numeric import NumericModel
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
