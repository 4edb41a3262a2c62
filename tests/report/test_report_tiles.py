"""The first screen about one's own arm: what each tile says, what to do, and the arm as it is drawn."""

from __future__ import annotations

import json
import re
import shlex
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from lyapcheck import robots
from lyapcheck.answers.gate.judge import judged_sets
from lyapcheck.control.gains import read_gain_file
from lyapcheck.report.model import Report
from lyapcheck.report.page import markup, raw, to_do
from lyapcheck.report.tiles import drawn_motions, tiles, with_before
from lyapcheck.robots.numeric import NumericModel
from tests.helpers import command
from tests.helpers.arm_texts import ONE_JOINT
from tests.helpers.words_of_proof import GUARDED, promises_as_seen

RUN = {"robot": "reyes-kelly2", "overshoot": [3.0, 0.0], "settling": [1.2, 0.9], "time": 5.0}
RUN |= {"complete": True, "start": [0.0, 0.0], "target": [45.0, 45.0]}
KEYS = ("Motors", "Stability", "Sampling rate", "Behaviour", "Dry friction", "Assumed")


def told(tmp_path, kp="[41.089, 5.618]", kv="[17.61, 2.112]", more="", run=RUN, robot="reyes-kelly2"):
    file = tmp_path / "g.toml"
    file.write_text(f'robot = "{robot}"\n{more}[[gains]]\nname = "g"\nm = 1\nkp = {kp}\nkv = {kv}\n')
    (result,) = judged_sets(read_gain_file(file))
    known = tiles(result, robots.load(robot), SimpleNamespace(**run) if run else None)
    return {one.subject: one for one in known}


def test_six_tiles_answer_what_an_engineer_asks(tmp_path):
    found = told(tmp_path)
    under, said = told(tmp_path, more="[bounds]\nviscous_min = 0.1\n"), " under [bounds]"
    assert all(said in under[key].text and said not in found[key].text for key in KEYS[:2])
    assert (tuple(found), found["Motors"].number[-12:]) == (KEYS, "% in reserve")
    assert found["Stability"].number == "stable"
    assert "infinite rate" in found["Stability"].text
    assert found["Behaviour"].number == "3 % overshoot, settled in 1.2 s"
    assert (found["Assumed"].number, found["Assumed"].tone) == ("0 of 12 numbers", "good")


def test_gains_that_saturate_are_red_and_say_how_far_to_lower_them(tmp_path):
    motors = told(tmp_path, kp="[400, 5]")["Motors"]
    assert motors.tone == "bad"
    words, command = motors.todo
    largest = float(re.search(r"shoulder (\d+\.?\d*)", words)[1])
    again = told(tmp_path, kp=f"[{largest - 18}, 5]")["Motors"]
    assert again.tone in ("good", "warn")
    assert command.startswith("lyapcheck gate ")


def test_without_a_rate_the_tile_asks_for_one_and_with_one_it_judges(tmp_path):
    assert told(tmp_path)["Sampling rate"].todo[1].endswith("--rate 1000")
    slow = told(tmp_path, more="[loop]\nperiod = '60 ms'\n")["Sampling rate"]
    assert slow.number == "60 ms: unstable" or slow.tone in ("bad", "open")
    small = told(tmp_path, kp="[5, 1]", kv="[0.05, 0.02]", more="[loop]\nrate = 1000\n")["Sampling rate"]
    assert "unstable" not in small.number


def test_a_motion_of_the_ideal_loop_says_little_of_one_that_a_computer_runs(tmp_path):
    assert told(tmp_path)["Behaviour"].tone == "good"
    slow = told(tmp_path, more="[loop]\nrate = 50\n")["Behaviour"]
    assert slow.tone == "warn"
    assert "at an infinite rate" in slow.text
    assert slow.todo[1] == f"lyapcheck simulate {tmp_path / 'g.toml'}"


def test_dry_friction_that_holds_a_joint_anywhere_is_red(tmp_path):
    assert told(tmp_path, kp="[5, 1]", kv="[0.1, 0.1]")["Dry friction"].tone == "bad"


def test_commands_name_an_arm_by_its_file(tmp_path):
    """Its name alone, that of the file without its end, is none that a command finds."""
    path = Path(__file__).parents[2] / "examples" / "px100.toml"
    known = told(tmp_path, kp="[1, 1, 1, 1]", kv="[1, 1, 1, 1]", run=None, robot=str(path))
    assert known["Assumed"].todo[1] == f"lyapcheck robot {path} --assumptions"


def of_links(tmp_path, kp, kv, more="", viscous=0.5, torque=10, arm=""):
    path = tmp_path / "arm.toml"
    path.write_text(ONE_JOINT.format(viscous=viscous, torque=torque, more=arm), encoding="utf-8")
    return told(tmp_path, f"[{kp}]", f"[{kv}]", more, None, str(path))


def test_a_payload_that_the_controller_does_not_know_counts_with_dry_friction(tmp_path):
    """Of ±0.1 N·m of friction and 1 kg at 0.1 m, which k_p = 4 N·m holds and k_p = 0.5 N·m does not."""
    friction, load = "coulomb = 0.1", "[loop]\nunknown_payload = 1\n"
    far = [of_links(tmp_path, 4, 1, more, arm=friction)["Dry friction"] for more in ("", load)]
    assert far[0].number == "up to 1.433°"
    assert far[1].number == f"up to {np.degrees(np.arctanh(1.081 / 4)):.2f}°"
    assert far[1].tone == "warn"
    tiles_ = of_links(tmp_path, 0.5, 1, load, arm=friction)
    assert (tiles_["Dry friction"].number, tiles_["Dry friction"].tone) == ("joint falls", "bad")
    (end,) = [frame[-1] for frame in tiles_["Dry friction"].posture[0].frames]
    assert np.allclose(np.abs(end), (0.1, 0), atol=1e-3)  # the link lies level, where it is heaviest
    assert tiles_["Stability"].tone == "warn"
    assert "knows all gravity" in tiles_["Stability"].text


def test_an_error_at_rest_is_asked_for_where_dry_friction_is_known(tmp_path):
    wide = RUN | {"overshoot": [50.0]}
    for friction in ("", "coulomb = 0.1"):
        path = tmp_path / "arm.toml"
        path.write_text(ONE_JOINT.format(viscous=0.5, torque=10, more=friction), encoding="utf-8")
        words = told(tmp_path, "[4]", "[1]", run=wide, robot=str(path))["Behaviour"].todo[1]
        assert ("--rest-error 5" in words) == bool(friction)


def test_stable_is_said_with_what_it_supposes(tmp_path):
    assert of_links(tmp_path, 4, 1)["Stability"].number == "stable"
    over = of_links(tmp_path, 20, 1)["Stability"]
    assert (over.number, over.tone) == ("stable while no motor saturates", "warn")
    mass = "viscous = {value = 0.5, low = 0.4, high = 0.6}"
    ranged = of_links(tmp_path, 4, 1, viscous=mass.removeprefix("viscous = "))["Stability"]
    assert "at nominal numbers" in ranged.text
    assert ranged.number == "stable at nominal numbers"


def test_gains_that_are_accepted_by_torque_alone_are_not_called_stable_by_19(tmp_path):
    """Without viscous friction (19) admits no gains, whatever else the file asks for."""
    only = 'condition = ["10i"]\n'
    path = tmp_path / "g.toml"
    for viscous in (0, 0.5):
        of_links(tmp_path, 4, 1, viscous=viscous)
        path.write_text(path.read_text(encoding="utf-8") + only, encoding="utf-8")
        (result,) = judged_sets(read_gain_file(path))
        assert result.verdict == "accepted"
        stability = tiles(result, robots.load(str(tmp_path / "arm.toml")), None)[1]
        assert "(19)" not in stability.text


@pytest.mark.slow
def test_commands_to_do_are_about_the_files_of_the_user(tmp_path):
    name = "<b>&'\" $(x).toml"
    arm = tmp_path / name
    arm.write_text(ONE_JOINT.format(viscous=0.5, torque=10, more="coulomb = 3"), encoding="utf-8")
    path = tmp_path / f"gains of {name}"
    sets = '[[gains]]\nname = "g"\nm = 1\nkp = [9]\nkv = [2]\n'
    path.write_text(f"robot = {json.dumps(name)}\n{sets}", encoding="utf-8")
    file = read_gain_file(path)
    (result,) = judged_sets(file)
    known = tiles(result, robots.load(file.robot), SimpleNamespace(**RUN))
    commands = [one.todo[1] for one in known if one.todo[1]]
    assert len(commands) == 3
    for words in map(shlex.split, commands):
        assert words[0] == "lyapcheck"
        assert Path(words[2]) in (arm, path)
        done = command.lyapcheck(*words[1:], folder=tmp_path)
        assert done.returncode != 2, done.stderr


def test_words_of_proof_come_from_promises_alone(tmp_path):
    with promises_as_seen():
        for one in told(tmp_path).values():
            assert not GUARDED.search(f"{one.number} {one.text}".replace("proved from rest", "")), one


def test_the_older_answer_stands_in_the_tile_where_it_was_another(tmp_path):
    known = told(tmp_path)
    report = blank(tiles={"g": tuple(known.values())})
    old = {"tiles": [{"gains": "g", "subject": "Assumed", "number": "1 of 2 numbers"}]}
    changed = {one.subject: one.before for one in with_before(report, old).tiles["g"]}
    assert changed == dict.fromkeys(KEYS, "") | {"Assumed": "1 of 2 numbers"}


def blank(**known):
    return Report(
        **(dict.fromkeys(Report.__dataclass_fields__) | {"motions": {}, "own": True, "gate": ()} | known)
    )


def first_screen(report):
    return markup("own.html", report=report, todo=to_do(report))


def test_each_step_to_do_stands_once_and_what_is_wrong_first(tmp_path):
    known = tuple(told(tmp_path, kp="[400, 5]").values())
    page = first_screen(blank(tiles={"a": known, "b": known}))
    steps = re.findall(r"<li>(.*?): .*?<code>(.*?)</code>", page)
    assert steps[0][0] == "a, Motors; b, Motors"
    commands = [command for _, command in steps]
    assert len(commands) == len(set(commands)) > 1


def test_the_arm_is_drawn_where_its_links_are():
    """The last joint moves the last body alone, so that m g Δz of its centre is the integral of g_n."""
    arm = robots.load("examples/px100.toml").fixed()
    q, turn = np.random.default_rng(0).uniform(-2, 2, (40, arm.n)), 0.2 * np.eye(arm.n)[-1]
    heights = [
        np.array([frame[-1][1] for frame in drawn_motions(arm, np.arange(40.0), at)[0].frames])
        for at in (q, q + turn)
    ]
    gravity = [NumericModel(arm).gravity(q + share * turn)[:, -1] for share in (0, 0.5, 1)]
    work = 0.2 / 6 * (gravity[0] + 4 * gravity[1] + gravity[2])
    weight = float(arm.chain.links[-1].mass) * np.linalg.norm([float(x) for x in arm.chain.fall])
    assert np.allclose(weight * (heights[1] - heights[0]), work, atol=3e-4 * weight)
    assert np.abs(work).max() > 1e-2


def test_who_wants_no_motion_sees_start_and_goal():
    model = robots.load("examples/ur5.toml")
    q = np.linspace(0, 0.8, 50)[:, None] * np.ones(6)
    motions = drawn_motions(model, np.linspace(0, 5, 50), q)
    page = first_screen(blank(tiles={"g": ()}, motions={"g": motions}))
    assert page.count("<polyline") == len(motions[0].frames) + 2
    assert "prefers-reduced-motion:reduce" in raw("style.css")


def test_an_arm_without_links_has_a_dial_for_each_joint():
    model = robots.load("reyes-kelly2")
    q = np.linspace([0.5, -1], [2, 7], 30)
    dials = drawn_motions(model, np.linspace(0, 3, 30), q)
    assert [one.joint for one in dials] == ["shoulder", "elbow"]
    ends = np.array([[frame[-1] for frame in one.frames] for one in dials])
    seen = np.unwrap(np.arctan2(ends[..., 1], ends[..., 0]), axis=-1)
    assert np.allclose(seen, q.T, atol=1e-12)
    page = first_screen(blank(tiles={"g": ()}, motions={"g": dials}))
    assert page.count('class="face"') == 2
    assert "do not have the lengths" in page
    assert "<rect" not in page


def test_a_posture_that_fails_is_drawn_for_an_arm_without_links_too(tmp_path):
    rate = told(tmp_path, more="[loop]\nperiod = '60 ms'\n", robot="buap3", kp="[25, 50, 5]", kv="[3, 6, 1]")
    assert [one.joint for one in rate["Sampling rate"].posture] == ["base", "shoulder", "elbow"]


def test_a_payload_on_an_arm_without_links_asks_for_its_links(tmp_path):
    more = "[loop]\nrate = 200\nunknown_payload = 1\n"
    known = told(tmp_path, more=more)
    assert known["Dry friction"].number == "no bound"
    assert known["Dry friction"].text.startswith("An unknown payload needs the links")
    assert known["Dry friction"].todo == ("Give the arm by its links.", "")
    assert known["Sampling rate"].text.startswith("No proof and no counterexample at 5 ms. ")
