"""The gate: gain sets accepted or rejected by the conditions that the user wants to hold."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from lyapcheck.control.bound import gamma_of
from lyapcheck.control.conditions import ACCEPTED, CHECKS, CONDITIONS, REJECTED, UNDECIDED, Check
from lyapcheck.control.gains import GainFile, GainSet
from lyapcheck.control.limits import Limits, limits_for
from lyapcheck.verdicts import Exit

DECIDING = ("10p", "19")
"""What the paper's tuning rules ask for; (10) is shown beside them and decides only when asked to."""


@dataclass(frozen=True)
class GateResult:
    """What the gate found about one gain set; ``verdict`` follows from the deciding checks alone."""

    file: GainFile
    gains: GainSet
    limits: Limits
    checks: tuple[Check, ...]
    deciding: tuple[str, ...] = DECIDING

    @property
    def name(self) -> str:
        """The gain set's name."""
        return self.gains.name

    @property
    def m(self) -> int | None:
        """The member of the hyperbolic family."""
        return self.gains.m

    @property
    def verdict(self) -> str:
        """``rejected`` if a deciding check is, else ``undecided`` if one is, else ``accepted``."""
        found = {check.verdict for check in self.checks if check.id in self.deciding}
        if REJECTED in found:
            return REJECTED
        return UNDECIDED if UNDECIDED in found or not found else ACCEPTED

    @property
    def failures(self) -> tuple[Check, ...]:
        """The deciding checks that were not accepted."""
        return tuple(
            check for check in self.checks if check.id in self.deciding and check.verdict != ACCEPTED
        )


def gate(
    gain_file: GainFile,
    robot: str | None = None,
    deciding: Sequence[str] = DECIDING,
    gamma: str = "true",
) -> list[GateResult]:
    """Decide (10), (10p) and (19) for every gain set of a file.

    Args:
        gain_file: what ``read_gain_file`` returned.
        robot: an arm that replaces the one the file names.
        deciding: which of the conditions must hold.
        gamma: ``true`` or ``printed`` (the paper's rounded γ, two of which are too small).

    Raises:
        InputError: no arm to judge the gains by, or no printed γ for an m.

    Soundness: exact, see ``lyapcheck.control.conditions``.

    References: (10), (19) and Section 4 of reyes2019family.
    """
    limits = limits_for(gain_file, robot)
    return [_result(gain_file, gains, limits, tuple(deciding), gamma) for gains in gain_file.gains]


def _result(
    gain_file: GainFile, gains: GainSet, limits: Limits, deciding: tuple[str, ...], source: str
) -> GateResult:
    gamma = gamma_of(gains, source)
    checks = tuple(check for name in CONDITIONS for check in CHECKS[name](gains, limits, gamma))
    return GateResult(gain_file, gains, limits, checks, deciding)


def gate_exit(results: Sequence[GateResult]) -> Exit:
    """The exit code for gate results: 1 if any is rejected, else 3 if any is undecided, else 0."""
    found = {result.verdict for result in results}
    if REJECTED in found:
        return Exit.REFUTED
    return Exit.UNDECIDED if UNDECIDED in found or not found else Exit.PROVED
