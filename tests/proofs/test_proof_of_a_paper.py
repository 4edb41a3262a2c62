"""``docs/proof_of_a_paper.md`` from an empty file to a verdict, as it stands."""

import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from tests.extending.page import CONSOLE, FILE
from tests.extending.test_adding import is_excerpt

PAGE = (Path(__file__).parents[2] / "docs" / "proof_of_a_paper.md").read_text(encoding="utf-8")


@pytest.mark.slow
def test_every_step_prints_what_the_page_says(tmp_path):
    for match in FILE.finditer(PAGE):
        (tmp_path / match["path"]).write_text(match["text"], encoding="utf-8")
    calls = [(match["command"], match["output"]) for match in CONSOLE.finditer(PAGE)]
    assert len(calls) == 4
    for command, output in calls:
        name, *arguments = shlex.split(command)
        assert name == "lyapcheck"
        run = [sys.executable, "-m", "lyapcheck", *arguments]
        done = subprocess.run(run, cwd=tmp_path, capture_output=True, text=True, check=False)
        assert is_excerpt(output, done.stdout), f"{command} prints\n{done.stdout}{done.stderr}"


def test_what_the_page_names_is_there():
    named = set(re.findall(r"proofs/(\w+\.py)", PAGE))
    assert named
    assert all((Path(__file__).parents[2] / "proofs" / name).is_file() for name in named)
