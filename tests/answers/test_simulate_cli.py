"""The simulate command: what it prints, writes and refuses."""

from __future__ import annotations

import json
import os
import xml.etree.ElementTree as ET

import pytest

from lyapcheck.control.gains import paper_gain_file
from tests.helpers.arm_texts import ONE_JOINT
from tests.helpers.command import invoke
from tests.helpers.command import lyapcheck as command

PD = str(paper_gain_file("table2_pd"))
FORMS = ("svg", "png")


def lyapcheck(*words):
    """What the command simulate leaves."""
    return command("simulate", *words)


def test_json_follows_its_schema():
    done = lyapcheck(PD, "--format", "json", "--eps0", "0.01")
    data = json.loads(done.stdout)
    (result,) = data["results"]
    assert (data["schema"], result["name"]) == ("lyapcheck/simulate/1", "tau_pd")
    assert (result["m"], result["torque_bound"], result["eps0"]) == (None, None, 0.01)
    assert result["target"] == [45.0, 45.0, 90.0]
    assert len(result["settling"]) == len(result["joints"]) == 3
    assert lyapcheck(PD, "--format", "json", "--eps0", "0.01").stdout == done.stdout


def test_experiment_and_markdown():
    done = lyapcheck(PD, "--experiment", "--format", "markdown", "--time", "0.5")
    assert done.returncode == 0
    assert done.stdout.startswith("# \\! buap3: no limit cycle seen in 1 gain set\n\nends up to ")
    assert "## tau_pd: 0° each to (45, 45, 90)° in 0.5 s" in done.stdout
    assert "- as run: 2.5 ms, no delay, velocity by differences\n" in done.stdout
    assert "| shoulder |" in done.stdout


def test_csv_to_a_file_and_to_standard_output(tmp_path):
    place = tmp_path / "run.csv"
    assert lyapcheck(PD, "--csv", str(place), "--time", "1").returncode == 0
    text = place.read_text()
    assert text.startswith("gains,complete,t [s],q1 [rad]")
    assert text.count("\n") == 2002
    assert lyapcheck(PD, "--csv", "-", "--time", "1").stdout == text
    assert os.listdir(tmp_path) == ["run.csv"]


@pytest.mark.slow
def test_figures_are_xml_and_always_the_same(tmp_path):
    for _ in range(2):
        assert lyapcheck(PD, "--plot", str(tmp_path)).returncode == 0
        figures = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
        drawn = [f"tau_pd-{name}.{form}" for name in ("errors", "lyapunov", "torques") for form in FORMS]
        assert sorted(figures) == sorted([*drawn, "tau_pd.csv"])
        for name, content in figures.items():
            if name.endswith(".svg"):
                ET.fromstring(content)
            if name.endswith(".png"):
                assert content.startswith(b"\x89PNG\r\n\x1a\n")
    assert figures["tau_pd.csv"].decode() == lyapcheck(PD, "--csv", "-").stdout
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == figures


def test_a_run_that_cannot_be_finished_leaves_with_3_and_keeps_what_it_reached(tmp_path):
    wild = tmp_path / "wild.toml"
    wild.write_text(
        'robot = "pelican2"\n[[gains]]\nname = "wild"\nfamily = "linear"\nkp = [1, 1]\nkv = [1e6, 1e6]\n'
    )
    done = lyapcheck(str(wild), "--experiment", "--target", "10,20", "--format", "json")
    assert done.returncode == 3
    assert "not finished: wild on pelican2: the sampled loop runs away" in done.stderr
    (result,) = json.loads(done.stdout)["results"]
    assert result["complete"] is False
    assert result["reached"] < 5.0


DRY = ONE_JOINT.format(viscous=0.5, torque=20, more="")
IDEAL = "without the dry friction of the file"


def simulated(folder, more, *way, end=""):
    (folder / "arm.toml").write_text(DRY + more)
    gains = folder / "gains.toml"
    gains.write_text(f'robot = "arm.toml"\n{end}[[gains]]\nname = "a"\nm = 1\nkp = [2]\nkv = [0.5]\n')
    return invoke("simulate", str(gains), "--target", "30", "--time", "1", *way)


@pytest.mark.parametrize("coulomb", ["", "coulomb = 0.1", "coulomb = {value = 0, low = 0, high = 1}"])
@pytest.mark.parametrize("way", [(), ("--experiment",), ("--runs", "3")])
def test_the_first_line_says_that_dry_friction_is_left_out(tmp_path, coulomb, way):
    """Runs of (11) leave it out, the bench does not."""
    first = " ".join(simulated(tmp_path, coulomb, *way).stdout.split("═")[0].split())
    told = "1" in coulomb and way != ("--experiment",)
    assert (IDEAL in first) == told
    assert not told or first.startswith("! ")


def test_it_is_said_on_which_arms_gains_are_simulated(tmp_path):
    within = " ".join(simulated(tmp_path, "", "--vary", "viscous=-10%..+10%").stdout.split())
    assert "simulated on the arm of the file and all 2 corners of the ranges" in within
    beyond = " ".join(simulated(tmp_path, "", "--vary", "viscous=5%..+10%").stdout.split())
    assert "the arm of the file, which lies outside the ranges, and all 2 corners" in beyond
    alone = " ".join(simulated(tmp_path, "", "--vary", "viscous=0.7..0.7").stdout.split())
    assert "and the corner of the ranges" in alone
    assert "a:" not in alone  # a corner that changes nothing


@pytest.mark.parametrize("way", [(), ("--vary", "viscous=-10%..+10%"), ("--experiment",)])
def test_torque_limits_of_the_gain_file_go_before_those_of_the_arm(tmp_path, way):
    done = simulated(tmp_path, "", *way, "--format", "json", end="[bounds]\ntorque = [0.5]\n")
    assert {tuple(one["torque_limit"]) for one in json.loads(done.stdout)["results"]} == {(0.5,)}
    assert done.exit_code == int("--experiment" not in way)
