"""Reading the members of the family that a command line names: ``3``, ``1,2,5``, ``1:12``."""

from __future__ import annotations

from lyapcheck.errors import InputError, Problem

_MOST_DIGITS = 1_000


def parse_m(text: str, option: str = "--m") -> tuple[int, ...]:
    """The members named by a list of whole numbers and ranges ``low:high``, ascending, each once.

    Raises:
        InputError: one problem for every part of the list that cannot be used.
    """
    result: set[int] = set()
    problems: list[Problem] = []
    for part in text.split(","):
        rule, repair = _complaint(part)
        if rule:
            problems.append(Problem("argument", None, option, part.strip() or repr(text), rule, repair))
        else:
            ends = [int(end) for end in part.split(":")]
            result.update(range(ends[0], ends[-1] + 1))
    if problems:
        raise InputError(problems)
    return tuple(sorted(result))


def _complaint(part: str) -> tuple[str, str]:
    """What is wrong with one part, and the repair; two empty strings if nothing is."""
    from lyapcheck.family.registry import LARGEST_M

    ends = [end.strip() for end in part.split(":")]
    if len(ends) > 2 or not all(_is_whole(end) for end in ends):
        return "is not a whole number or a range of them", "write 3, 1,2,5 or 1:12"
    low, high = int(ends[0]), int(ends[-1])
    if low < 1:
        return "m must be at least 1", "the family starts at m = 1"
    if high > LARGEST_M:
        return f"m must be at most {LARGEST_M}", f"stay within 1:{LARGEST_M}"
    if low > high:
        return "the range is empty", f"write {high}:{low}"
    return "", ""


def _is_whole(text: str) -> bool:
    digits = text.removeprefix("-")
    return digits.isascii() and digits.isdecimal() and len(digits) <= _MOST_DIGITS
