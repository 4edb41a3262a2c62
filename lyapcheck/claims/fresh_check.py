"""The verdicts on certificates, from a process that has seen nothing but their files."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import lyapcheck
from lyapcheck.certificate import Certificate
from lyapcheck.check.statement import Statement
from lyapcheck.claims.handover import Key
from lyapcheck.temporary import temporary_folder


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


def judge_afresh(certificates: Mapping[Key, Certificate]) -> dict[Key, Judged]:
    """What ``python -P -m lyapcheck.check`` says about certificates that use none but each other.

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
    return {key: _judged(rows[name], certificates[key]) for name, key in files.items()}


def _judged(row: dict[str, Any], certificate: Certificate) -> Judged:
    claim = certificate.claim
    if row["accepted"] and (row["id"], row["m"], row["n"]) != (claim.id, claim.m, claim.n):
        raise RuntimeError(f"the checker answers about {row['id']} where {claim.id} was asked")
    rests = (tuple(row["rules"]), tuple(row["granted"]))
    return Judged(
        certificate.statement, row["accepted"] is True, row["reason"], row["verdict"], row["grade"], *rests
    )


# --- Fresh Python processes that import the lyapcheck that runs here, and nothing from the working directory.


def command(module: str, *arguments: str) -> list[str]:
    """The words that run a module; ``-P`` because a script may have written modules where it was started."""
    return [sys.executable, "-P", "-m", module, *arguments]


def environment() -> dict[str, str]:
    """The variables of this process, with the folder that this lyapcheck was imported from."""
    folder = str(Path(lyapcheck.__file__).resolve().parents[1])
    given = [os.path.abspath(path) for path in os.environ.get("PYTHONPATH", "").split(os.pathsep) if path]
    return os.environ | {"PYTHONPATH": os.pathsep.join([*given, folder])}
