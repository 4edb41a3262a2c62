"""What ``lyapcheck bounds`` says of errors at rest: proved bounds beside runs, which prove nothing."""

import json
import math
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest

from lyapcheck.answers.bounds import Comparisons, compare, comparison_data
from lyapcheck.answers.running import running_sentences
from lyapcheck.control.conditions import Check
from lyapcheck.control.gains import GainSet, paper_gain_file, read_gain_file
from lyapcheck.control.limits import model_limits
from lyapcheck.control.sampling import LoopRecord
from lyapcheck.errors import InputError
from lyapcheck.output.document import Table
from lyapcheck.robots import load
from lyapcheck.simulate.task import Task
from tests.helpers.command import lyapcheck

F = Fraction
GAINS = paper_gain_file("table2_shoulder_elbow")
FILE = read_gain_file(GAINS)
TASK = Task((math.pi / 4, math.pi / 2), (0.0, 0.0), (0.0, 0.0), 2.0)
ARM, DELTA = "reyes-kelly2", math.radians(10)
COULOMB = (7.17, 1.734)
"""N·m, of the shoulder and the elbow of that arm."""


@pytest.fixture(scope="module")
def sound():
    """A gain set of which each joint has a bound, under the dry friction of the arm."""
    return compare(FILE.gains[0], load(ARM), TASK, DELTA)


@pytest.fixture(scope="module")
def weak():
    """One with an elbow that dry friction holds anywhere."""
    second = FILE.gains[1]
    gains = GainSet(second.name, 2, (second.kp[0], F("1.7")), second.kv, index=second.index)
    return compare(gains, load(ARM), TASK, DELTA)


@pytest.fixture(scope="module")
def compared(sound, weak):
    return Comparisons((sound, weak), FILE)


def test_the_bound_is_where_the_controller_balances_dry_friction(sound):
    """k_p h_1(e) = f, h_1(e) = tanh e, to six digits and never below."""
    for error, f, k in zip(sound.rest, COULOMB, sound.gains.kp, strict=True):
        exact = math.atanh(f / float(k))
        assert error is not None
        assert exact <= float(error) <= exact * (1 + 1e-5)


def test_the_first_line_says_whether_all_is_proved(compared):
    sound, weak = compared.results
    assert (sound.proved, weak.proved) == (True, False)
    far = "reyes-kelly2 rests at most 20.73° from its goal under"
    assert compared.document().title == f"? {far} 1 of 2 gain sets, proved"
    alone, without = str(Comparisons((sound,))), str(Comparisons((weak,)))
    assert alone.startswith("✓ tau_m1 on reyes-kelly2: rests at most 20.73° from the goal (elbow), proved\n")
    assert without.startswith("? tau_m2 on reyes-kelly2: no error at rest is proved for elbow\n")
    both = Comparisons((sound, sound)).document().title
    assert both == f"✓ {far} 2 of 2 gain sets, proved"


def test_a_load_of_which_nothing_is_known_leaves_no_joint_a_bound(sound):
    """Where a check is about no joint, what dry friction alone leaves is not the bound under both."""
    open_ = replace(sound, unknown=(Check("holds", reason="the links are not known"),))
    assert open_.unknown_degrees == (None, None)
    assert Comparisons((open_,)).document().title.endswith("the errors under unknown gravity are undecided")
    assert comparison_data(open_)["disturbance"]["unknown_rest"] == [None, None]
    assert None not in comparison_data(open_)["disturbance"]["rest"]


def test_what_is_proved_is_not_rounded_down_and_runs_are_called_simulated(sound):
    document = Comparisons((sound,), FILE).document()
    (table,) = document.blocks
    assert isinstance(table, Table)
    assert table.heads == (
        "joint",
        "proved [°]",
        "simulated [°]",
        "peak, simulated [°]",
        "dry friction [N·m]",
    )
    assert [(row[0], row[-1]) for row in table.rows] == [("shoulder", "7.17"), ("elbow", "1.734")]
    for row, error in zip(table.rows, sound.rest, strict=True):
        exact = math.degrees(error or 0)
        assert exact <= float(row[1]) <= 1.001 * exact
    assert document.lead == ("simulated: not within 10° of the goal in 2 s",)


@pytest.mark.parametrize(
    ("unlike", "ideal"),
    [
        ({"unknown": (Check("holds", 0),)}, "all gravity known"),
        ({"sampled": True}, "infinite rate"),
        ({"unknown": (Check("holds", 0),), "sampled": True}, "all gravity known and infinite rate"),
    ],
)
def test_runs_that_leave_out_what_the_file_has_say_so(sound, unlike, ideal):
    assert Comparisons((replace(sound, **unlike),), FILE).document().lead == (
        f"simulated with {ideal}: not within 10° of the goal in 2 s",
    )


def test_a_file_with_a_rate_is_simulated_without_it(tmp_path):
    file = tmp_path / "gains.toml"
    gains = Path(FILE.path).read_text(encoding="utf-8")
    file.write_text(gains.replace("[[gains]]", "[loop]\nrate = 1000\n\n[[gains]]", 1), encoding="utf-8")
    text = lyapcheck("bounds", str(file), "--time", "0.2").stdout
    assert "simulated with infinite rate: " in " ".join(text.split())


def test_gain_sets_are_judged_one_by_one_at_their_lines(compared):
    passed, missing = compared.annotations()
    assert [one.level for one in (passed, missing)] == ["passed", "undecided"]
    reason = compared.results[1].reason
    assert reason == "k_p = 1.7 N·m of elbow does not exceed its dry friction of 1.734 N·m: raise k_p"
    assert reason in missing.message
    assert reason in " ".join(str(compared).split())
    lines = Path(FILE.path).read_text(encoding="utf-8").splitlines()
    for one in (passed, missing):
        assert lines[one.line - 1 : one.line + 1] == ["[[gains]]", f'name = "{one.group}"']


def test_a_record_is_a_gain_set(compared):
    sound, weak = compared.records()
    assert (sound["name"], weak["name"]) == ("tau_m1", "tau_m2")
    assert weak["disturbance"]["rest"][1] is None
    for degrees, error in zip(sound["disturbance"]["rest"], compared.results[0].rest, strict=True):
        assert degrees >= math.degrees(error or 0)
    assert "-0.0" not in compared.written("csv")


def test_without_a_number_for_friction_nothing_is_proved():
    asked = FILE.gains[0], load("pelican2"), TASK, DELTA
    result = compare(*asked)
    assert result.rest == (None, None)
    assert "nothing is known of the dry friction of shoulder, elbow; give --friction" in result.reason
    assert compare(*asked, (F(1), F(0))).rest[1] == 0


def test_only_a_joint_of_unknown_friction_has_no_bound(sound):
    known = load(ARM)
    half = replace(known, coulomb=(None, known.coulomb[1]))
    result = compare(FILE.gains[0], half, TASK, DELTA)
    assert result.rest == (None, sound.rest[1])
    assert not result.proved
    assert result.reason.startswith("nothing is known of the dry friction of shoulder; give --friction")
    assert Comparisons((result,)).document().title.endswith("no error at rest is proved for shoulder")
    light = compare(FILE.gains[0], half, TASK, DELTA, record=LoopRecord(gravity_error=F(1, 100)))
    assert [error is None for error in light.unknown_degrees] == [True, False]
    ends = running_sentences(light.unknown, light.joints)[0].split(": ")[-1]
    assert "(without dry friction), elbow" in ends


def test_an_unbounded_function_is_refused():
    pd = GainSet("pd", None, (F(20), F(5)), (F(1), F(1)), family="linear")
    with pytest.raises(InputError, match=r"unbounded h.*choose gains of a bounded family"):
        compare(pd, load(ARM), TASK, DELTA)


def test_the_command_writes_what_recheck_accepts(tmp_path):
    asked = (
        "bounds",
        GAINS,
        "--robot",
        ARM,
        "--target",
        "45,45",
        "--time",
        "0.1",
        "--certificates",
        tmp_path,
    )
    made = lyapcheck(*asked, "--format", "json")
    assert made.returncode == 0
    shown = json.loads(made.stdout)["results"]
    assert sorted(path.name for path in tmp_path.iterdir()) == [f"tau_m{m}.resting.json" for m in (1, 2, 3)]
    judged = json.loads(lyapcheck("recheck", tmp_path, "--format", "json").stdout)
    said = {row["statement"] for row in judged["certificates"] if row["accepted"]}
    assert said == {row["disturbance"]["rest_statement"] for row in shown}
    weak = lyapcheck(*asked, "--friction", "1,6")
    assert weak.returncode == 3
    assert "does not exceed its dry friction of 6 N·m: raise k_p" in " ".join(weak.stdout.split())


@pytest.mark.parametrize(
    ("robot", "words", "told"),
    [
        ("buap3", (), "for dry friction as the arm file assumes it"),
        ("buap3", ("--friction", "1,1,1"), ""),
        ("reyes-kelly2", (), ""),
        ("reyes-kelly2", ("--friction", "0,0"), "without any dry friction"),
    ],
)
def test_the_headline_says_of_which_dry_friction_the_bound_is(tmp_path, robot, words, told):
    n = 3 if robot == "buap3" else 2
    gains = f'robot = "{robot}"\n[[gains]]\nname = "a"\nm = 1\nkp = {[20] * n}\nkv = {[1] * n}\n'
    (tmp_path / "g.toml").write_text(gains, encoding="utf-8")
    second = lyapcheck("bounds", "g.toml", "--time", "0.1", *words, folder=tmp_path).stdout.splitlines()[1]
    assert second.strip() == told or (not told and second.startswith("  simulated: "))


# --- What the motors, the encoders and a partly known arm file take away from a bound.

HELD = (F("0.03"), F("1.6"))
"""N·m, less dry friction than the arm has, so that only its motors matter."""


def test_a_motor_that_gravity_and_friction_may_hold_at_its_limit_has_no_bound():
    """The shoulder rests at any error with q1 = 90°: τmax = k_g + f holds it there."""
    gains, arm = FILE.gains[0], load(ARM)
    gravity = model_limits(arm).gravity
    at_limit = tuple(k + f for k, f in zip(gravity, HELD, strict=True))
    above = tuple(x + F(1, 1000) for x in at_limit)
    held = compare(gains, arm, TASK, DELTA, HELD, motors=at_limit)
    assert held.rest == (None, None)
    assert "may hold shoulder, elbow anywhere, with its motor at its limit" in held.reason
    assert None not in compare(gains, arm, TASK, DELTA, HELD, motors=above).rest


def test_a_load_that_a_motor_does_not_lift_is_not_held():
    """10 % of gravity more than the controller knows: k_p would do, the motor may not."""
    gains, arm = FILE.gains[0], load(ARM)
    gravity, record = model_limits(arm).gravity, LoopRecord(gravity_error=F(1, 10))
    weak = tuple(F(11, 10) * k + f for k, f in zip(gravity, HELD, strict=True))
    strong = tuple(x + F(1, 1000) for x in weak)
    held = compare(gains, arm, TASK, DELTA, HELD, motors=weak, record=record)
    assert [check.verdict for check in held.unknown] == ["undecided", "undecided"]
    assert "may hold shoulder with its motor at its limit" in held.unknown[0].reason
    assert None not in held.rest
    assert compare(gains, arm, TASK, DELTA, HELD, motors=strong, record=record).proved


def test_a_coarse_encoder_is_left_out_in_words():
    """The arm of `init` with 64 counts a turn ends 2.69° off in the simulation, and 2.294° are proved."""
    gains, arm = FILE.gains[0], load(ARM)
    coarse = compare(gains, arm, TASK, DELTA, record=LoopRecord(encoder=64, gravity_error=F(1, 100)))
    fine = compare(gains, arm, TASK, DELTA, record=LoopRecord(gravity_error=F(1, 100)))
    for result, said in ((coarse, True), (fine, False)):
        document = Comparisons((result,), FILE).document()
        assert ("with exact readings, proved" in document.title) == said
        sentences = comparison_data(result)["disturbance"]["unknown"]
        assert all(text.endswith("with exact readings") == said for text in sentences)
