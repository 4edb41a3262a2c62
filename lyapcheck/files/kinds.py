"""Which of the files that lyapcheck reads a document is, by keys that no other has."""

from __future__ import annotations

from collections.abc import Mapping

from lyapcheck.errors import InputError, Problem

ARM, GAINS, PLAN = "an arm file", "a gain file", "the plan of a sweep"
MARKS = {PLAN: ("questions",), ARM: ("links", "urdf", "model"), GAINS: ("gains",)}
REPAIRS = {
    ARM: "give the arm file; a gain file names it by robot = …",
    GAINS: "give the gain file; lyapcheck init starts one",
    PLAN: "give the plan; lyapcheck sweep --help says what it has",
}


def require_kind(file: str, data: Mapping[str, object], wanted: str) -> None:
    """Refuse a file that is of another kind by its keys; one of several kinds is left to its reader.

    Raises:
        InputError: it has the keys of another kind, and none of its own.
    """
    kinds = [kind for kind, keys in MARKS.items() if any(key in data for key in keys)]
    if kinds and wanted not in kinds:
        raise InputError(Problem(file, None, "file", "", f"is {kinds[0]}, not {wanted}", REPAIRS[wanted]))
