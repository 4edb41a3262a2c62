"""The gate as SARIF 2.1.0, for code scanning: one result a check that was not accepted."""

from __future__ import annotations

import hashlib
import json
from importlib.metadata import version
from urllib.parse import quote

from lyapcheck.gating.formats.words import KEYS, RULES, advice, joint_name

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import Any

    from lyapcheck.control.conditions import Check
    from lyapcheck.gating.gate import GateResult


def render(results: Sequence[GateResult]) -> str:
    """A SARIF log with one run; regions are the line and column of the gain."""
    found = [_result(result, check) for result in results for check in result.failures]
    log = {
        "$schema": "https://json.schemastore.org/sarif-2.1.0.json",
        "version": "2.1.0",
        "runs": [{"tool": {"driver": _driver()}, "columnKind": "unicodeCodePoints", "results": found}],
    }
    return json.dumps(log, ensure_ascii=False, indent=2) + "\n"


def _driver() -> dict[str, Any]:
    rules = [{"id": f"condition-{name}", "shortDescription": {"text": rule}} for name, rule in RULES.items()]
    return {"name": "lyapcheck", "version": version("lyapcheck"), "rules": rules}


def _result(result: GateResult, check: Check) -> dict[str, Any]:
    place = result.file.place(result.gains, KEYS[check.id], check.joint)
    location: dict[str, Any] = {"artifactLocation": {"uri": quote(result.file.path)}}
    if place is not None:
        location["region"] = {"startLine": place.line, "startColumn": place.column}
    return {
        "ruleId": f"condition-{check.id}",
        "ruleIndex": list(RULES).index(check.id),
        "level": "error" if result.failed(check) else "warning",
        "message": {"text": f"{result.name}: {advice(result, check)}"},
        "locations": [{"physicalLocation": location}],
        "partialFingerprints": {"gain/v1": _fingerprint(result, check)},
    }


def _fingerprint(result: GateResult, check: Check) -> str:
    """Stable while the set, the condition and the joint keep their names, wherever the line moves."""
    subject = "\n".join((result.file.path, result.name, check.id, joint_name(result, check)))
    return hashlib.sha256(subject.encode()).hexdigest()[:32]
