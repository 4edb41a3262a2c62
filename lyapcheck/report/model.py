"""The one object that every renderer reads."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

SCHEMA = "lyapcheck/report/1"

Data = Mapping[str, Any]


@dataclass(frozen=True)
class Finding:
    """One place where the paper is not confirmed.

    Args:
        subject: what it is about: a claim, a gain set, an index.
        ms: the members of the family it concerns; empty where it concerns all.
        text: one or two sentences, numbers included.
        kind: ``refuted``, ``rejected``, ``empty`` or ``differs``.
    """

    subject: str
    ms: tuple[int, ...]
    text: str
    kind: str


@dataclass(frozen=True)
class Report:
    """Everything that was found out about one arm and its gain sets, as plain data and finished figures.

    Args:
        robot: name, title, joints, numbers and assumptions of the arm.
        ms: the members of the family that were asked for.
        table: rows of the constants table.
        equations: LaTeX of the controller, V and dV/dt, by name.
        gate: gate results, one a gain set.
        epsilon: the four ε₀, one entry a gain set.
        claims: decided claims of the paper, one row a claim and m.
        instead: what other proofs conclude, one row a conclusion and m.
        runs: simulated runs, one a gain set, the PD baseline last.
        sensitivity: the printed experiment on the arms that are assumed possible; none if there is none.
        findings: where the paper is not confirmed.
        figures: SVG text, PNG and CSV by file name.
        versions: the software that was used.
        seed: the seed of every random search.
    """

    robot: Data
    ms: tuple[int, ...]
    table: tuple[Data, ...]
    equations: Mapping[str, str]
    gate: tuple[Data, ...]
    epsilon: tuple[Data, ...]
    claims: tuple[Data, ...]
    instead: tuple[Data, ...]
    runs: tuple[Data, ...]
    sensitivity: Data | None
    findings: tuple[Finding, ...]
    figures: Mapping[str, str | bytes] = field(repr=False)
    versions: Mapping[str, str] = field(default_factory=dict)
    seed: int = 0

    def of(self, m: int) -> MemberView:
        """What concerns one member of the family."""
        return MemberView(self, m)

    def counts(self, rows: tuple[Data, ...] | None = None) -> dict[str, int]:
        """How many claims have each verdict."""
        chosen = self.claims if rows is None else rows
        order = ("proved", "refuted", "undecided", "error")
        return {verdict: sum(row["verdict"] == verdict for row in chosen) for verdict in order}


@dataclass(frozen=True)
class MemberView:
    """The part of a report that concerns one m; claims without an m belong to every view."""

    report: Report
    m: int

    @property
    def claims(self) -> tuple[Data, ...]:
        """Claims decided for this m, and those that do not depend on m."""
        return tuple(row for row in self.report.claims if row["m"] in (self.m, None))

    @property
    def instead(self) -> tuple[Data, ...]:
        """Conclusions of other proofs for this m."""
        return tuple(row for row in self.report.instead if row["m"] in (self.m, None))

    @property
    def constants(self) -> Data | None:
        """The row of the constants table."""
        return next((row for row in self.report.table if row["m"] == self.m), None)

    @property
    def gate(self) -> tuple[Data, ...]:
        """Gate results of the gain sets of this m."""
        return tuple(row for row in self.report.gate if row["m"] == self.m)

    @property
    def epsilon(self) -> tuple[Data, ...]:
        """ε₀ of the gain sets of this m."""
        return tuple(row for row in self.report.epsilon if row["m"] == self.m)

    @property
    def runs(self) -> tuple[Data, ...]:
        """Runs of the gain sets of this m."""
        return tuple(row for row in self.report.runs if row["m"] == self.m)

    @property
    def sensitivity(self) -> tuple[Data, ...]:
        """The printed numbers of the gain sets of this m, beside what the assumed arms do."""
        sets = self.report.sensitivity["sets"] if self.report.sensitivity else ()
        return tuple(one for one in sets if one["m"] == self.m)

    @property
    def findings(self) -> tuple[Finding, ...]:
        """Findings about this m, and about all."""
        return tuple(finding for finding in self.report.findings if not finding.ms or self.m in finding.ms)

    def counts(self) -> dict[str, int]:
        """How many claims have each verdict."""
        return self.report.counts(self.claims)
