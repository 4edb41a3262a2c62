"""Conjunctions: each part by the search for its kind."""

from __future__ import annotations

from lyapcheck.check.kinds.all_of import AllOf
from lyapcheck.claims.search_result import SearchResult, conjunction, find, procedure


@procedure(AllOf)
def find_all(statement: AllOf) -> SearchResult:
    """What is found of each part, together."""
    return conjunction((name, find(part)) for name, part in statement.parts)
