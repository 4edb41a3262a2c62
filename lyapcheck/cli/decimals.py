"""Exact decimals on the command line: one for all joints, or one a joint, separated by commas."""

from __future__ import annotations

import re
from fractions import Fraction

from lyapcheck.errors import InputError, Problem, argument_error

_DECIMAL = re.compile(r"[+-]?(\d{1,30}(\.\d{0,30})?|\.\d{1,30})(e[+-]?\d{1,2})?", re.IGNORECASE | re.ASCII)


def parse_decimals(option: str, text: str | None) -> tuple[Fraction, ...] | None:
    """The exact values, ``None`` where the option is not given.

    Raises:
        InputError: a problem for each word that is not a finite decimal.
    """
    if text is None:
        return None
    words = [word.strip() for word in text.split(",")]
    rule, repair = "is not a decimal number", f"write {option} 0.8, or 0.8,0.9,1"
    problems = [
        Problem("argument", None, option, word or repr(text), rule, repair)
        for word in words
        if not _DECIMAL.fullmatch(word)
    ]
    if problems:
        raise InputError(problems)
    return tuple(map(Fraction, words))


def parse_decimal(option: str, text: str | None) -> Fraction | None:
    """One exact value, ``None`` where the option is not given.

    Raises:
        InputError: not a decimal, or more than one.
    """
    values = parse_decimals(option, text)
    if values is not None and len(values) != 1:
        raise argument_error(option, text, "must be one number", f"write {option} 0.406")
    return None if values is None else values[0]
