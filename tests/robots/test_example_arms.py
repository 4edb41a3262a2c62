"""The example arms end to end: read, gated, and ε₀ of the UR5 certified."""

from pathlib import Path

import pytest

from lyapcheck.robots import load
from tests.helpers.command import invoke
from tests.helpers.shares import but

EXAMPLES = Path(__file__).parents[2] / "examples"
ARMS = [("ur5", 6), ("panda", 7)]
OTHERS = [("px100", 4), ("px150", 5), ("xarm6", 6), ("iiwa14", 7)]
"""Arms whose files have friction, and none that is assumed."""


def run(*arguments):
    result = invoke(*arguments)
    return result.exit_code, result.stdout


@pytest.mark.parametrize(("name", "n"), ARMS)
def test_the_friction_is_stated_and_says_so(name, n):
    arm = load(EXAMPLES / f"{name}.toml")
    assert arm.n == n
    assert all(number.assumed and number.value > 0 for number in arm.viscous)
    assert sum("viscous" in sentence for sentence in arm.assumptions) == n + 1


@pytest.mark.parametrize(("name", "n"), but([OTHERS[0]], ARMS + OTHERS))
def test_the_gate_accepts_the_gains(name, n):
    code, out = run("gate", str(EXAMPLES / f"{name}_gains.toml"))
    assert code == 0
    assert "3 accepted" in out


@pytest.mark.slow
@pytest.mark.parametrize(("name", "n"), [*ARMS, OTHERS[0]])
def test_the_gains_are_those_that_tune_finds(tmp_path, name, n):
    """Numbers alone: the path of the arm depends on where the file is written."""
    code, _ = run("tune", str(EXAMPLES / f"{name}.toml"), "--m", "1:3", "--out", str(tmp_path / "gains.toml"))
    assert code == 0
    result, kept = (
        [line for line in file.read_text(encoding="utf-8").splitlines() if line.startswith(("kp", "kv"))]
        for file in (tmp_path / "gains.toml", EXAMPLES / f"{name}_gains.toml")
    )
    assert len(result) == 6
    assert result == kept
