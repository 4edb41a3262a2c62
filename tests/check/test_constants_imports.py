"""The trusted checker stays small: it imports itself, the standard library and python-flint.

What prints its findings, behind ``python -P -m lyapcheck.check``, imports no more than that either.
"""

import ast
import sys
from pathlib import Path

import lyapcheck.check

ROOM = Path(lyapcheck.check.__file__).parent
FILES = sorted(ROOM.rglob("*.py"))
PRINTING = [ROOM / "__main__.py", *sorted((ROOM.parent / "rechecking").glob("*.py"))]
OWN = ("lyapcheck.check", "lyapcheck.rechecking")


def imported(path):
    """The modules that a file names in its imports, inside functions too."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path.name} uses a relative import"
            yield node.module


def test_the_checker_imports_nothing_else():
    for path in {*FILES, *PRINTING}:
        own = OWN if path in PRINTING else OWN[:1]
        for module in imported(path):
            top = module.split(".")[0]
            allowed = top in sys.stdlib_module_names or top == "flint" or module.startswith(own)
            assert allowed or (path in PRINTING and module == "lyapcheck"), f"{path.name} imports {module}"


def test_the_walk_finds_imports_inside_functions(tmp_path):
    planted = tmp_path / "planted.py"
    planted.write_text("def f():\n    import numpy\n    from scipy import linalg\n", encoding="utf-8")
    assert list(imported(planted)) == ["numpy", "scipy"]
