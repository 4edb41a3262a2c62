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
    run = {"tool": {"driver": driver}, "columnKind": "unicodeCodePoints", "results": results}
    if answer.problems:
        told = [
            {"level": "error", "message": {"text": str(one)}, **_places(one.path, one.line or 0, 1)}
            for one in answer.problems
        ]
        run["invocations"] = [{"executionSuccessful": False, "toolExecutionNotifications": told}]
    log = {"$schema": "https://json.schemastore.org/sarif-2.1.0.json", "version": "2.1.0", "runs": [run]}
    return json.dumps(log, ensure_ascii=False, indent=2) + "\n"


def _places(path: str, line: int, column: int) -> dict[str, Any]:
    location: dict[str, Any] = {"artifactLocation": {"uri": quote(path)}}
    if line:
        location["region"] = {"startLine": line, "startColumn": max(column, 1)}
    return {"locations": [{"physicalLocation": location}]} if path else {}


def _result(one: Annotation, index: int) -> dict[str, Any]:
    # stable while file, group, rule and case keep their names, wherever the line moves
    subject = "\n".join((one.path, one.group, one.rule, one.case))
    return {
        "ruleId": one.rule,
        "ruleIndex": index,
        "level": LEVELS[one.level],
        "message": {"text": f"{one.subject}: {one.message}"},
        **_places(one.path, one.line, one.column),
        "partialFingerprints": {"case/v1": hashlib.sha256(subject.encode()).hexdigest()[:32]},
    }
