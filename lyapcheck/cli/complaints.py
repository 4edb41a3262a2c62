"""All that is wrong with a command line, at once."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

from lyapcheck.errors import InputError, Problem

Value = TypeVar("Value")


class Complaints:
    """Problems gathered while arguments are read."""

    def __init__(self) -> None:
        self.problems: list[Problem] = []

    def reading(self, read: Callable[..., Value], *arguments: Any) -> Value | None:
        """What ``read`` returns, ``None`` where it cannot use its arguments: the problems are kept."""
        try:
            return read(*arguments)
        except InputError as error:
            self.problems += error.problems
            return None

    def result(self, read: Callable[..., Value], *arguments: Any) -> Value:
        """What ``read`` returns, if nothing was wrong.

        Raises:
            InputError: this, or something before, could not be used.
        """
        value = self.reading(read, *arguments)
        self.raise_all()
        assert value is not None
        return value

    def raise_all(self) -> None:
        """Raise what was gathered.

        Raises:
            InputError: every problem so far, if there is one.
        """
        if self.problems:
            raise InputError(self.problems)
