"""What the commands that answer at once load: nothing heavy, and no other command."""

import os
import subprocess
import sys

import pytest

from lyapcheck.control.gains import paper_gain_file
from tests.helpers.shares import but

HEAVY = {
    *("casadi", "clarabel", "cvxpy", "jinja2", "matplotlib", "numpy", "scipy", "sympy"),
    *("click", "difflib", "pydantic", "rich", "shtab", "typer", "xml"),
}
CODE = """
import sys
from lyapcheck.cli.main import main
try:
    main()
finally:
    print(*sys.modules, file=sys.stderr)
"""
QUICK = {
    "gate": ["gate", str(paper_gain_file())],
    "gate as JSON": ["gate", str(paper_gain_file()), "--format", "json"],
    "gate as SARIF": ["gate", str(paper_gain_file()), "--format", "sarif"],
    "help of tune": ["tune", "--help"],
    "table": ["table", "--m", "1:3"],
    "help": ["--help"],
    "help of a command": ["gate", "--help"],
    "version": ["--version"],
}


def modules_of(words):
    """The modules that are loaded when a command has been run."""
    line = [sys.executable, "-I", "-c", CODE, *words]
    done = subprocess.run(line, capture_output=True, text=True, check=False, env={"PATH": os.environ["PATH"]})
    assert done.stdout
    return set(done.stderr.split())


@pytest.mark.parametrize("name", but(["gate", "table", "help"], QUICK))
def test_nothing_heavy_is_loaded(name):
    loaded = modules_of(QUICK[name])
    assert "lyapcheck.cli.main" in loaded
    assert not {name.partition(".")[0] for name in loaded} & HEAVY


def test_the_gate_loads_no_other_command_and_no_reader_of_other_arms():
    loaded = modules_of(QUICK["gate"])
    assert {name for name in loaded if name.startswith("lyapcheck.cli.commands.")} == {
        "lyapcheck.cli.commands.gate"
    }
    unused = {"lyapcheck.robots.urdf"}
    unused |= {"lyapcheck.family.hyperbolic_drivers", "importlib.resources", "importlib.metadata"}
    assert not loaded & unused
