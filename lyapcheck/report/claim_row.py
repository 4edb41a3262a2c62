"""A claim in a report: what was decided for one m, and where its certificate stands."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any

from lyapcheck.answers.check.proof import ClaimResult
from lyapcheck.verdicts import Verdict


@dataclass(frozen=True)
class ClaimRow(ClaimResult):
    """As `ClaimResult` has it.

    Args:
        proof, title: of the script.
        certificate, digest: its path in the report, and its digest; none where nothing was decided.
        gains: the gain set that it is about, where it is about one.
    """

    proof: str
    title: str
    certificate: str | None
    digest: str | None
    gains: str | None = None

    @classmethod
    def of(cls, claim: ClaimResult, *own: str | None) -> ClaimRow:
        """A claim of a proof, with what a row has beside it."""
        return cls(*(getattr(claim, each.name) for each in fields(claim)), *own)

    @property
    def details(self) -> list[str]:
        """The author's words, then what supports the verdict."""
        return [*filter(None, [self.words]), *map(self.decision.says, self.support)]

    def data(self, timings: bool = False) -> dict[str, Any]:
        """All of it as plain data."""
        return super().data(timings) | {
            "proof": self.proof,
            "title": self.title,
            "details": self.details,
            "gains": self.gains,
            "certificate": self.certificate,
            "digest": self.digest,
            "rules": list(self.decision.rules),
            "granted": list(self.decision.granted),
        }

    @property
    def about(self) -> str:
        """``tau_m1, m = 1, n = 3``; the gain set, the member and the number of joints, where there is one."""
        letters = (f"{name} = {value}" for name, value in (("m", self.m), ("n", self.n)) if value is not None)
        return ", ".join([*filter(None, [self.gains]), *letters])

    @property
    def heading(self) -> str:
        """The part of the text, or of which other proof, it is listed under."""
        section = self.section or "Claims"
        return section if self.proof == "published" else f"{self.proof}.py: {section}"

    @property
    def decided(self) -> bool:
        """Whether a certificate stands behind the verdict."""
        return self.verdict in (Verdict.PROVED, Verdict.REFUTED)
