"""The trusted checker stays small: it imports itself, the standard library and python-flint."""

from __future__ import annotations

import ast
import sys
from pathlib import Path

import pytest

import lyapcheck.check

FILES = sorted(Path(lyapcheck.check.__file__).parent.rglob("*.py"))


def imported(path):
    """The modules that a file names in its imports, inside functions too."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path.name} uses a relative import"
            yield node.module


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_the_checker_imports_nothing_else(path):
    for module in imported(path):
        top = module.split(".")[0]
        allowed = top in sys.stdlib_module_names or top == "flint" or module.startswith("lyapcheck.check")
        assert allowed, f"{path.name} imports {module}"


def test_the_walk_finds_imports_inside_functions(tmp_path):
    planted = tmp_path / "planted.py"
    planted.write_text("def f():\n    import numpy\n    from scipy import linalg\n", encoding="utf-8")
    assert list(imported(planted)) == ["numpy", "scipy"]
