"""The simulate command beyond one set-point run: references, random starts, broken promises."""

from __future__ import annotations

import json
from fractions import Fraction
from types import SimpleNamespace

import numpy as np
import pytest

from lyapcheck.check.certificate import judge, parse, read
from lyapcheck.control.gains import paper_gain_file
from tests.helpers.command import lyapcheck as command
from tests.helpers.shares import one_in

TABLE2, SMALL = (str(paper_gain_file(name)) for name in ("table2", "table2_shoulder_elbow"))
SINE = 'kind = "sine"\namplitude = [20, 30, 40]\nfrequency = [0.5, 0.5, 0.25]\n'


def lyapcheck(*words):
    """What the command simulate leaves."""
    return command("simulate", *words)


@pytest.fixture
def sine(tmp_path):
    place = tmp_path / "sine.toml"
    place.write_text(SINE, encoding="utf-8")
    return place


@pytest.fixture
def single(tmp_path):
    """A gain file with one set, m = 2 on the two-joint arm."""
    place = tmp_path / "single.toml"
    text = 'robot = "reyes-kelly2"\n[[gains]]\nname = "s"\nm = 2\nkp = [40, 5]\nkv = [2, 1]\n'
    place.write_text(text, encoding="utf-8")
    return place


@pytest.fixture
def wave(tmp_path):
    place = tmp_path / "wave.toml"
    place.write_text('kind = "sine"\namplitude = [20, 30]\nfrequency = [0.5, 0.25]\n', encoding="utf-8")
    return place


@pytest.mark.slow
def test_a_reference_is_followed_and_its_promises_stand_beside_what_was_seen(sine):
    done = lyapcheck(TABLE2, "--reference", sine, "--time", 1, "--format", "json", "--start", "5,0,0")
    assert done.returncode == 0
    data = json.loads(done.stdout)
    assert data["schema"] == "lyapcheck/simulate/1"
    assert [result["name"] for result in data["results"]] == ["tau_m1", "tau_m2", "tau_m3"]
    for result in data["results"]:
        promised, seen = result["promised"], result["seen"]
        assert result["kind"] == "tracking"
        assert result["start"] == [5.0, 0.0, 0.0]
        assert seen["reference_speed"] <= promised["reference_speed"]
        assert seen["error_rate"] <= promised["error_rate"]
        assert 0 < seen["tightness"] <= 1
        assert promised["V_falls"] is True
        assert promised["eps0"] < float(promised["largest_eps0"])
        pairs = zip(result["peak_torque"], promised["torque_bound"], strict=True)
        assert all(peak <= bound for peak, bound in pairs)


def test_tracking_in_words(single, wave):
    text = lyapcheck(single, "--reference", wave, "--time", 1, "--band", 5, "-v").stdout
    assert text.startswith("! reyes-kelly2: no bound violated by 1 gain set, without the dry friction")
    assert text.splitlines()[1] == "  tracking (21)"
    assert "dV/dt ≤ −zᵀΘ'z at all 2001 samples" in text
    page = lyapcheck(single, "--reference", wave, "--time", 1, "--band", 5, "--format", "markdown").stdout
    assert "## ✓ s (m = 2): from (0, 0)° in 1 s" in page
    assert "Reference: sine of (20, 30)°" in page
    assert "| within 5° from \\[s\\] |" in page
    assert "| shoulder |" in page


@pytest.mark.slow
def test_figures_of_tracking_have_their_data_beside_them(single, wave, tmp_path):
    place = tmp_path / "plots"
    place.mkdir()
    done = lyapcheck(single, "--reference", wave, "--time", 0.5, "--plot", place, "--csv", "-")
    names = {path.name for path in place.iterdir()}
    figures = {"angles", "errors", "torques", "lyapunov"}
    drawn = {f"s-{figure}.{form}" for figure in figures for form in ("svg", "png")}
    assert names == drawn | {"s.csv"}
    assert (place / "s.csv").read_text() == done.stdout


@pytest.mark.slow
def test_a_broken_promise_leaves_with_1_and_the_state_that_broke_it():
    done = lyapcheck(TABLE2, "--eps0", 50, "--format", "json")
    assert done.returncode == 1
    assert done.stderr.count("violated bound: ") == 3
    assert "confirmed in balls" in done.stderr
    for result in json.loads(done.stdout)["results"]:
        assert result["complete"] is False
        assert result["reached"] == pytest.approx(result["breach"]["t"], abs=1e-9)
        assert result["reached"] < 5
        assert result["breach"]["grade"] == "enclosure"
        assert result["breach"]["value"] > result["breach"]["limit"] == 0.0


@pytest.mark.slow
def test_a_motor_beyond_its_limit_is_a_broken_promise(tmp_path):
    strong = tmp_path / "strong.toml"
    strong.write_text('robot = "buap3"\n[[gains]]\nname = "s"\nm = 1\nkp = [99, 60, 5]\nkv = [1, 1, 1]\n')
    done = lyapcheck(strong, "--format", "json")
    assert done.returncode == 1
    assert "|τ| of base within the motor's limit" in done.stderr
    text = lyapcheck(strong).stdout
    assert text.startswith("✗ buap3: bounds violated by 1 of 1 gain set, without the dry friction of the")
    assert "CUT SHORT at 0 s" in text
    assert lyapcheck(strong, "--experiment", "--time", 0.5).returncode == 0


@pytest.mark.slow
def test_initial_rates_are_degrees_a_second():
    done = lyapcheck(TABLE2, "--velocity", "90,0,-180", "--time", 0.1, "--csv", "-")
    first = done.stdout.splitlines()[1].split(",")
    assert [float(x) for x in first[6:9]] == pytest.approx([np.pi / 2, 0, -np.pi])


@pytest.mark.slow
def test_random_starts_tell_how_the_indices_spread():
    words = ("--runs", 15, "--spread", 30, "--time", 1, "--target", "45,45", "--format", "json")
    done = lyapcheck(SMALL, "--seed", 7, *words)
    assert done.returncode == 0
    for result in json.loads(done.stdout)["results"]:
        assert result["finished"] == result["runs"] == 15
        assert result["V_rose"] == result["beyond_limits"] == 0
        for values in result["quantiles"].values():
            known = [x for x in values if x is not None]
            assert known == sorted(known)
    assert lyapcheck(SMALL, "--seed", 7, *words).stdout == done.stdout
    assert lyapcheck(SMALL, "--seed", 8, *words).stdout != done.stdout


@pytest.mark.parametrize(
    ("file", "target"), one_in(2, [(SMALL, "45,90"), (TABLE2, "45,45,90")]), ids=["two joints", "three"]
)
def test_states_at_which_v_rises_have_certificates(tmp_path, file, target):
    lyapcheck(file, "--target", target, "--time", 0.5, "--eps0", 50, "--certificates", tmp_path)
    certificates = sorted(tmp_path.iterdir())
    assert [path.name for path in certificates] == [f"tau_m{m}.breach.json" for m in (1, 2, 3)]
    for path in certificates:
        certificate = read(parse(path.read_text(encoding="utf-8")))
        assert judge(certificate).verdict == "refuted"
        assert certificate.statement.eps0 == 50


@pytest.mark.slow
def test_a_batch_that_breaks_a_promise_says_where():
    done = lyapcheck(TABLE2, "--runs", 5, "--eps0", 50, "--format", "json")
    assert done.returncode == 1
    assert "confirmed in balls" in done.stderr
    for result in json.loads(done.stdout)["results"]:
        assert result["V_rose"] > 0
        assert result["breach"]["promise"].startswith("dV/dt")


BAD = [
    (["--runs", 0], ["--runs"]),
    (["--runs", 10**9], ["--runs"]),
    (["--runs", 5, "--spread", 1000, "--seed", -1], ["--seed", "--spread"]),
    (["--runs", 5, "--spread", "nan"], ["--spread"]),
    (["--runs", 5, "--plot", "."], ["--plot"]),
    (["--runs", 5, "--experiment"], ["--experiment"]),
    (["--seed", 1, "--spread", 3, "--band", 2], ["--band", "--seed", "--spread"]),
    (["--experiment", "--rate", "400", "--keep-going"], ["--keep-going"] * 2),
    (["--velocity", "1,2"], ["--velocity"]),
    (["--velocity", "1e9,0,0"], ["--velocity"]),
    (["--eps0", "1e300"], ["--eps0"]),
    (["--time", "1e-300"], ["--time"]),
    (["--reference", "SINE", "--target", "1,2,3"], ["--target"]),
    (["--reference", "SINE", "--experiment"], ["--experiment"]),
    (["--reference", "SINE", "--runs", 5], ["--runs"]),
    (["--reference", "SINE", "--band", 0, "--eps0", "nan", "--time", 0], ["--band", "--eps0", "--time"]),
    (["--reference", "no-such-file.toml", "--start", "1"], ["--start", "file"]),
    (["--reference", "."], ["file"]),
]


@pytest.mark.parametrize(("arguments", "keys"), BAD, ids=range(len(BAD)))
def test_every_problem_of_a_command_line_is_told(sine, arguments, keys):
    done = lyapcheck(TABLE2, *(sine if word == "SINE" else word for word in arguments))
    errors = [line for line in done.stderr.splitlines() if line.startswith("error: ")]
    assert done.returncode == 2
    assert done.stdout == ""
    assert len(errors) == len(keys)
    for key, line in zip(keys, errors, strict=True):
        assert f": {key}" in line


@pytest.mark.slow
def test_v_falls_with_the_eps0_that_is_certified(tmp_path):
    """A pendulum with M = ¼ and b = ½ and m = 1: near e = 0, fast, dV/dt ≈ −(b − ε₀ M) w², so ε₀ ≤ 2."""
    file = tmp_path / "pendulum.toml"
    file.write_text('robot = "pendulum1"\n[[gains]]\nname = "p"\nm = 1\nkp = [4]\nkv = [1]\n')
    done = lyapcheck(file, "--eps0", "certified", "--target", "60", "--time", 1, "--format", "json")
    assert done.returncode == 0
    (result,) = json.loads(done.stdout)["results"]
    assert result["V_decreases"] is True
    assert 1.9 < result["eps0"] <= 2.0


def test_a_certified_eps0_is_asked_for_each_gain_set(single, monkeypatch):
    """0.5 for the gain set of the file; and none at all is said, not passed over."""
    import lyapcheck.answers.epsilon.compute as gain_range

    def found(gain_set, model, **options):
        return SimpleNamespace(certified=Fraction(1, 2) if options["max_boxes"] else None)

    monkeypatch.setattr(gain_range, "epsilon", found)
    request = (single, "--eps0", "certified", "--target", "40,30", "--time", 1, "--format", "json")
    done = lyapcheck(*request)
    assert json.loads(done.stdout)["results"][0]["eps0"] == 0.5
    monkeypatch.setattr(gain_range, "epsilon", lambda *arguments, **options: SimpleNamespace(certified=None))
    none = lyapcheck(*request)
    assert none.returncode == 3
    assert "no ε₀ is certified" in none.stderr


@pytest.mark.parametrize(
    "extra", [["--eps0", "x"], ["--eps0", "certified", "--reference", "SINE"]], ids=range(2)
)
def test_an_eps0_that_means_nothing_is_refused(sine, extra):
    done = lyapcheck(TABLE2, *(sine if word == "SINE" else word for word in extra))
    assert done.returncode == 2
    assert "--eps0 = " in done.stderr


PENDULUM = 'robot = "pendulum1"\n[[gains]]\nname = "g"\nm = 1\nkp = [3]\nkv = [{kv}]\n{loop}'


@pytest.fixture
def pendulum(tmp_path):
    def write(kv: int, loop: str = ""):
        place = tmp_path / "pendulum.toml"
        place.write_text(PENDULUM.format(kv=kv, loop=loop), encoding="utf-8")
        return place

    return write


def test_a_limit_cycle_leaves_with_1_and_the_name_of_the_joint(pendulum):
    done = lyapcheck(pendulum(800), "--rate", 1000, "--delay", 0, "--target", 45)
    assert done.returncode == 1
    assert done.stdout.startswith("✗ pendulum1: limit cycle seen in 1 of 1 gain set\n  ends ")
    assert "simulated at 1 ms, no delay: (0)° to (45)° in 5 s" in done.stdout
    assert "g: limit cycle seen: pivot swings by" in done.stderr
    (result,) = json.loads(
        lyapcheck(pendulum(800), "--rate", 1000, "--target", 45, "--format", "json").stdout
    )["results"]
    assert result["loop"] == "1 ms, 1 sample late, velocity by differences"
    assert (result["unrest"]["kind"], result["unrest"]["joint"]) == ("limit cycle", "pivot")
    log = json.loads(lyapcheck(pendulum(800), "--rate", 1000, "--target", 45, "--format", "sarif").stdout)
    assert [one["level"] for one in log["runs"][0]["results"]] == ["error"]
    assert lyapcheck(pendulum(800), "--target", 45).returncode == 0


def test_a_payload_that_the_gains_cannot_hold_leaves_with_1(pendulum):
    file = pendulum(3, "[loop]\nrate = 500\nunknown_payload = 2\n")
    done = lyapcheck(file, "--target", 45)
    assert done.returncode == 1
    assert done.stdout.startswith(
        "✗ pendulum1: falls seen in 1 of 1 gain set, a payload of up to 2 kg unknown\n  ends "
    )
    assert "the unknown load asks up to" in done.stderr
    light = lyapcheck(file, "--target", 45, "--unknown-payload", 0.1)
    assert light.returncode == 0
    assert "° from the goal (pivot)" in light.stdout


def test_options_go_before_the_experiment_and_that_before_the_file(pendulum):
    file = pendulum(3, "[loop]\nrate = 500\n")
    for options, loop in (
        ((), "2 ms, 1 sample late, velocity by differences"),
        (("--experiment",), "2.5 ms, no delay, velocity by differences"),
        (("--experiment", "--delay", 2), "2.5 ms, 2 samples late, velocity by differences"),
        (("--period", "4 ms", "--lowpass", 50), "4 ms, 1 sample late, velocity by differences, low-pass of"),
    ):
        done = lyapcheck(file, "--target", 45, "--time", 0.5, "--format", "json", *options)
        assert json.loads(done.stdout)["results"][0]["loop"].startswith(loop)
    starts = lyapcheck(file, "--target", 45, "--runs", 3)
    assert "gain set, without the [loop] of the file" in starts.stdout


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--rate", "fast"), "--rate = fast"),
        (("--rate", 0), "--rate = 0"),
        (("--rate", 1000, "--delay", 1.5), "--delay"),
        (("--delay", 1), "--delay: means nothing without a period"),
        (("--rate", 1000, "--runs", 3), "cannot go with --runs"),
        (("--rate", 1000, "--unknown-payload", -1), "--unknown-payload = -1"),
        (("--rate", 1_000_000), "has 5000000 periods"),
    ],
)
def test_loops_that_make_no_sense_are_refused(pendulum, options, message):
    done = lyapcheck(pendulum(3), "--target", 45, *options)
    assert done.returncode == 2
    assert message in done.stderr
