"""Which search decides which kind of statement: each says so where it is defined."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import Any, TypeVar

from lyapcheck.check.statement import Statement
from lyapcheck.claims.search_result import SearchResult

Procedure = Callable[[Any], SearchResult]
PROCEDURES: dict[type[Statement], Procedure] = {}

Search = TypeVar("Search", bound=Procedure)


def procedure(*kinds: type[Statement]) -> Callable[[Search], Search]:
    """Enter a function as the search for some kinds of statement."""

    def enter(search: Search) -> Search:
        PROCEDURES.update(dict.fromkeys(kinds, search))
        return search

    return enter


def procedure_of(kind: type[Statement]) -> Procedure:
    """The search for a kind: its own, else that of the kind it derives from."""
    return next(PROCEDURES[base] for base in kind.__mro__ if base in PROCEDURES)


@lru_cache(maxsize=1024)
def find(statement: Statement) -> SearchResult:
    """What the search for the kind of a statement finds; not yet judged. Claims share facts: each once."""
    return procedure_of(type(statement))(statement)
