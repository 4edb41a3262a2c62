"""Each option of each command by itself at the ends of what it may be: an answer or a refusal, no fault."""

import random
import shlex

import pytest

from lyapcheck.cli.commands import NAMES
from lyapcheck.computing import computing_time
from lyapcheck.robots import load, names
from tests.helpers.command import lyapcheck
from tests.helpers.extremes import fault, lines
from tests.helpers.shares import one_in

pytestmark = pytest.mark.usefixtures("in_this_process")

BUDGET = 40.0
"""s of computing time for the lines of all commands on all arms, as many as it lasts for."""
LEAST = 40
SEED = 20190301
TARGETED = "tune for targets"
WITHOUT = {
    "init": "it has no options",
    "report": "its options are of files and formats, and a report takes a minute",
    "sweep": "its options are of files and processes; its questions are those of the other commands",
    "explain": "its options are of files",
    "recheck": "its budgets have tests of their own",
}
"""Commands that are not tried."""
MEMBERS = (1, 2, 65, 1000, 10_000)


def gain_file(folder, arm, m=1):
    """Gains for an arm, of a share of its torque limits."""
    limits = [100.0 if one is None else float(one.value) for one in load(arm).torque_limit]
    kp, kv = ([f"{share * limit:.6f}" for limit in limits] for share in (0.01, 0.002))
    path = folder / f"{arm}-{m}.toml"
    text = (
        f'robot = "{arm}"\n[[gains]]\nname = "one"\nm = {m}\nkp = [{", ".join(kp)}]\nkv = [{", ".join(kv)}]\n'
    )
    path.write_text(text, encoding="utf-8")
    return path


def base_lines(folder, arm, m=1):
    """A command line of each command, with as little work as it lets itself be asked for."""
    gains, n = shlex.quote(str(gain_file(folder, arm, m))), load(arm).n
    goal = ",".join(["10"] * n)
    return {
        "bounds": f"bounds {gains} --target={goal} --time 0.1",
        "check": f"check scalar.py --m {m} --only h.odd",
        "derive": f"derive --m {m} --n 1",
        "epsilon": f"epsilon {gains} --max-boxes 20 --starts 1 --jobs 1",
        "export": f"export {gains} --out {shlex.quote(str(folder / 'c'))} --rate 1000",
        "gate": f"gate {gains}",
        "robot": f"robot {arm} --max-boxes 20",
        "simulate": f"simulate {gains} --target={goal} --time 0.05",
        "table": f"table --m {m}",
        "tune": f"tune {arm} --m {m}",
        TARGETED: f"tune {arm} --m {m} --overshoot 50 --stability 19",
    }


def every_line(folder, arm):
    """Every option of every command at every extreme, on one arm."""
    for command, base in base_lines(folder, arm).items():
        yield base
        yield from lines(command.partition(" ")[0], base, load(arm).n)


def test_no_command_is_forgotten(tmp_path):
    assert set(base_lines(tmp_path, "pendulum1")) - {TARGETED} == set(NAMES) - set(WITHOUT)


@pytest.mark.parametrize("command", one_in(2, ["gate", "table"]))
def test_each_option_of_what_is_quick(tmp_path, command):
    base = base_lines(tmp_path, "pendulum1")[command]
    assert [said for line in lines(command, base, 1) if (said := fault(line, tmp_path))] == []


@pytest.mark.slow
def test_each_option_of_every_command_on_every_arm(tmp_path):
    asked = [line for arm in names() for line in every_line(tmp_path, arm)]
    random.Random(SEED).shuffle(asked)
    begun, faults = computing_time(), []
    for done, line in enumerate(asked):
        if done >= LEAST and computing_time() - begun > BUDGET:
            break
        faults.append(fault(line, tmp_path))
    assert [one for one in faults if one] == []


@pytest.mark.parametrize("m", one_in(4, MEMBERS[::-1]))
@pytest.mark.parametrize("command", one_in(3, ["gate", "simulate", "epsilon", "tune", "table"]))
def test_members_up_to_the_largest(tmp_path, command, m):
    assert fault(base_lines(tmp_path, "pendulum1", m)[command], tmp_path) == ""


def test_one_more_than_the_largest_is_refused_everywhere(tmp_path):
    for command, line in base_lines(tmp_path, "pendulum1", MEMBERS[-1] + 1).items():
        if command != "robot":
            done = lyapcheck(*shlex.split(line), folder=tmp_path)
            assert done.returncode == 2, line
            assert "10000" in done.stderr


@pytest.mark.slow
@pytest.mark.parametrize("arm", names())
def test_weights_are_sought_without_a_fault(tmp_path, arm):
    assert fault(f"{base_lines(tmp_path, arm)['epsilon']} --weights", tmp_path) == ""
