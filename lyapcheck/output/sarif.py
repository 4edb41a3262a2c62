"""What was judged as SARIF 2.1.0, for code scanning: one result a case that did not pass."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from importlib.metadata import version
from typing import Any
from urllib.parse import quote

from lyapcheck.output.answer import Annotation, Answer, Level

LEVELS: Mapping[Level, str] = {Level.FAILED: "error", Level.UNDECIDED: "warning", Level.REMARK: "note"}


def render(answer: Answer) -> str:
    """A log with one run; regions are lines and columns of the files that were judged."""
    result = [one for one in answer.annotations() if one.level in LEVELS]
    texts = {one.rule: one.rule_text for one in answer.annotations()}
    rules = list(texts)
    driver = {
        "name": "lyapcheck",
        "version": version("lyapcheck"),
        "rules": [{"id": rule, "shortDescription": {"text": text}} for rule, text in texts.items()],
    }
    results = [_result(one, rules.index(one.rule)) for one in result]
    log = {
        "$schema": "https://json.schemastore.org/sarif-2.1.0.json",
        "version": "2.1.0",
        "runs": [{"tool": {"driver": driver}, "columnKind": "unicodeCodePoints", "results": results}],
    }
    return json.dumps(log, ensure_ascii=False, indent=2) + "\n"


def _result(one: Annotation, index: int) -> dict[str, Any]:
    location: dict[str, Any] = {"artifactLocation": {"uri": quote(one.path)}}
    if one.line:
        location["region"] = {"startLine": one.line, "startColumn": max(one.column, 1)}
    return {
        "ruleId": one.rule,
        "ruleIndex": index,
        "level": LEVELS[one.level],
        "message": {"text": f"{one.subject}: {one.message}"},
        **({"locations": [{"physicalLocation": location}]} if one.path else {}),
        "partialFingerprints": {"case/v1": _fingerprint(one)},
    }


def _fingerprint(one: Annotation) -> str:
    """Stable while file, group, rule and case keep their names, wherever the line moves."""
    subject = "\n".join((one.path, one.group, one.rule, one.case))
    return hashlib.sha256(subject.encode()).hexdigest()[:32]
