"""The families by name: each file in ``members`` is one, and nothing else need know of a new one."""

from __future__ import annotations

from functools import cache, lru_cache
from importlib import import_module

from lyapcheck.check.expressions.grammar import MAX_M
from lyapcheck.errors import argument_error
from lyapcheck.extensions import modules
from lyapcheck.family import members
from lyapcheck.family.base import Family

LARGEST_M = MAX_M
"""The largest of which the checker judges statements."""


@cache
def names() -> tuple[str, ...]:
    """The names of all families, sorted."""
    return modules(members.__path__)


@lru_cache(maxsize=None, typed=True)  # typed: 1 == 1.0 == True, and only the first is an m
def named(name: str, m: int | None = None) -> Family:
    """The family of a name; ``m`` chooses the member of a family that has members.

    Raises:
        InputError: an unknown name, a missing m, or an m that the family does not have.
    """
    if name not in names():
        raise argument_error("family", name, f"is not one of {', '.join(names())}", "name one of these")
    family: Family = import_module(f"lyapcheck.family.members.{name}").create(m)
    return family


def require_member(m: object) -> int:
    """The m of a hyperbolic family, or the error that says what is wrong with it."""
    if isinstance(m, bool) or not isinstance(m, int) or not 1 <= m <= LARGEST_M:
        rule = f"must be a whole number from 1 to {LARGEST_M}"
        raise argument_error("m", m, rule, "give the member of the family, for instance m = 3")
    return m


def require_none(name: str, m: object) -> None:
    """Refuse an m for a family that has a single member."""
    if m is not None:
        raise argument_error("m", m, f"has no meaning for the family {name}", "leave m out")


def hyperbolic(m: int) -> Family:
    """The paper's family, member m: h = sinh^(2m-1) cosh / (1 + sinh^(2m))."""
    return named("hyperbolic", m)
