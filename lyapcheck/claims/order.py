"""Claims in an order in which each comes after all that it uses."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Protocol, TypeVar

from lyapcheck.errors import InputError, Problem


class Ordered(Protocol):
    """What has an id and uses others."""

    @property
    def id(self) -> str:
        """The name by which others use it."""
        ...

    @property
    def uses(self) -> tuple[str, ...]:
        """The ids that it uses."""
        ...


S = TypeVar("S", bound=Ordered)


def in_order(claims: Mapping[str, S], file: str) -> list[S]:
    """The claims so that each comes after all it uses; otherwise as they are.

    Raises:
        InputError: a claim uses an id that does not exist, or itself by way of others.
    """
    rule, repair = "uses a claim that the script does not make", "add it or drop the use"
    problems = [
        Problem(file, None, claim.id, used, rule, repair)
        for claim in claims.values()
        for used in claim.uses
        if used not in claims
    ]
    if problems:
        raise InputError(problems)
    done: dict[str, S] = {}
    for claim in claims.values():
        path = [claim.id]
        while path:
            waiting = next((used for used in claims[path[-1]].uses if used not in done), None)
            if waiting is None:
                done[path[-1]] = claims[path[-1]]
                path.pop()
            elif waiting in path:
                circle = " → ".join([*path[path.index(waiting) :], waiting])
                raise InputError(
                    Problem(file, None, waiting, circle, "the claims use each other in a circle", "break it")
                )
            else:
                path.append(waiting)
    return list(done.values())


def needed(claims: Mapping[str, S], ids: Iterable[str]) -> set[str]:
    """The ids and everything they use, directly or not."""
    result: set[str] = set()
    waiting = list(ids)
    while waiting:
        claim = waiting.pop()
        if claim not in result:
            result.add(claim)
            waiting.extend(claims[claim].uses)
    return result
