"""What is printed is what is decided: no value of a statement can be changed without its words changing."""

import copy
import json
from fractions import Fraction
from itertools import islice
from pathlib import Path

import pytest

from lyapcheck.check.codec import from_json
from lyapcheck.check.statement import Statement
from tests.arena.run import ARENA

LARGEST, MOST = 14_000, 60
"""Bytes of a file, and the values of a statement that are changed, spread over all of them."""
WITHOUT_WORDS = {
    ("AllOf", "parts"): "the author's names of the parts, which say nothing",
    ("Agrees", "solve_for"): "of which input more is reported, not what is claimed",
    ("GravityBelow", "joints"): "of a gravity that is 0",
    ("Stable", "argument.system.functions.member"): "bounds of a function that is printed",
    ("StableArm", "argument.system.functions.member"): "bounds of a function that is printed",
    ("Stable", "argument.rest"): "how it is shown that the goal is the only state of rest",
    ("StableArm", "argument.rest"): "how it is shown that the goal is the only state of rest",
    ("Property", "argument"): "how the property of the printed loop and V is shown",
}
"""What the words leave out, and what it is."""


def leaves(value, path=()):
    """The values of a statement, each with its place."""
    if isinstance(value, dict | list):
        items = value.items() if isinstance(value, dict) else enumerate(value)
        for key, part in items:
            yield from leaves(part, (*path, key))
    elif path[-1] != "kind":
        yield path, value


def others(value):
    """Other values that may stand in its place."""
    if isinstance(value, bool):
        return [not value]
    if isinstance(value, int):
        return [value + 1]
    if value is None:
        return ["1", [], 1]
    try:
        number = Fraction(value)
    except ValueError:
        return [f"{value}a", "z", "mul", "add", "<", "<="]
    return [str(number + 1), str(number + Fraction(1, 10**12)), str(-number)]


def words(data):
    """The statement in words and what it takes for granted; ``None`` where the data say nothing."""
    try:
        statement = from_json(Statement, data, "statement")
        statement.require_well_formed()
        return statement.text(), statement.granted
    except Exception:  # what is no expression is refused when it is judged; it need have no words
        return None


def statements():
    """Those of the good certificates of the arena that are not large."""
    paths = (path if path.is_file() else path / "0.json" for path in sorted((ARENA / "good").iterdir()))
    small = (path for path in paths if path.stat().st_size <= LARGEST)
    return {path.relative_to(ARENA).as_posix(): json.loads(path.read_text())["statement"] for path in small}


def left_out(kind, path):
    names = ".".join(key for key in path if isinstance(key, str))
    return any(kind == of and f"{names}.".startswith(f"{place}.") for of, place in WITHOUT_WORDS)


STATEMENTS = statements()


@pytest.mark.slow
@pytest.mark.parametrize("name", STATEMENTS, ids=[Path(name).stem for name in STATEMENTS])
def test_no_value_changes_without_the_words(name):
    data = STATEMENTS[name]
    said, every = words(data), list(leaves(data))
    for path, value in islice(every, 0, None, 1 + len(every) // MOST):
        for other in others(value):
            changed = copy.deepcopy(data)
            place = changed
            for key in path[:-1]:
                place = place[key]
            place[path[-1]] = other
            result = words(changed) if other != value else None
            assert result is None or result != said or left_out(data["kind"], path), (path, value, other)
