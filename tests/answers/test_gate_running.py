"""The gate on the loop as it is run: `sampled` and `holds`, what they count for and how they are said."""

from __future__ import annotations

import json
import math
import re
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lyapcheck import robots
from lyapcheck.answers.gate import GateResult, accepting, gate
from lyapcheck.answers.running.holds import HoldsCheck
from lyapcheck.answers.running.sampled import AsRun, SampledCheck
from lyapcheck.control.conditions import Check
from lyapcheck.control.gains import GainSet, read_gain_file
from lyapcheck.control.limits import arm_limits, model_limits
from lyapcheck.control.sampling import LoopRecord
from lyapcheck.files.loop import NOTHING, LoopEntry
from lyapcheck.output.answer import JUDGED_FORMATS
from lyapcheck.robots.fields import Vary
from lyapcheck.robots.numeric import NumericModel
from lyapcheck.robots.vary import varied
from tests.helpers.arm_texts import ONE_JOINT, arm_of
from tests.helpers.command import invoke
from tests.helpers.shares import one_in
from tests.helpers.words_of_proof import left_over

EXAMPLES = Path(__file__).parents[2] / "examples"
PRINTED = "[bounds]\nviscous_min = 0.406\ntorque = [50, 150, 15]\ngravity = [0, 40.28, 1.81]\n"
TABLE2 = {1: ((28, 60, 5), "0.233"), 2: ((27, 50, 5), "0.223"), 3: ((25, 50, 5), "0.223")}
RHO_L = {1: (1.0, 1.0), 2: (1.674609, 0.867350), 3: (2.631608, 0.969723)}
"""By other code, to six digits."""


def paper(folder: Path, m: int, more: str = "") -> Path:
    """The paper's gains with its printed numbers, and no arm."""
    kp, kv = TABLE2[m]
    file = folder / f"m{m}.toml"
    gains = f'[[gains]]\nname = "a"\nm = {m}\nkp = {list(kp)}\nkv = [{kv}, {kv}, {kv}]\n'
    file.write_text(f"{more}\n{gains}{PRINTED}")
    return file


def judged(file: Path, loop: LoopEntry, deciding: tuple[str, ...] | None = None, **more: Any) -> GateResult:
    (result,) = gate(read_gain_file(file), deciding=deciding, loop=loop, **more)
    return result


def only(result: GateResult, name: str) -> list[Check]:
    return [check for check in result.checks if check.id == name]


def sampled(file: Path, **loop: Any) -> SampledCheck:
    (check,) = only(judged(file, LoopEntry(**loop)), "sampled")
    assert isinstance(check, SampledCheck)
    return check


T = Fraction(1, 400)


@pytest.mark.parametrize(("m", "most"), [(1, 3.389), (2, 3.379), (3, 2.185)])
def test_the_periods_of_the_printed_numbers(tmp_path: Path, m: int, most: float) -> None:
    """As a page of its own computes them: m = 1, 2 at 2.5 ms, m = 3 not; none with a sample of delay."""
    check = sampled(paper(tmp_path, m), period=T, delay=0)
    assert check.limit is not None
    assert float(1000 * check.limit.lower) == pytest.approx(most, abs=6e-4)
    assert check.verdict == ("undecided" if m == 3 else "accepted")
    assert sampled(paper(tmp_path, m), period=T).verdict == "undecided"
    # the formula, written down once more
    (rho, L), (kp, kv) = RHO_L[m], TABLE2[m]
    gamma = [0, 40.28 + 1.81, 1.81 + 1.81]
    ends = [2 * (0.406 - L * float(kv)) / (rho * k + g) for k, g in zip(kp, gamma, strict=True)]
    assert float(check.limit.lower) == pytest.approx(min(ends), rel=1e-5)
    assert check.joint == ends.index(min(ends))


def test_what_is_said_of_periods_holds_at_each(tmp_path: Path) -> None:
    """Intervals of 2.8 ms beside 0.1 ms are 28 T: a multiple of T is shown, and of exact readings."""
    loop: dict[str, Any] = {"longest": Fraction(28, 10_000), "encoder": 4}
    for period, how in ((T, "2.5 ms, no interval above 2.8 ms, no"), (Fraction(2, 1000), "no")):
        (said,) = sampled(paper(tmp_path, 1), period=period, delay=0, **loop).sentences(False)
        assert said.startswith(
            f"as run ({how} delay, velocity by differences): it is stable with exact readings"
        )
        assert f", no interval above {float(Fraction(28, 10_000) / period):g} times it" in said


REFUSED = [
    ({"velocity": "measured"}, "measured"),
    ({"lowpass": Fraction(50)}, "lowpass"),
    ({"period": None, "unknown_payload": Fraction(1)}, "no period is known"),
]


@pytest.mark.parametrize(("loop", "reason"), REFUSED)
def test_what_is_not_covered_is_undecided_and_says_why(
    tmp_path: Path, loop: dict[str, Any], reason: str
) -> None:
    result = judged(paper(tmp_path, 1), LoopEntry(**({"period": T} | loop)), ("10p", "sampled"))
    (check,) = only(result, "sampled")
    assert (check.verdict, result.verdict) == ("undecided", "undecided")
    assert reason in check.reason


def test_it_is_shown_and_decides_where_it_is_asked_for(tmp_path: Path) -> None:
    shown = judged(paper(tmp_path, 1), LoopEntry(period=T, delay=1))
    assert (only(shown, "sampled")[0].verdict, shown.verdict) == ("undecided", "accepted")
    file = paper(tmp_path, 1, 'condition = ["10p", "sampled"]')
    assert judged(file, LoopEntry(period=T, delay=1)).verdict == "undecided"
    assert judged(file, LoopEntry(period=T, delay=0)).verdict == "accepted"
    assert judged(file, NOTHING).verdict == "undecided"  # no rate is known


def test_it_counts_only_where_no_motor_saturates(tmp_path: Path) -> None:
    file = paper(tmp_path, 1)
    loop = LoopEntry(period=T, delay=0)
    assert judged(file, loop, ("sampled",)).verdict == "accepted"
    file.write_text(file.read_text().replace("[50, 150, 15]", "[50, 80, 15]"))
    result = judged(file, loop, ("sampled",))
    (check,) = only(result, "sampled")
    assert result.verdict_of(("10i",)) == "rejected"
    assert (check.verdict, result.verdict) == ("undecided", "undecided")
    assert "no motor saturates" in check.reason


def test_light_wrists_are_refuted_at_a_posture(tmp_path: Path) -> None:
    """Gains by proof on the iiwa: k_v = 26 N·m·s/rad on a wrist of 0.001 kg·m², one sample late at 1 kHz."""
    file = tmp_path / "iiwa.toml"
    kp, kv = [79.3, 65, 75, 75, 79, 79, 79], [34, 27.9, 32.2, 32.3, 26.1, 26.1, 26.1]
    file.write_text(f'robot = "iiwa14"\n[[gains]]\nname = "a"\nm = 1\nkp = {kp}\nkv = {kv}\n')
    answer = gate(read_gain_file(file), deciding=("10i",), loop=LoopEntry(period=Fraction(1, 1000)))
    (check,) = only(answer[0], "sampled")
    assert (check.verdict, answer[0].verdict, answer.exit_code) == ("rejected", "rejected", 1)
    assert "unstable at 1 ms, at the goal q_d = (" in " ".join(str(answer).split())


@pytest.mark.parametrize(("name", "falls"), one_in(2, [("xarm6", {1, 2}), ("panda", {1, 4}), ("ur5", set())]))
def test_two_kilograms_that_the_controller_does_not_know(name: str, falls: set[int]) -> None:
    """As MuJoCo has it: xarm6 and Panda fall, the UR5 holds. Δg is the difference of two arms here."""
    file = read_gain_file(EXAMPLES / f"{name}_gains.toml")
    arm = robots.load(EXAMPLES / f"{name}.toml")
    loaded = varied(arm, (Vary("payload", Fraction(2), Fraction(2)),))
    q = np.random.default_rng(3).uniform(-math.pi, math.pi, (20_000, arm.n))
    seen = np.abs(NumericModel(loaded).gravity(q) - NumericModel(arm).gravity(q)).max(axis=0)
    first = gate(file, loop=LoopEntry(unknown_payload=Fraction(2)))[0]
    checks = {check.joint: check for check in only(first, "holds") if isinstance(check, HoldsCheck)}
    assert {i for i, check in checks.items() if check.verdict == "rejected"} == falls
    for i, check in checks.items():
        assert i is not None
        assert check.value is not None
        assert seen[i] <= float(check.value - check.friction) + 1e-9
        if check.verdict == "rejected":
            assert float(check.reached) > float(first.gains.kp[i]) + float(check.friction)
            assert float(check.reached) <= float(check.value)
        else:  # m = 1: h(x) = tanh x
            ratio = float(check.value / first.gains.kp[i])
            assert check.error is not None
            assert float(check.error) == pytest.approx(math.atanh(ratio), rel=1e-3)
            assert float(check.error) >= math.atanh(ratio)
    still = {i for i in range(arm.n) if i not in checks}
    assert all(seen[i] < 1e-9 for i in still)
    assert first.verdict == ("rejected" if falls else "accepted")


def pendulum(folder: Path, m: int, kp: str) -> Path:
    """Its link of 1 m has its centre of mass at the end."""
    link = ("pivot", (0, 1, 0), (0, 0, 0), 1, (0, 0, -1), 1, 1, {"torque_limit": 100})
    (folder / "arm.toml").write_text(arm_of(link, gravity=(0, 0, -10)))
    file = folder / "gains.toml"
    file.write_text(f'robot = "arm.toml"\n[[gains]]\nname = "a"\nm = {m}\nkp = [{kp}]\nkv = [0.1]\n')
    return file


HELD = [
    (1, "10.001", LoopEntry(unknown_payload=Fraction(1)), "accepted"),
    (1, "10", LoopEntry(unknown_payload=Fraction(1)), "undecided"),
    (1, "9.99", LoopEntry(unknown_payload=Fraction(1)), "rejected"),
    (3, "9.5", LoopEntry(unknown_payload=Fraction(1)), "undecided"),  # γ_3 = 1.114
    (3, "8.9", LoopEntry(unknown_payload=Fraction(1)), "rejected"),
    (1, "1.01", LoopEntry(gravity_error=Fraction(1, 10)), "accepted"),
    (1, "0.99", LoopEntry(gravity_error=Fraction(1, 10)), "rejected"),
    (1, "11.01", LoopEntry(unknown_payload=Fraction(1), gravity_error=Fraction(1, 10)), "accepted"),
    (1, "10.5", LoopEntry(unknown_payload=Fraction(1), gravity_error=Fraction(1, 10)), "undecided"),
]


@pytest.mark.parametrize(("m", "kp", "loop", "verdict"), HELD)
def test_a_pendulum_at_the_border(tmp_path: Path, m: int, kp: str, loop: LoopEntry, verdict: str) -> None:
    """|Δg| is at most 10 N·m a kilogram, and 1 N·m for a tenth of its own gravity."""
    result = judged(pendulum(tmp_path, m, kp), loop, ("10i", "holds"))
    (check,) = only(result, "holds")
    assert (check.verdict, result.verdict) == (verdict, verdict)


def test_both_states_of_rest_are_told(tmp_path: Path) -> None:
    """h_3(e) = 1.05 at 62° and 106°."""
    result = judged(pendulum(tmp_path, 3, "9.5238"), LoopEntry(unknown_payload=Fraction(1)))
    (check,) = only(result, "holds")
    assert "62.1° and at 106°" in check.reason


def test_friction_counts_to_what_is_asked(tmp_path: Path) -> None:
    file = pendulum(tmp_path, 1, "11")
    arm = tmp_path / "arm.toml"
    for friction, verdict in (("0.9", "accepted"), ("1.1", "undecided")):
        arm.write_text(arm.read_text().partition("coulomb")[0] + f"coulomb = {friction}\n")
        assert only(judged(file, LoopEntry(unknown_payload=Fraction(1))), "holds")[0].verdict == verdict


def test_what_pulls_at_no_joint_is_held(tmp_path: Path) -> None:
    file, arm = pendulum(tmp_path, 1, "1"), tmp_path / "arm.toml"
    arm.write_text(arm.read_text().replace("[0, 0, -10]", "[0, -10, 0]"))
    result = judged(file, LoopEntry(unknown_payload=Fraction(5)), ("10i", "holds"))
    (check,) = only(result, "holds")
    assert isinstance(check, HoldsCheck)
    assert (check.error, result.verdict) == (0, "accepted")


def test_a_printed_model_has_no_place_for_a_payload(tmp_path: Path) -> None:
    file = tmp_path / "gains.toml"
    file.write_text('robot = "reyes-kelly2"\n[[gains]]\nname = "a"\nm = 1\nkp = [9, 9]\nkv = [0.1, 0.1]\n')
    (check,) = only(judged(file, LoopEntry(unknown_payload=Fraction(1))), "holds")
    assert "needs the links" in check.reason


WORDS = ("--rate", "500", "--unknown-payload", "1")


def test_every_format_says_it() -> None:
    asked = LoopEntry(period=Fraction(1, 500), unknown_payload=Fraction(1))
    answer = gate(read_gain_file(EXAMPLES / "panda_gains.toml"), loop=asked)
    assert answer.exit_code == 1
    for form in JUDGED_FORMATS:
        assert "panda_joint2 falls" in " ".join(answer.written(form).replace("\\_", "_").split()), form


def test_data_and_certificates(tmp_path: Path) -> None:
    words = ("gate", str(EXAMPLES / "ur5_gains.toml"), *WORDS, "--certificates", str(tmp_path / "made"))
    done = invoke(*words, "--condition", "10p", "--condition", "sampled", "--format", "json")
    assert done.exit_code == 0, done.stderr
    checks = json.loads(done.stdout)["results"][0]["checks"]
    (row,) = [row for row in checks if row["id"] == "sampled"]
    assert row["value"] == "0.002"
    assert row["verdict"] == "accepted"
    assert float(row["margin"]) == pytest.approx(float(row["limit"]["lower"]) - 0.002)
    assert 0.002 < float(row["largest_admissible"]) < float(row["limit"]["lower"])
    files = sorted(tmp_path.glob("made/*.json"))
    assert {"sampled", "holds"} <= {file.name.split(".")[1] for file in files}
    assert invoke("recheck", *map(str, files)).exit_code == 0


@pytest.mark.parametrize("name", one_in(2, ["ur5", "panda"]))
def test_words_of_proof_are_those_of_promises(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    assert left_over(("gate", str(EXAMPLES / f"{name}_gains.toml"), *WORDS), monkeypatch) == []


MS, DRY = Fraction(1, 1000), r"\[joints\.coulomb\]\n(?:\w.*\n)*"
RANGE = r"\n(?:assumed|low|high|note) = .*"


@pytest.mark.parametrize(("period", "advised"), [("0.001", True), ("0.05", False)])
def test_no_conditions_are_advised_by_which_the_gate_would_reject_again(
    tmp_path: Path, period: str, advised: bool
) -> None:
    """An unstable loop is rejected whatever decides: here by (10p) and (19), which fails."""
    (tmp_path / "arm.toml").write_text(ONE_JOINT.format(viscous="0.3", torque=40, more=""))
    file = tmp_path / "gains.toml"
    file.write_text('robot = "arm.toml"\n[[gains]]\nname = "a"\nm = 1\nkp = [10]\nkv = [3]\n')
    answer = gate(read_gain_file(file), loop=LoopEntry(period=Fraction(period)))
    assert answer[0].verdict == "rejected"
    assert bool(accepting(answer[0])) is advised
    assert ("--condition" in str(answer)) is advised


def by_proof(folder: Path, removed: str) -> Path:
    """Gains with k_v above the friction, and the arm's file without what is removed."""
    text = (Path(robots.__file__).parent / "arms" / "reyes-kelly2.toml").read_text()
    (folder / "arm.toml").write_text(re.sub(removed, "", text))
    file, gains = folder / "gains.toml", "kp = [41.089, 5.618]\nkv = [17.61, 2.112]\n"
    file.write_text(f'robot = "arm.toml"\n[[gains]]\nname = "a"\nm = 1\n{gains}')
    return file


def test_from_rest_at_exactly_one_period(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file, made = by_proof(tmp_path, f"{DRY}|{RANGE}"), tmp_path / "made"
    assert "--within" in sampled(file, period=MS).reason
    words = ("gate", str(file), "--rate", "1000", "--within", "90", "--condition", "sampled")
    done = invoke(*words, "--certificates", str(made))
    assert (done.exit_code, done.stdout[0]) == (0, "!")
    assert "sampled at exactly 1 ms, from rest within 90° only" in done.stdout.splitlines()[0]
    (kept,) = made.glob("*sampled*.json")
    asked = json.loads(kept.read_text())["statement"]
    told = [asked[key] for key in ("kind", "period", "within", "delay")]
    assert told == ["SampledFromRest", "1/1000", "90", 1]
    assert invoke("recheck", str(kept)).exit_code == 0
    with_folder, in_file = file.with_name("kept.toml"), file.with_name("in_file.toml")
    with_folder.write_text(f'certificates = "made"\n{file.read_text()}')
    in_file.write_text(f"{with_folder.read_text()}[loop]\nrate = 1000\nwithin = 90\n")
    monkeypatch.setattr("lyapcheck.errors.installed", lambda name: False)
    assert judged(in_file, LoopEntry(), ("sampled",)).verdict == "accepted"
    assert left_over((words[0], str(with_folder), *words[2:]), monkeypatch) == []
    for within, answer in ((None, "accepted"), (45, "accepted"), (91, "undecided")):
        asked_for = None if within is None else Fraction(within)
        found = judged(with_folder, LoopEntry(period=MS, within=asked_for), ("sampled",))
        assert found.verdict == answer
    assert judged(with_folder, LoopEntry(period=MS / 2), ("sampled",)).verdict == "undecided"


NOT_FROM_REST = [
    ("$^", {}, "without dry friction"),
    pytest.param(r"torque_limit = 1.*\n|" + DRY, {}, "no motor saturates", marks=pytest.mark.slow),
    pytest.param(DRY, {"period": 8 * MS}, "no proof", marks=pytest.mark.slow),
    (DRY, {"longest": 2 * MS}, "constant intervals"),
    (DRY, {"filter": (Fraction(1, 2), Fraction(1, 2))}, "without a filter"),
    (DRY, {"gravity_error": Fraction(1, 20)}, "knows g(q)"),
    (DRY, {"delay": 7}, "delays to 6"),
    (DRY, {"within": Fraction(4000)}, "starts to 3600"),
]


@pytest.mark.parametrize(("removed", "loop", "reason"), NOT_FROM_REST)
def test_from_rest_what_is_not_shown_is_undecided(
    tmp_path: Path, removed: str, loop: dict[str, Any], reason: str
) -> None:
    file, loop = by_proof(tmp_path, removed), {"period": MS} | loop
    result = judged(file, LoopEntry(**({"within": Fraction(90)} | loop)), ("sampled",))
    assert result.verdict == "undecided"
    assert reason in only(result, "sampled")[0].reason


@pytest.mark.slow
def test_an_arm_with_ranges_is_shown_from_rest_at_its_nominal_inertia(tmp_path: Path) -> None:
    """Over wide ranges in its file nothing is shown: asked for by --vary they decide."""
    file, loop = by_proof(tmp_path, DRY), LoopEntry(period=MS, within=Fraction(90))
    wide = 'inertia_1 = { value = 2.351, low = 0.5, high = 20, assumed = true, note = "x", '
    arm = tmp_path / "arm.toml"
    arm.write_text(arm.read_text().replace("inertia_1 = { value = 2.351, ", wide))
    (check,) = only(judged(file, loop, ("sampled",)), "sampled")
    assert (check.verdict, check.nominal) == ("accepted", True)
    assert check.narrow == "at exactly 1 ms, from rest within 90°, at the nominal inertia"
    robot = read_gain_file(file).robot
    assert robot is not None
    over = judged(file, loop, ("sampled",), arms={robot: replace(arm_limits(robot), varied=True)})
    assert over.verdict == "undecided"
    assert "no proof from rest within 90° over" in only(over, "sampled")[0].reason


def test_ranges_with_too_many_corners_are_not_tried_on_long_arms(monkeypatch):
    monkeypatch.setattr("lyapcheck.answers.running.sampled.MOST_CORNERS", 1)
    arm = varied(robots.load("px100"), [Vary.parsed("payload=0..0.1")])
    gains = GainSet("a", 1, (Fraction(1),) * arm.n, (Fraction(1),) * arm.n)
    record = LoopRecord(period=MS, within=Fraction(5))
    promise, why = AsRun(gains, model_limits(arm), record, None).from_rest(arm)
    assert promise is None
    assert why == "(P) asks for at most 1 corners of the ranges of so many joints"
