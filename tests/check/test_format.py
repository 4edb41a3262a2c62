"""docs/format.md names everything that a certificate may hold: a checker is written from it alone."""

import inspect
from dataclasses import fields, is_dataclass
from pathlib import Path

from lyapcheck.check import kinds
from lyapcheck.check.statement import Proof, Statement

FORMAT = Path(__file__).parents[2] / "docs" / "format.md"


def derived(base):
    """All classes of the package below one."""
    for one in base.__subclasses__():
        if one.__module__.startswith("lyapcheck."):
            yield one
        yield from derived(one)


def test_every_kind_rule_and_field_is_there():
    kinds.load()
    text, lost = FORMAT.read_text(encoding="utf-8"), set()
    for one in {*derived(Statement), *derived(Proof)}:
        if inspect.isabstract(one) or not is_dataclass(one):
            continue
        name = one.rule if issubclass(one, Proof) else one.__name__
        lost |= {
            f"{one.__name__} {word}" for word in (name, *(f.name for f in fields(one))) if word not in text
        }
    assert lost == set()
