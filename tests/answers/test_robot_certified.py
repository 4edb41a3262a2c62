"""What ``robot`` calls proved or certified has a certificate, and no false arm gets one."""

import json
from fractions import Fraction

import numpy as np
import pytest

from lyapcheck.answers.robot import build
from lyapcheck.answers.robot.properties import answered, bound_questions, certificates, certified
from lyapcheck.claims.decision import judge_afresh
from lyapcheck.constants import arm_constants
from lyapcheck.robots import load
from lyapcheck.robots.numeric import NumericModel
from lyapcheck.verdicts import Exit, Verdict
from tests.helpers.command import invoke
from tests.helpers.shares import one_in
from tests.helpers.urdf_texts import generic
from tests.robots.test_arm_files import PRINTED

pytestmark = pytest.mark.usefixtures("in_this_process")


FALSE_ARM = PRINTED.replace('M11 = [[2.351, ""], [2, "b c2"]]', 'M11 = [[1, ""], [1.05, "c2"]]').replace(
    'M12 = [[0.102, ""], [1, "b c2"]]', "M12 = []"
)


def test_an_arm_whose_mass_is_not_positive_is_refuted_and_gets_no_false_constant(tmp_path):
    (tmp_path / "false.toml").write_text(FALSE_ARM, encoding="utf-8")
    report = build(load(tmp_path / "false.toml"), 200)
    assert report.exit_code is Exit.REFUTED
    first = report.properties[0]
    assert first.verdict is Verdict.REFUTED
    assert first.finding.witness is not None
    assert {"q1", "q2", "x1", "x2"} <= set(first.finding.witness["point"])
    mass = report.certified["lambda_min"]
    assert (mass.lower, mass.upper) == (None, Fraction(0))
    assert report.certified["lambda_max"].lower is None
    assert report.certified["lambda_max"].upper is not None
    assert report.certified["lambda_max"].upper >= Fraction("2.05")


@pytest.mark.parametrize("name", one_in(3, ["reyes-kelly2", "pendulum1", "buap3"]))
def test_certified_ends_hold_at_random_states_and_are_near_the_numeric_ones(name):
    report = build(load(name), 400)
    model, rng = NumericModel(report.model), np.random.default_rng(5)
    q, x = rng.uniform(-np.pi, np.pi, (500, report.model.n)), rng.normal(size=(500, report.model.n))
    values, gravity = np.linalg.eigvalsh(model.mass(q)), np.abs(model.gravity(q))
    turning = np.linalg.norm(model.coriolis(q, x), 2, axis=(-2, -1)) / np.linalg.norm(x, axis=-1)
    ends = report.certified
    assert ends["lambda_min"].lower is not None
    assert ends["lambda_min"].lower <= values[:, 0].min() + 1e-12
    seen = {"lambda_max": values[:, -1], "k_c": turning, "k_g": np.linalg.norm(gravity, axis=1)}
    for constant, result in seen.items():
        assert float(ends[constant].upper or 0) >= result.max() - 1e-12
    for constant in report.constants:
        shown, numeric = ends[constant.name], constant.enclosure
        low, high = shown.lower or Fraction(0), shown.upper
        assert high is not None
        assert low <= numeric.upper
        assert numeric.lower <= high
        # boxes show norms of the Christoffel symbols, of which k_c is a part
        assert high - low <= (Fraction(1, 4) if constant.name == "k_c" else Fraction(1, 50)) * high


def test_of_a_chain_of_few_joints_forms_along_the_links_show_what_boxes_do_not(tmp_path):
    """Boxes show no bound of λmin(M) within the budget, and sizes one of |g_2| more than twice too large."""
    (tmp_path / "arm.urdf").write_text(generic(3), encoding="utf-8")
    arm = load(tmp_path / "arm.urdf")
    constants = arm_constants(arm, 50, names=("lambda_min", "k_g2"))
    asked = list(bound_questions(arm, constants))
    made = certificates(arm, asked)
    ends = certified(answered(arm, asked, made, judge_afresh(made)), positive=True)
    model, rng = NumericModel(arm), np.random.default_rng(7)
    q = rng.uniform(-np.pi, np.pi, (500, arm.n))
    assert set(ends) == {"lambda_min", "k_g2"}
    for end in ends.values():
        assert end.lower is not None
        assert end.upper is not None
        assert 0 < end.upper - end.lower <= Fraction(1, 50) * end.upper
    assert (ends["lambda_min"].lower or 0) <= np.linalg.eigvalsh(model.mass(q))[:, 0].min()
    assert np.abs(model.gravity(q)[:, 1]).max() <= (ends["k_g2"].upper or 0)


def test_certificates_are_accepted_by_recheck(tmp_path):
    made = tmp_path / "made"
    result = invoke(
        "robot", "reyes-kelly2", "--certificates", str(made), "--format", "json", "--max-boxes", "200"
    )
    assert result.exit_code == 0
    document = json.loads(result.stdout)
    files = {path.name for path in made.iterdir()}
    assert {f"2.{k}.json" for k in range(1, 9)} <= files
    assert {"printed%20C%20rates.json", "printed%20C%20torque.json", "printed%20g.json"} <= files
    for constant in document["constants"]:
        assert constant["numeric"] == {"lower": constant["lower"], "upper": constant["upper"]}
        for side, end in constant["certified"].items():
            assert (end is not None) == (f"{constant['name']}.{side}.json" in files)
    checked = invoke("recheck", str(made))
    assert checked.exit_code == 0
    assert checked.stdout.startswith(f"✓ {len(files)} accepted")
