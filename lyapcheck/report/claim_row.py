"""A claim in a report: what was decided for one m, in words that no longer change."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from lyapcheck.promise import Promise, told
from lyapcheck.report.plain import plain, read
from lyapcheck.verdicts import Verdict

if TYPE_CHECKING:
    from lyapcheck.answers.check import ClaimResult


@dataclass(frozen=True)
class ClaimRow:
    """As `ClaimResult` has it, and what its certificate is.

    Args:
        witness, evidence: plain data; what else was found on the way.
        proof, title: of the script.
        details: the author's words, then what supports the verdict.
        gains: the gain set that it is about, where it is about one.
        certificate: its path in the report; none where nothing was decided.
        rules: that accepted it.
        granted: what they take for granted.
        promise: that of what is proved: asked is the claim's own statement.
    """

    id: str
    m: int | None
    n: int | None
    statement: str
    comment: str
    place: str
    section: str
    kind: str
    verdict: Verdict
    grade: str
    uses: tuple[str, ...]
    broken: tuple[str, ...]
    witness: Mapping[str, Any] | None
    reason: str
    method: str
    evidence: Mapping[str, Any]
    proof: str
    title: str
    details: tuple[str, ...]
    gains: str | None
    certificate: str | None
    digest: str | None
    rules: tuple[str, ...]
    granted: tuple[str, ...]
    promise: Promise | None = None

    @classmethod
    def of(
        cls,
        claim: ClaimResult,
        proof: str,
        title: str,
        path: str | None,
        digest: str | None,
        gains: str | None = None,
    ) -> ClaimRow:
        """A claim of a proof, with the path and the digest of its certificate if it has one."""
        own = {
            "proof": proof,
            "title": title,
            "gains": gains,
            "details": list(filter(None, (claim.words, *claim.support))),
            "certificate": path,
            "digest": digest,
            "rules": claim.decision.rules,
            "granted": claim.decision.granted,
        }
        return replace(read(cls, claim.data() | own), promise=claim.decision.promise)

    @property
    def word(self) -> str:
        """The verdict as reports say it."""
        return self.says(self.verdict.value)

    def says(self, words: str) -> str:
        """Words of proof, where something is proved."""
        return words if self.promise is None else self.promise.says(words)

    def data(self) -> dict[str, Any]:
        """All of it as plain data."""
        data = plain(self)
        said = ("statement", "method", "evidence")
        data |= {key: told(self.promise, data[key]) for key in said} | {"verdict": self.word}
        return data | {"details": [*self.details[:1], *map(self.says, self.details[1:])]}

    @property
    def about(self) -> str:
        """``tau_m1, m = 1``; the gain set and the member, where there is one."""
        return ", ".join([*filter(None, [self.gains]), *([] if self.m is None else [f"m = {self.m}"])])

    @property
    def heading(self) -> str:
        """The part of the text, or of which other proof, it is listed under."""
        section = self.section or "Claims"
        return section if self.proof == "published" else f"{self.proof}.py: {section}"

    @property
    def decided(self) -> bool:
        """Whether a certificate stands behind the verdict."""
        return self.verdict in (Verdict.PROVED, Verdict.REFUTED)
