"""Where a library is not installed: what does without it works, what does not says what to install."""

from pathlib import Path

import pytest

from lyapcheck.control.gains import paper_gain_file
from lyapcheck.errors import PACKAGES, lacking, missing
from tests.cli.test_every_command import CALLS, GAINS, PLAN
from tests.helpers.environments import FLINT, environment, run

GOOD = Path(__file__).parents[1] / "arena" / "good"
TABLE2 = str(paper_gain_file())
ALONE = {
    "gate one.toml --condition 10 --condition 10p --condition 10i --condition 19 --certificates made": 1,
    "recheck made --trusted": 0,
    f"gate {TABLE2} --condition scalar --condition lasalle": 0,
    f"gate {TABLE2} --rate 1000 --condition 10i --condition sampled --certificates run": 3,
    "recheck run": 0,
    f"gate {TABLE2} --rate 1000 --within 90 --condition 10i --condition sampled": 3,
    "init mine": 0,
}
"""What python-flint alone is enough for."""
MORE = {
    "gate one.toml --vary mass=-5%..+5% --format sarif": 1,
    "gate one.toml --rate 2 --condition sampled": 3,
    "gate one.toml --unknown-payload 1 --condition holds": 1,
    "table --m 1:3 --certificates proved": 0,
    "recheck proved": 0,
    "gate mine/gains.toml --format html": 0,
    "gate one.toml --format junit --strict": 1,
    "table --m 1:3 --format latex": 0,
    f"recheck {GOOD / 'asy.A.rho.m1.json'}": 0,
    "--version": 0,
    "--help": 0,
}
LACKING = {"epsilon one.toml": "numpy", "tune buap3": "numpy", "simulate one.toml --plot drawn": "numpy"}
ALSO = {
    "--completion bash": "shtab",
    "bounds one.toml --target 10": "numpy",
    "check scalar.py --m 1 --only h.odd": "numpy",
    "explain 16.6": "numpy",
    "export one.toml --out c --rate 1000": "numpy",
    "report --m 1": "numpy",
    "robot pendulum1": "numpy",
    "simulate one.toml --target 10": "numpy",
}
LIBRARIES = sorted(name for name in PACKAGES if name != "flint")


@pytest.fixture(scope="module")
def alone(tmp_path_factory):
    """A Python with python-flint and nothing else."""
    return environment(tmp_path_factory.mktemp("alone") / "environment", only=FLINT)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return _folder(tmp_path_factory.mktemp("work"))


def _folder(path):
    path.mkdir(exist_ok=True)
    (path / "one.toml").write_text(GAINS, encoding="utf-8")
    (path / "plan.toml").write_text(PLAN, encoding="utf-8")
    return path


def does_without(python, lines, folder):
    for line, code in lines.items():
        done = run(python, *line.split(), folder=folder)
        assert done.returncode == code, (line, done.stderr)


def says_what_to_install(python, lines, folder):
    for line, library in lines.items():
        done = run(python, *line.split(), folder=folder)
        said = f"library = {library}: is not installed, and this needs it; pip install {library}"
        assert (done.returncode, done.stdout) == (2, ""), (line, done.stderr)
        assert done.stderr.splitlines()[-1] == f"error: argument: {said}"


def test_python_flint_alone_judges_gains_and_certificates(alone, folder):
    does_without(alone, ALONE, folder)


@pytest.mark.slow
def test_python_flint_alone_does_so_in_every_way(alone, folder):
    does_without(alone, ALONE | MORE, _folder(folder / "again"))


def test_what_needs_a_library_names_it_and_the_line_that_installs_it(alone, folder):
    says_what_to_install(alone, LACKING, folder)


@pytest.mark.slow
def test_so_does_every_other_command(alone, folder):
    says_what_to_install(alone, ALSO, folder)


def test_a_condition_whose_search_lacks_a_library_is_undecided(alone, folder):
    done = run(alone, "gate", "one.toml", "--condition", "global", folder=folder)
    assert done.returncode == 3, done.stderr
    assert "needs numpy, which is not installed; pip install numpy" in " ".join(done.stdout.split())


@pytest.mark.slow
@pytest.mark.parametrize("library", LIBRARIES)
def test_no_command_fails_for_want_of_one_library(tmp_path, library):
    """A third of the commands without each; the tests above have all commands without any."""
    python = environment(tmp_path / "environment", without=(library,))
    folder = _folder(tmp_path)
    for name, (words, code) in list(CALLS.items())[LIBRARIES.index(library) % 3 :: 3]:
        done = run(python, name, *words.split(), folder=folder)
        assert done.returncode in (code, 2), (name, done.stderr)
        if done.returncode != code:
            assert f"library = {PACKAGES[library]}: is not installed" in done.stderr


@pytest.mark.slow
def test_without_python_flint_there_is_nothing_to_judge_with(tmp_path):
    python = environment(tmp_path / "environment", without=FLINT)
    folder = _folder(tmp_path)
    for line in ("gate one.toml", "table", f"recheck {GOOD / 'asy.A.rho.m1.json'}"):
        says_what_to_install(python, {line: "python-flint"}, folder)


def test_a_library_of_somebody_else_is_none_of_ours():
    assert missing(ModuleNotFoundError("no", name="colours")) is None
    assert missing(ImportError("no")) is None
    assert str(missing(ModuleNotFoundError("no", name="numpy.linalg"))) == str(lacking("numpy"))
