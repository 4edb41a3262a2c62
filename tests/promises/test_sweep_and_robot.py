"""A sweep says what the gate says of the same arm; the robot's answer speaks of its ranges, or says so."""

import json
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.promises.draws import (
    FAMILIES,
    MOTOR,
    Arm,
    Ranged,
    arms,
    asked,
    drawn,
    near_the_border,
    results,
    shares,
)

SHARES = st.sampled_from([Fraction(1, 2), Fraction(1), Fraction(101, 100)])


@drawn(1, 15)
@given(arms(), st.sampled_from(FAMILIES), SHARES, shares)
def test_a_sweep_says_what_the_gate_says(arm, family, share, at):
    with TemporaryDirectory() as name:
        folder = Path(name)
        own = arm.at(at).written(folder, "member")
        gains = near_the_border(folder, arm.written(folder, "arm"), arm.n, family, arm.options, share)
        robot, _, sets = gains.read_text(encoding="utf-8").partition("\n")
        options = list(arm.options[1::2])
        head = f"robots = ['arm.toml', '{own}']\nvariations = [[], {options}]\nquestions = ['gate']\n"
        (folder / "plan.toml").write_text(head + sets, encoding="utf-8")
        swept = asked("sweep", str(folder / "plan.toml"), "--jobs", "1")
        assert swept.exit_code in (0, 1, 3), swept.output
        told = {(Path(row["robot"]).name, len(row["variation"])): row["verdict"] for row in results(swept)}
        for file, vary in ("arm.toml", ()), ("arm.toml", arm.options), (own, ()):
            gains.write_text(robot.replace("arm.toml", file) + "\n" + sets, encoding="utf-8")
            (result,) = results(asked("gate", str(gains), *vary))
            assert result["verdict"] == told[file, len(vary) // 2], (file, vary)


@pytest.mark.slow
@drawn(1, 4)
@given(arms(2), shares)
def test_what_robot_proves_over_ranges_holds_at_a_member_and_its_constants_are_nominal(arm, at):
    def exact(x):
        return Ranged(x.value, x.value, x.value)

    with TemporaryDirectory() as name:
        folder = Path(name)
        joints = tuple(
            replace(joint, **{key: exact(getattr(joint, key)) for key in ("mass", *MOTOR)})
            for joint in arm.joints
        )
        nominal = Arm(joints, arm.urdf, arm.printed).written(folder, "nominal")
        files = arm.written(folder, "arm"), nominal, arm.at(at).written(folder, "member")
        over, value, member = (
            json.loads(asked("robot", str(folder / file), "--max-boxes", "200").stdout) for file in files
        )
    assert [one["certified"] for one in over["constants"]] == [one["certified"] for one in value["constants"]]
    for wide, narrow in zip(over["properties"], member["properties"], strict=True):
        if wide["verdict"] == "proved" and "ranges" in (wide["for"] or ""):
            assert narrow["verdict"] == "proved", wide
