"""Gains asserted in a user's own tests: pytest finds the fixture ``accepted_gains`` by itself.

    def test_gains_of_the_arm(accepted_gains):
        accepted_gains("config/gains.toml")

Outside a test function, or without the plugin, :func:`assert_accepted` does the same.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

import pytest

if TYPE_CHECKING:
    from lyapcheck.answers.gate import GateAnswer
    from lyapcheck.robots import ArmLike


class AcceptedGains(Protocol):
    """What the fixture hands to a test."""

    def __call__(
        self, path: str | Path, *, robot: ArmLike | None = None, conditions: Sequence[str] | None = None
    ) -> GateAnswer:
        """See :func:`assert_accepted`; a relative path is meant from pytest's root directory."""
        ...


def assert_accepted(
    path: str | Path, *, robot: ArmLike | None = None, conditions: Sequence[str] | None = None
) -> GateAnswer:
    """Fail unless every gain set of a file is accepted by the conditions.

    Args:
        path: a gain file.
        robot: an arm, its name or the path of its file, instead of the arm of the gain file.
        conditions: which must hold; if missing those that the file names, else (10p) and (19).

    Returns:
        What the gate found, one result a gain set.

    Raises:
        AssertionError: a set is rejected or undecided; says where, why and what to change.
        InputError: the file, the arm or a condition cannot be used.

    Soundness: that of the gate, which decides exactly.
    """
    __tracebackhide__ = True
    from lyapcheck.answers.gate import gate
    from lyapcheck.answers.gate.words import RULES, advice
    from lyapcheck.control.gains import read_gain_file
    from lyapcheck.errors import argument_error

    if conditions is not None and not conditions:
        raise argument_error("conditions", "", "names no condition", "use some, for instance 10p and 19")
    results = gate(read_gain_file(path, robot, undamped=True), robot, conditions)
    complaints = []
    for result in results:
        for check in result.failures:
            place = result.file.place(result.gains, RULES[check.id].key, check.joint)
            where = result.file.path if place is None else f"{result.file.path}:{place.line}:{place.column}"
            complaints.append(f"{where}: {result.name} {check.verdict}: {advice(result, check)}")
    if complaints or results.exit_code:
        raise AssertionError("\n".join(complaints) or repr(results))
    return results


@pytest.fixture
def accepted_gains(request: pytest.FixtureRequest) -> AcceptedGains:
    """Assert that the gate accepts a gain file: ``accepted_gains("config/gains.toml")``."""
    root = request.config.rootpath

    def accepted(
        path: str | Path, *, robot: ArmLike | None = None, conditions: Sequence[str] | None = None
    ) -> GateAnswer:
        __tracebackhide__ = True
        return assert_accepted(root / path, robot=robot, conditions=conditions)

    return accepted
