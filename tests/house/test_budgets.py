"""Each room has a budget of lines and files: what is added has to make room, or to say why it may not."""

import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
BUDGETS = tomllib.loads((Path(__file__).parent / "budgets.toml").read_text(encoding="utf-8"))
PACKAGE = BUDGETS["lyapcheck"]


def rooms():
    """The Python files of each folder of the package; those beside the folders are the room ``top``."""
    result = {}
    for path in (ROOT / "lyapcheck").rglob("*.py"):
        parts = path.relative_to(ROOT / "lyapcheck").parts
        result.setdefault(parts[0] if len(parts) > 1 else "top", []).append(path)
    return result


def lines(paths):
    return sum(len(path.read_text(encoding="utf-8").splitlines()) for path in paths)


def test_every_room_has_a_budget():
    assert set(PACKAGE) == set(rooms())


@pytest.mark.parametrize("room", sorted(PACKAGE))
def test_a_room_keeps_its_budget(room):
    paths = rooms()[room]
    assert lines(paths) <= PACKAGE[room]["lines"], "delete something, or raise the budget in the same commit"
    assert len(paths) <= PACKAGE[room]["files"], "merge something, or raise the budget in the same commit"


def test_tests_keep_theirs():
    assert lines(list((ROOT / "tests").rglob("*.py"))) <= BUDGETS["tests"]["lines"]


def test_budgets_are_no_larger_than_needed():
    """A budget that is far above what stands there allows growth that nobody has asked for."""
    for room, paths in rooms().items():
        assert PACKAGE[room]["lines"] <= lines(paths) + 150, room
        assert PACKAGE[room]["files"] <= len(paths) + 2, room
