"""The gain sets that a proof script is asked with, and what of a gain file is not among them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from lyapcheck.control.gains import GainFile, GainSet, gain_file_of
from lyapcheck.control.paper import paper_gain_file
from lyapcheck.errors import InputError, Problem

DEFAULT_GAINS = "table2"


def gain_sets(gains: GainFile | str | Path | None, joints: int) -> tuple[GainSet, ...]:
    """The sets of the hyperbolic family; of Table 2, which nobody asked for, those that fit the arm.

    Raises:
        InputError: the gain file cannot be used, or all of its sets are for another number of joints.
    """
    file = gain_file_of(paper_gain_file(DEFAULT_GAINS) if gains is None else gains)
    if gains is not None and all(one.n != joints for one in file.gains):
        raise InputError([_misfit(file, one, joints) for one in file.gains])
    return tuple(one for one in file.gains if one.m is not None and one.n == joints)


def left_out(gains: GainFile | str | Path, joints: int, ms: Sequence[int]) -> list[str]:
    """Which sets of a gain file the claims are not about, and why, a sentence each."""
    file, taken, result = gain_file_of(gains), set(), []
    for one in file.gains:
        if one.n != joints:
            why = f"it has gains for {one.n} joints where the claims are about {joints}"
        elif one.m is None:
            why = f"it is of the family {one.family}, and scripts are about members of the hyperbolic family"
        elif one.m not in ms:
            why = f"--m does not ask for m = {one.m}"
        elif one.m in taken:
            why = f"a set before it has m = {one.m}, too"
        else:
            taken.add(one.m)
            continue
        result.append(f"{file.path}: {one.name} is left out: {why}")
    return result


def _misfit(file: GainFile, one: GainSet, joints: int) -> Problem:
    place = file.place(one, "kp")
    rule = f"{one.name} has gains for {one.n} joints, but the claims are about {joints}"
    repair = f"choose an arm of {one.n} joints by --robot, or give {joints} gains, one a joint"
    return Problem(file.path, place.line if place else None, "kp", "", rule, repair)
