"""The gate: gain sets accepted or rejected by the conditions that the user wants to hold."""

from __future__ import annotations

from lyapcheck.control.bound import gamma_of
from lyapcheck.control.conditions import ACCEPTED, CONDITIONS, REJECTED, UNDECIDED, Check, Conditions
from lyapcheck.control.gains import GainFile, GainSet
from lyapcheck.control.known_arms import ArmLimits
from lyapcheck.control.limits import Limits, limits_for
from lyapcheck.errors import argument_error
from lyapcheck.records import Record
from lyapcheck.verdicts import Exit

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Sequence

DECIDING = ("10p", "19")
"""What the paper's tuning rules ask for; (10) is shown beside them and decides only when asked to."""
CERTIFICATES = ("scalar", "global")
"""Proofs that dV/dt < 0 for the arm; they are looked for only when asked to decide."""


class GateResult(Record):
    """What the gate found about one gain set; ``verdict`` follows from the deciding checks alone.

    Args:
        file: that the set is from.
        gains: the set.
        limits: of the arm.
        checks: of (10), (10p) and (19), and of the certificates that decide.
        deciding: the conditions that must hold.
        strict: whether what is undecided counts as a failure.
    """

    file: GainFile
    gains: GainSet
    limits: Limits
    checks: tuple[Check, ...]
    deciding: tuple[str, ...] = DECIDING
    strict: bool = False

    @property
    def name(self) -> str:
        """The gain set's name."""
        return self.gains.name

    @property
    def m(self) -> int | None:
        """The member of the hyperbolic family."""
        return self.gains.m

    def __str__(self) -> str:
        """As ``lyapcheck gate`` prints a file with this set alone."""
        return str(GateResults([self]))

    def _repr_html_(self) -> str:
        """Its table, for a notebook."""
        return GateResults([self])._repr_html_()

    @property
    def verdict(self) -> str:
        """``rejected`` if a deciding check is, else ``undecided`` if one is, else ``accepted``."""
        return self.verdict_of(self.deciding)

    def verdict_of(self, conditions: Sequence[str]) -> str:
        """The verdict that some of the conditions give together."""
        found = {check.verdict for check in self.checks if check.id in conditions}
        if REJECTED in found:
            return REJECTED
        return UNDECIDED if UNDECIDED in found or not found else ACCEPTED

    def failed(self, check: Check) -> bool:
        """Whether a check counts as a failure, and not as a warning."""
        return check.verdict == REJECTED or (self.strict and check.verdict == UNDECIDED)

    @property
    def failures(self) -> tuple[Check, ...]:
        """The deciding checks that were not accepted."""
        return tuple(
            [check for check in self.checks if check.verdict != ACCEPTED and check.id in self.deciding]
        )


class GateResults(list[GateResult]):
    """The results of one file, in its order; prints and shows as the command does."""

    def __str__(self) -> str:
        """As ``lyapcheck gate`` prints them."""
        from lyapcheck.gating.formats import renderer

        return renderer("text")(self)

    def _repr_html_(self) -> str:
        """The tables, for a notebook."""
        from lyapcheck.gating.formats import renderer

        return renderer("html")(self)


def gate(
    gain_file: GainFile,
    robot: str | None = None,
    deciding: Sequence[str] = DECIDING,
    gamma: str = "true",
    strict: bool = False,
    arms: dict[str, ArmLimits] | None = None,
) -> GateResults:
    """Decide (10), (10p) and (19) for every gain set of a file, and the certificates that are asked for.

    Args:
        gain_file: what ``read_gain_file`` returned.
        robot: an arm that replaces the one the file names.
        deciding: which of ``10``, ``10p``, ``19``, ``scalar`` and ``global`` must hold.
        gamma: ``true`` or ``printed`` (the paper's rounded γ, two of which are too small).
        strict: whether what is undecided counts as a failure.
        arms: arms that need not be read again, by name, for many files on one arm; those read now are added.

    Raises:
        InputError: no arm to judge the gains by, no printed γ for an m, or an unknown condition.

    Soundness: every verdict is that of ``lyapcheck.check.verify`` on a statement with a proof, which
        ``lyapcheck.gating.documents`` writes as a certificate; where there is no proof it is ``undecided``.

    References: (10), (19) and Section 4 of reyes2019family.

    Example:
        >>> from lyapcheck.control import paper_gain_file, read_gain_file
        >>> [result.verdict for result in gate(read_gain_file(paper_gain_file("table2")))]
        ['accepted', 'rejected', 'rejected']
    """
    _require_known(deciding)
    limits = limits_for(gain_file, robot, arms)
    conditions: dict[tuple[str, int | None], Conditions] = {}
    proved, rests_on = _certificates(gain_file, limits, deciding)
    if rests_on:
        limits = limits.resting_on(rests_on)
    results = GateResults()
    for gains, certificates in zip(gain_file.gains, proved, strict=True):
        key = gains.family, gains.m
        if key not in conditions:
            conditions[key] = Conditions(limits, gamma_of(gains, gamma))
        checks = (*conditions[key].all(gains), *certificates)
        results.append(GateResult(gain_file, gains, limits, checks, tuple(deciding), strict))
    return results


def _require_known(deciding: Sequence[str]) -> None:
    known = (*CONDITIONS, *CERTIFICATES)
    unknown = [name for name in deciding if name not in known]
    if unknown:
        raise argument_error(
            "conditions", ", ".join(unknown), "names no condition", f"use some of: {', '.join(known)}"
        )


def _certificates(
    gain_file: GainFile, limits: Limits, deciding: Sequence[str]
) -> tuple[list[tuple[Check, ...]], tuple[str, ...]]:
    """The checks of the certificates that decide, for each gain set, and what they take for granted."""
    wanted = [name for name in CERTIFICATES if name in deciding]
    if not wanted:
        return [()] * len(gain_file.gains), ()
    from lyapcheck.gating.certificates import Prover

    prover = Prover(limits.robot, gain_file.bounds.viscous_min)
    checks = [tuple([prover.check(name, gains) for name in wanted]) for gains in gain_file.gains]
    return checks, prover.assumptions


def gate_exit(results: Sequence[GateResult]) -> Exit:
    """The exit code for gate results: 1 if any is rejected, else 3 if any is undecided, else 0.

    Where undecided counts as a failure it leads to 1 as well.
    """
    found = {REJECTED if any(map(result.failed, result.failures)) else result.verdict for result in results}
    if REJECTED in found:
        return Exit.REFUTED
    return Exit.UNDECIDED if UNDECIDED in found or not found else Exit.PROVED
