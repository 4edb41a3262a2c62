"""The outcome of a recheck as text or JSON."""

from __future__ import annotations

import json
from typing import Any

from lyapcheck.check.kinds.theorem import THEOREMS
from lyapcheck.check.recheck import Checked, Outcome
from lyapcheck.check.refusal import plain

SCHEMA = "lyapcheck/recheck/1"


def text(outcome: Outcome) -> str:
    """One line a certificate, then how many were accepted and which theorems they rest on."""
    lines = [_line(one) for one in outcome.checked]
    lines += ["", *(_theorem(name, files) for name, files in outcome.theorems.items()), _tally(outcome)]
    return "\n".join(lines) + "\n"


def as_json(outcome: Outcome) -> str:
    """JSON of the schema ``lyapcheck/recheck/1``."""
    counts = {
        "accepted": sum(one.accepted for one in outcome.checked),
        "refused": sum(not one.accepted for one in outcome.checked),
        "proved": _with_verdict(outcome, "proved"),
        "refuted": _with_verdict(outcome, "refuted"),
    }
    data = {
        "schema": SCHEMA,
        "counts": counts,
        "theorems": {name: list(files) for name, files in outcome.theorems.items()},
        "certificates": [_row(one) for one in outcome.checked],
    }
    return json.dumps(data, indent=2, ensure_ascii=False) + "\n"


def _line(one: Checked) -> str:
    if one.certificate is None or not one.accepted:
        return f"refused   {one.file}: {one.reason}"
    claim = one.certificate.claim
    name = plain(claim.id)
    member = f" (m = {claim.m})" if claim.m is not None else ""
    given = f", given {plain(', '.join(one.given))}" if one.given else ""
    return f"accepted  {one.file}: {name}{member} is {one.certificate.verdict} [{one.grade}]{given}"


def _theorem(name: str, files: tuple[str, ...]) -> str:
    """Which files rest on a theorem, and what no certificate shows of it."""
    claims, known = "1 claim rests" if len(files) == 1 else f"{len(files)} claims rest", THEOREMS[name]
    where = f"{claims} on {name} ({known.reference}): {', '.join(files)}"
    return f"{where}\n  taken for granted: {known.granted}"


def _tally(outcome: Outcome) -> str:
    accepted = sum(one.accepted for one in outcome.checked)
    return (
        f"{accepted} accepted ({_with_verdict(outcome, 'proved')} proved, "
        f"{_with_verdict(outcome, 'refuted')} refuted), {len(outcome.checked) - accepted} refused"
    )


def _with_verdict(outcome: Outcome, verdict: str) -> int:
    accepted = (one.certificate for one in outcome.checked if one.accepted)
    return sum(certificate is not None and certificate.verdict == verdict for certificate in accepted)


def _row(one: Checked) -> dict[str, Any]:
    found = one.certificate
    return {
        "file": one.file,
        "accepted": one.accepted,
        "reason": one.reason,
        "id": found.claim.id if found else None,
        "m": found.claim.m if found else None,
        "n": found.claim.n if found else None,
        "statement": found.claim.says if found else None,
        "verdict": found.verdict if found and one.accepted else None,
        "grade": one.grade if one.accepted else None,
        "uses": sorted(found.uses) if found else [],
        "given": list(one.given),
        "digest": one.digest or None,
    }
