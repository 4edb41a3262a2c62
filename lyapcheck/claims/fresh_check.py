"""The verdicts on certificates, from a process that has seen nothing but their files."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

from lyapcheck.check.certificates.document import Certificate
from lyapcheck.claims.python_process import command, environment


@dataclass(frozen=True)
class Judged:
    """What the checker says about one certificate; verdict and grade only where it is accepted.

    ``grade`` is the weakest of the certificate's own and of those it rests on.
    """

    accepted: bool
    reason: str
    verdict: str | None
    grade: str | None


def judge_afresh(certificates: Mapping[str, Certificate]) -> dict[str, Judged]:
    """What ``python -m lyapcheck.check`` says about certificates, by file name.

    Soundness: a new process reads the files, and trusts nothing of what has happened in this one.

    Raises:
        RuntimeError: the checker does not answer, or about something else.
    """
    if not certificates:
        return {}
    with TemporaryDirectory(prefix="lyapcheck-") as folder:
        for name, certificate in certificates.items():
            Path(folder, name).write_text(certificate.text(), encoding="utf-8", errors="surrogatepass")
        words = command("lyapcheck.check", "--format", "json", folder)
        run = subprocess.run(words, capture_output=True, env=environment(), check=False)
    if run.returncode not in (0, 1):
        raise RuntimeError(f"the checker fails: {run.stderr.decode('utf-8', 'replace').strip()}")
    rows = {row["file"]: row for row in json.loads(run.stdout)["certificates"]}
    for name, certificate in certificates.items():
        claim, row = certificate.claim, rows.get(name, {})
        if row.get("accepted") and (row["id"], row["m"], row["n"]) != (claim.id, claim.m, claim.n):
            raise RuntimeError(f"the checker answers about another certificate than {name}")
    return {
        name: Judged(
            rows[name]["accepted"] is True, *(rows[name][key] for key in ("reason", "verdict", "grade"))
        )
        for name in certificates
    }
