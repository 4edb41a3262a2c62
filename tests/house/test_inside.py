"""``docs/architecture.md``: its map has every folder, and its ways lead through functions that there are."""

import inspect
import re
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path

import pytest

from tests.house.test_house import imported, modules

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")


def rows(head):
    """The rows of all tables whose first head is this."""
    tables = re.findall(rf"^\| {re.escape(head)} \|.*\n\|[-|]+\n((?:\|.*\n)+)", PAGE, re.MULTILINE)
    lines = [line for table in tables for line in table.splitlines()]
    return [[cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]] for line in lines]


def folders(top):
    """The names of the folders in one; those that hold nothing but leftovers of Python do not count."""
    inner = [path for path in top.iterdir() if path.is_dir() and path.name != "__pycache__"]
    return {path.name for path in inner if any("__pycache__" not in file.parts for file in path.rglob("*.*"))}


@pytest.mark.parametrize("top", ["lyapcheck", "studies", "tests"])
def test_the_map_has_the_folders_that_there_are(top):
    """What is inside a folder stands in its row as ``inner/``: its folders, and all with modules in them."""
    mapped = set()
    for names, words in rows(f"folder of `{top}/`"):
        here = [ROOT / top / name for name in re.findall(r"`(\w+)`", names)]
        inside = set().union(*map(folders, here))
        inside |= {module.parent.name for path in here for module in path.glob("*/**/*.py")}
        assert inside == set(re.findall(r"`(?:\w+/)*(\w+)/`", words)), names
        mapped |= {path.name for path in here}
    assert mapped == folders(ROOT / top)


def test_a_folder_imports_only_from_those_below_it():
    """In the order of the map, as modules are loaded; the checker's command alone begins at the bottom."""
    order = [name for names, _ in rows("folder of `lyapcheck/`") for name in re.findall(r"`(\w+)`", names)]
    place = {f"lyapcheck.{name}": k for k, name in enumerate(order)}
    upwards = {
        (module, name)
        for module in modules()
        for name in imported(module)
        if place.get(folder_of(name), len(order)) < place.get(folder_of(module), -1)
    }
    assert {module for module, _ in upwards} <= {"lyapcheck.check.__main__"}, upwards


def folder_of(module):
    return ".".join(module.split(".")[:2])


WAYS = rows("function")


def test_there_are_five_ways():
    assert len(re.findall(r"^### From ", PAGE, re.MULTILINE)) == 5
    assert len(WAYS) > 30


@pytest.mark.parametrize(("name", "kind"), [row[:2] for row in WAYS])
def test_each_step_is_a_function_that_hands_on_what_is_said(name, kind):
    module, _, path = name.strip("`").partition(":")
    step = import_module(f"lyapcheck.{module}")
    for part in path.split("."):
        step = getattr(step, part)
    returned = str(inspect.signature(step).return_annotation)
    assert kind.strip("`").replace("\\", "") in returned


def test_what_is_named_in_between_is_there():
    for path in re.findall(r"`((?:\w+\.)+\w+)`(?! \|)", PAGE.partition("## Five paths")[2]):
        if not path.endswith(("md", "json")):
            module, _, name = path.rpartition(".")
            home = import_module(f"lyapcheck.{module}")
            assert hasattr(home, name) or find_spec(f"lyapcheck.{path}"), path
