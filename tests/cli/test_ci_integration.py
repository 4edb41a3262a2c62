"""The gate inside the tools that run it: the real pre-commit, and the shell of the GitHub action."""

import os
import re
import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

from tests.helpers.shares import one_in

ROOT = Path(__file__).parents[2]
GOOD = 'robot = "buap3"\n\n[[gains]]\nname = "mine"\nm = 1\nkp = [28, 60, 5]\nkv = [0.233, 0.233, 0.233]\n'
BAD = GOOD.replace("60", "70")


@pytest.fixture
def environment(tmp_path):
    """Git and pre-commit on their own: no user configuration, and lyapcheck on the path."""
    return {
        **{key: value for key, value in os.environ.items() if not key.startswith(("GIT_", "PRE_COMMIT"))},
        "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}",
        "HOME": str(tmp_path),
        "PRE_COMMIT_HOME": str(tmp_path / "cache"),
        "GIT_CONFIG_NOSYSTEM": "1",
        **{
            f"GIT_{who}_{what}": "t@example.org"
            for who in ("AUTHOR", "COMMITTER")
            for what in ("NAME", "EMAIL")
        },
    }


def repository(folder, files, environment):
    """A new git repository with one commit; its hash."""
    for name, text in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")
    for command in (["init", "-q"], ["add", "-A"], ["commit", "-qm", "first"]):
        subprocess.run(["git", *command], cwd=folder, env=environment, check=True)
    done = subprocess.run(
        ["git", "rev-parse", "HEAD"], cwd=folder, env=environment, check=True, capture_output=True, text=True
    )
    return done.stdout.strip()


def hooks_pattern():
    text = (ROOT / ".pre-commit-hooks.yaml").read_text(encoding="utf-8")
    return re.compile(re.search(r"^  files: (.*)$", text, re.MULTILINE)[1])


@pytest.mark.parametrize("name", ["gains.toml", "arm_gains.toml", "a/gains/b/arm.toml", "gains/x.toml"])
def test_the_hook_looks_at_gain_files(name):
    assert hooks_pattern().search(name)


@pytest.mark.parametrize("name", ["pyproject.toml", "arms/arm.toml", "gains.json", "gains/x.toml.bak"])
def test_the_hook_leaves_other_files_alone(name):
    assert not hooks_pattern().search(name)


if find_spec("pre_commit"):  # a development tool, not needed to run lyapcheck

    @pytest.mark.parametrize(
        ("gains", "code", "words"), one_in(2, [(BAD, 1, "lower k_p to at most"), (GOOD, 0, "Passed")])
    )
    def test_the_real_pre_commit_judges_staged_gains(gains, code, words, tmp_path, environment):
        """Offline: the hook runs in this environment (``system``) instead of one that pre-commit installs."""
        hooks, project = tmp_path / "hooks", tmp_path / "project"
        hooks.mkdir()
        shutil.copy(ROOT / ".pre-commit-hooks.yaml", hooks)
        revision = repository(hooks, {}, environment)
        config = (
            f"repos:\n- repo: {hooks}\n  rev: {revision}\n  hooks:\n  - id: lyapcheck-gate\n"
            "    language: system\n    verbose: true\n"
        )
        files = {".pre-commit-config.yaml": config, "gains/arm.toml": gains, "pyproject.toml": "[project]\n"}
        repository(project, files, environment)
        done = subprocess.run(
            [sys.executable, "-m", "pre_commit", "run", "--all-files"],
            cwd=project,
            env=environment,
            capture_output=True,
            text=True,
            check=False,
        )
        assert done.returncode == code, done.stdout + done.stderr
        assert words in done.stdout
        assert "gains/arm.toml" in done.stdout


def action_script():
    """The shell of the action's last step."""
    text = (ROOT / "action.yml").read_text(encoding="utf-8")
    block = text.rpartition("run: |\n")[2]
    return "\n".join(line.removeprefix(" " * 8) for line in block.splitlines())


def action(folder, environment, **inputs):
    """The action's last step, run as GitHub runs it; the process and the summary of the job."""
    (folder / "lyapcheck" / "bin").mkdir(parents=True)
    path = f'PATH="{Path(sys.executable).parent}:$PATH"\n'
    (folder / "lyapcheck" / "bin" / "activate").write_text(path, encoding="utf-8")
    summary = folder / "summary.md"
    summary.write_text("of another step\n", encoding="utf-8")
    defaults = {"FILES": "*.toml", "ROBOT": "", "CONDITIONS": "", "STRICT": "false"}
    done = subprocess.run(
        ["bash", "--noprofile", "--norc", "-eo", "pipefail", "-c", action_script()],
        cwd=folder,
        env={
            **environment,
            "RUNNER_TEMP": str(folder),
            "GITHUB_STEP_SUMMARY": str(summary),
            **defaults,
            **inputs,
        },
        capture_output=True,
        text=True,
        check=False,
    )
    return done, summary.read_text(encoding="utf-8").removeprefix("of another step\n")


@pytest.mark.parametrize(
    ("gains", "robot", "code", "words"),
    [
        (GOOD, "", 0, "::notice title=lyapcheck gate::! mine: accepted; dry friction (assumed) leaves at"),
        (GOOD, "buap3-small", 1, "::error file=gains.toml,line=6"),
        (BAD, "", 1, "::error file=gains.toml,line=6,col=11"),
        ("robot = 1\n", "", 2, "::error file=gains.toml,line=1,title=robot::robot = 1: must be"),
    ],
)
def test_the_action_annotates_and_fails(gains, robot, code, words, tmp_path, environment):
    (tmp_path / "gains.toml").write_text(gains, encoding="utf-8")
    done, summary = action(tmp_path, environment, ROBOT=robot)
    assert done.returncode == code, done.stdout + done.stderr
    assert words in done.stdout
    assert summary.startswith("# ")


@pytest.mark.slow
def test_the_action_takes_conditions_and_strictness(tmp_path, environment):
    """No torque limit of the Pelican is known: (10p) is undecided, and (19) holds."""
    text = 'robot = "pelican2"\n[[gains]]\nname = "a"\nm = 1\nkp = [1, 1]\nkv = [0.01, 0.01]\n'
    (tmp_path / "gains.toml").write_text(text, encoding="utf-8")
    for folder, inputs, code in (
        ("a", {}, 3),
        ("b", {"STRICT": "true"}, 1),
        ("c", {"CONDITIONS": "19"}, 0),
        ("d", {"CONDITIONS": "10 19", "STRICT": "true"}, 1),
        ("e", {"CONDITIONS": "20"}, 2),
    ):
        (tmp_path / folder).mkdir()
        done, _ = action(tmp_path / folder, environment, FILES="../gains.toml", **inputs)
        assert done.returncode == code, done.stdout + done.stderr
        assert ("::error" in done.stdout) == (code in (1, 2))


@pytest.mark.parametrize(
    "files", ["gains/**/*.toml", "gains/a b/one set.toml", "gains/a b/one set.toml\ngains/--robot=x.toml"]
)
def test_the_action_takes_any_name(files, tmp_path, environment):
    (tmp_path / "gains" / "a b").mkdir(parents=True)
    (tmp_path / "gains" / "a b" / "one set.toml").write_text(BAD, encoding="utf-8")
    (tmp_path / "gains" / "--robot=x.toml").write_text(GOOD, encoding="utf-8")
    done, _ = action(tmp_path, environment, FILES=files)
    assert done.returncode == 1, done.stdout + done.stderr
    assert "file=gains/a b/one set.toml,line=6" in done.stdout


def test_the_hook_takes_no_file_name_for_an_option():
    text = (ROOT / ".pre-commit-hooks.yaml").read_text(encoding="utf-8")
    assert re.search(r"^  args: \[--\]$", text, re.MULTILINE)


def test_what_a_caller_of_the_action_writes_is_never_part_of_the_script():
    text = (ROOT / "action.yml").read_text(encoding="utf-8")
    for block in text.split("run: |\n")[1:]:
        script = block.split("\n    - ")[0]
        assert "${{" not in script
