"""The layout of every text answer: a true headline, one table, few remarks, a next command that works."""

import re
import shlex
from pathlib import Path

import pytest

from lyapcheck.output.text import LEAST, MOST, View, render
from tests.helpers.command import invoke
from tests.helpers.layout import parts

ROOT = Path(__file__).parents[2]
TABLE2, PANDA = str(ROOT / "proofs/table2.toml"), str(ROOT / "examples/panda_gains.toml")
ASKED = {
    "gate": ("gate", TABLE2),
}
"""One command line for each kind of answer, on an arm of three joints; a folder with `init`'s files is open."""


@pytest.fixture(autouse=True)
def in_a_folder_with_files(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert invoke("init", ".").exit_code == 0
