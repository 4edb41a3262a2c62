"""The certificates of a proof: one for each claim that is proved or refuted, and all that they use."""

from __future__ import annotations

from importlib.metadata import version
from urllib.parse import quote

from lyapcheck.check.certificate import About, Certificate
from lyapcheck.claims.result import ClaimResult, ProofResult
from lyapcheck.claims.statements import Missing
from lyapcheck.verdicts import Verdict

Key = tuple[str, int | None]


def certificates(result: ProofResult) -> dict[str, Certificate]:
    """The certificates of a result by file name.

    A certificate of a claim that uses others names the digests of theirs, so those are among them even where
    ``only`` left them out of the report. Claims that are undecided have none.
    """
    rows = {(row.id, row.m): row for row in result.settled}
    found: dict[Key, Certificate] = {}
    for key in rows:
        _certify(key, rows, found, result.name)
    return {file_name(*key): found[key] for key in rows if key in found}


def file_name(claim: str, m: int | None) -> str:
    """``7a.m2.json`` for claim 7a and m = 2; characters that some file system refuses are escaped."""
    name = quote(claim, safe="") if not claim.startswith(".") else "%2E" + quote(claim[1:], safe="")
    return f"{name}.json" if m is None else f"{name}.m{m}.json"


def _certify(key: Key, rows: dict[Key, ClaimResult], found: dict[Key, Certificate], proof: str) -> None:
    """Make the certificate of a row, after those of what it uses."""
    row = rows[key]
    if (
        key in found
        or isinstance(row.stated, Missing)
        or row.step.certificate is None
        or row.decision.certificate is None
    ):
        return
    uses: dict[str, str] = {}
    if row.verdict is Verdict.PROVED:
        for claim in sorted(row.uses):
            used = (claim, row.m) if (claim, row.m) in rows else (claim, None)
            _certify(used, rows, found, proof)
            uses[claim] = found[used].digest
    found[key] = Certificate(
        About(row.id, row.statement, row.m, row.n, proof),
        row.stated,
        row.step.verdict.value,
        row.step.grade.label,
        row.step.certificate,
        uses,
        versions(),
    )


def versions() -> dict[str, str]:
    """What the certificates were made with."""
    return {name: version(name) for name in ("lyapcheck", "python-flint")}
