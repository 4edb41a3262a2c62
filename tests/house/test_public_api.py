"""What ``import lyapcheck`` offers, and what it costs."""

import ast
import doctest
import inspect
import subprocess
import sys
from importlib import import_module
from importlib.metadata import version
from pathlib import Path

import pytest

import lyapcheck
from lyapcheck import _HOMES
from lyapcheck import __all__ as PUBLIC
from tests.helpers.shares import but

HEAVY = ("numpy", "scipy", "sympy", "casadi", "cvxpy", "matplotlib", "flint", "rich", "jinja2", "argparse")
OBJECTS = [name for name in PUBLIC if name != "__version__"]


def declared():
    """The imports that a type checker sees, in the form of the table that Python uses."""
    result = {}
    tree = ast.parse(Path(lyapcheck.__file__).read_text(encoding="utf-8"))
    guarded = next(node for node in tree.body if isinstance(node, ast.If))
    for node in guarded.body:
        if isinstance(node, ast.ImportFrom) and str(node.module).startswith("lyapcheck."):
            module = str(node.module).removeprefix("lyapcheck.")
            for alias in node.names:
                result[alias.asname or alias.name] = f"{module}:{alias.name}" if alias.asname else module
    return result


def test_the_list_the_homes_and_the_types_name_the_same_things():
    assert declared() == _HOMES
    assert OBJECTS == list(_HOMES) == sorted(_HOMES)


@pytest.mark.parametrize("name", OBJECTS)
def test_every_name_resolves_to_something_documented(name):
    value = getattr(lyapcheck, name)
    assert inspect.isclass(value) or inspect.isfunction(value) or callable(value)
    assert (inspect.getdoc(value) or "").strip()
    assert value.__module__.startswith("lyapcheck.")


def test_no_public_name_hides_a_room():
    """A room and a function of one name would make the meaning depend on what was imported before."""
    rooms = {path.stem for path in Path(lyapcheck.__file__).parent.iterdir()}
    assert not rooms & set(PUBLIC)


def test_the_version_is_that_of_the_distribution():
    assert lyapcheck.__version__ == version("lyapcheck")


def test_an_unknown_name_is_an_attribute_error():
    with pytest.raises(AttributeError, match="no attribute 'frobnicate'"):
        lyapcheck.frobnicate


def test_names_are_listed_and_kept():
    assert set(PUBLIC) <= set(dir(lyapcheck))
    assert lyapcheck.Verdict is import_module("lyapcheck.verdicts").Verdict
    assert vars(lyapcheck)["Verdict"] is lyapcheck.Verdict


def test_importing_lyapcheck_imports_nothing_heavy():
    code = (
        "import sys, typing, importlib, lyapcheck\n"
        "print(*sorted({name.partition('.')[0] for name in sys.modules}))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert not set(HEAVY) & set(done.stdout.split())


def test_a_type_checker_may_trust_the_annotations():
    assert (Path(lyapcheck.__file__).parent / "py.typed").is_file()


def homes_with_examples():
    """The modules of public names whose documentation has examples."""
    root = Path(lyapcheck.__file__).parent
    names = sorted({home.partition(":")[0] for home in _HOMES.values()})
    files = {name: root / f"{name.replace('.', '/')}.py" for name in names}
    return [
        name for name, file in files.items() if file.is_file() and ">>> " in file.read_text(encoding="utf-8")
    ]


def test_gate_table_and_tune_have_examples():
    assert {"answers.table", "answers.tune.tuning", "answers.tune.targets", "answers.explain"} <= set(
        homes_with_examples()
    )


@pytest.mark.parametrize("home", but(["answers.table"], homes_with_examples()))
def test_the_examples_of_the_documentation_are_true(home):
    failed, tried = doctest.testmod(import_module(f"lyapcheck.{home}"))
    assert failed == 0
    assert tried > 0
