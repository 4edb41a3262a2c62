"""What was found out about one claim, and on what evidence."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import lyapcheck
from lyapcheck.certificate import Certificate
from lyapcheck.check.certificate import About
from lyapcheck.check.statement import Proof, Statement
from lyapcheck.claims.handover import ClaimData, Key
from lyapcheck.claims.search_result import SearchResult, still_open
from lyapcheck.claims.statements import Missing
from lyapcheck.files.fields import file_stem
from lyapcheck.process_tree import temporary_folder
from lyapcheck.promise import Promise, promised
from lyapcheck.verdicts import Grade, Verdict


@dataclass(frozen=True)
class Decision:
    """A verdict with its grade, the method, and a witness (refuted) or a reason with advice (undecided).

    A proved claim has a reason only if no point was found that satisfies its hypotheses.

    ``evidence`` has further findings as plain data, for example the number of boxes. ``certificate`` is the
    certificate that the checker accepted, by ``rules`` and under the assumptions ``granted``. ``promise`` is
    the promise of the proved statement.
    """

    verdict: Verdict
    grade: Grade
    method: str
    reason: str = ""
    witness: dict[str, Any] | None = None
    evidence: dict[str, Any] = field(default_factory=dict)
    certificate: Proof | None = None
    rules: tuple[str, ...] = ()
    granted: tuple[str, ...] = ()
    promise: Promise | None = None

    def __post_init__(self) -> None:
        decided = self.verdict in (Verdict.PROVED, Verdict.REFUTED)
        if decided and self.grade is Grade.NUMERIC:
            raise ValueError("numeric evidence alone neither proves nor refutes")
        if self.verdict is Verdict.REFUTED and not self.witness:
            raise ValueError("a refutation carries a witness")
        if self.verdict is Verdict.UNDECIDED and not self.reason:
            raise ValueError("an undecided claim says why, and what to try next")
        if decided and self.certificate is None:
            raise ValueError("a verdict carries the certificate that the checker accepted")
        if (self.verdict is Verdict.PROVED) is (self.promise is None):
            raise ValueError("what is proved carries a promise, and nothing else does")

    def __repr__(self) -> str:
        return f"<Decision: {self.word}, {self.method}>"

    @property
    def word(self) -> str:
        """The verdict as answers say it."""
        return self.says(self.verdict.value)

    def says(self, words: str) -> str:
        """Words of proof, where something is proved."""
        return words if self.promise is None else self.promise.says(words)


def decided(finding: SearchResult, judged: Judged | None, asked: Statement | Missing) -> Decision:
    """The decision on a claim.

    Args:
        finding: what the search proposes; alone it decides nothing.
        judged: what a fresh checker says about its certificate, none if nothing could be certified.
        asked: the claim's own statement.

    Soundness: the only way to ``proved`` and ``refuted``, which are the checker's words; and it must have
        judged what was asked, or for ``proved`` what covers it.
    """
    if finding.proof is None:
        verdict = Verdict.ERROR if finding.verdict is Verdict.ERROR else Verdict.UNDECIDED
        return Decision(verdict, Grade.NUMERIC, finding.method, finding.reason, evidence=finding.evidence)
    if judged is None:
        return undecided("the checker has not judged its certificate", finding.method, **finding.evidence)
    if not judged.accepted or judged.verdict is None or judged.grade is None:
        reason = f"the checker refuses its certificate ({judged.reason})"
        return undecided(reason, finding.method, **finding.evidence)
    promise, reason = None, ""
    if judged.shown == "proved":
        if isinstance(asked, Statement):
            promise, reason = promised(asked, judged)
        else:
            reason = "nothing was asked"
    elif judged.statement != asked:
        reason = "what is refuted is not what was asked"
    if reason:
        return undecided(reason, finding.method, **finding.evidence)
    return Decision(
        Verdict(judged.verdict),
        Grade[judged.grade.upper()],
        finding.method,
        finding.reason,
        finding.witness,
        finding.evidence,
        finding.proof,
        judged.rules,
        judged.granted,
        promise,
    )


def undecided(reason: str, method: str, **evidence: Any) -> Decision:
    """The decision that nothing could be decided, with a reason that says what to try next."""
    return Decision(Verdict.UNDECIDED, Grade.NUMERIC, method, reason, evidence=evidence)


# --- What is to be decided about one claim for one m, and what the search proposes.


@dataclass(frozen=True)
class Proposal:
    """A claim for one m (``None``: it does not depend on m), its statement, and what was found.

    ``used`` are the rows that it uses, ``finding`` takes them into account.
    """

    claim: ClaimData
    m: int | None
    n: int | None
    stated: Statement | Missing
    used: tuple[Key, ...]
    finding: SearchResult
    seconds: float


def rests_on(ids: Iterable[str]) -> str:
    """Why a step that holds is not enough."""
    return f"its own step holds, but it rests on {', '.join(ids)}; prove those, or prove it without them"


def chained(finding: SearchResult, statement: Statement | Missing, used: Iterable[Proposal]) -> SearchResult:
    """The finding on a step, open if what it uses does not carry it; a counterexample needs none of that."""
    if not finding.is_proof or isinstance(statement, Missing):
        return finding
    open_uses = [row.claim.id for row in used if not row.finding.is_proof]
    if open_uses:
        return replace(still_open(rests_on(open_uses), finding.method), evidence=finding.evidence)
    return finding


# --- The certificates of a proof: one for each claim of which a proof or a refutation is proposed.


def certificates(proposals: Mapping[Key, Proposal], proof: str) -> dict[Key, Certificate]:
    """The certificates of proposals that come each after those it uses; what is open has none.

    A certificate of a claim that uses others names the digests of theirs.
    """
    result: dict[Key, Certificate] = {}
    for key, row in proposals.items():
        if row.finding.proof is not None and not isinstance(row.stated, Missing):
            result[key] = Certificate(
                About(row.claim.id, row.claim.says, row.m, row.n, proof),
                row.stated,
                row.finding.verdict.value,
                row.finding.grade.label,
                row.finding.proof,
                {used: result[used, m].digest for used, m in row.used} if row.finding.is_proof else {},
            )
    return result


def file_name(claim: str, m: int | None) -> str:
    """``7a.m2.json`` for claim 7a and m = 2; characters that some file system refuses are escaped."""
    name = file_stem(claim)
    return f"{name}.json" if m is None else f"{name}.m{m}.json"


# --- The verdicts on certificates, from a process that has seen nothing but their files.


@dataclass(frozen=True)
class Judged:
    """What the checker says about one certificate; verdict and grade only where it is accepted.

    ``statement`` is what was written to its file. ``grade`` is the weakest of the certificate's own and of
    those it rests on; ``rules`` are all that the verdict trusts, ``granted`` is what its statements take for
    granted.
    """

    statement: Statement
    accepted: bool
    reason: str
    verdict: str | None
    grade: str | None
    rules: tuple[str, ...] = ()
    granted: tuple[str, ...] = ()

    @property
    def shown(self) -> str:
        """``proved``, ``refuted`` or ``undecided``."""
        return self.verdict if self.accepted and self.verdict else "undecided"


class ContradictionError(Exception):
    """One statement is both proved and refuted: the checker is wrong, and no verdict of this run counts."""

    def __init__(self, result: list[tuple[str, list[str], list[str]]]) -> None:
        self.statements = tuple(statement for statement, _, _ in result)
        super().__init__(
            "one statement is both proved and refuted, so the checker is wrong; trust none of its verdicts, "
            f"and report this: {'; '.join(self.statements)}"
        )


def judge_afresh(certificates: Mapping[Any, Certificate]) -> dict[Any, Judged]:
    """What ``python -P -m lyapcheck.check`` says about certificates that use none but each other, by any key.

    Soundness: a new process reads the files, and trusts nothing of what has happened in this one.

    Raises:
        ContradictionError: it proves and refutes one statement.
        RuntimeError: the checker does not answer, or answers about something else.
    """
    if not certificates:
        return {}
    files = {f"{number}.json": key for number, key in enumerate(certificates)}
    with temporary_folder() as folder:
        for name, key in files.items():
            Path(folder, name).write_text(certificates[key].text(), encoding="utf-8")
        words = command("lyapcheck.check", "--format", "json", folder)
        run = subprocess.run(words, capture_output=True, env=environment(), check=False)
    try:
        answer: dict[str, Any] = json.loads(run.stdout)
    except ValueError as error:
        raise RuntimeError(f"the checker fails: {run.stderr.decode('utf-8', 'replace').strip()}") from error
    if answer["alarms"]:
        raise ContradictionError(
            [(one["statement"], one["proved"], one["refuted"]) for one in answer["alarms"]]
        )
    rows = {row["file"]: row for row in answer["certificates"]}
    result = {}
    for name, key in files.items():
        row, one = rows[name], certificates[key]
        claim = one.claim
        if row["accepted"] and (row["id"], row["m"], row["n"]) != (claim.id, claim.m, claim.n):
            raise RuntimeError(f"the checker answers about {row['id']} where {claim.id} was asked")
        said = row["reason"], row["verdict"], row["grade"], tuple(row["rules"]), tuple(row["granted"])
        result[key] = Judged(one.statement, row["accepted"] is True, *said)
    return result


# --- Fresh Python processes that import the lyapcheck that runs here, and nothing from the working directory.


def command(module: str, *arguments: str) -> list[str]:
    """The words that run a module; ``-P`` because a script may have written modules where it was started."""
    return [sys.executable, "-P", "-m", module, *arguments]


def environment() -> dict[str, str]:
    """The variables of this process, with the folder that this lyapcheck was imported from."""
    folder = str(Path(lyapcheck.__file__).resolve().parents[1])
    given = [os.path.abspath(path) for path in os.environ.get("PYTHONPATH", "").split(os.pathsep) if path]
    return os.environ | {"PYTHONPATH": os.pathsep.join([*given, folder])}
