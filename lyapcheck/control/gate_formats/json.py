"""The gate as versioned JSON."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

from lyapcheck.control.conditions import Check
from lyapcheck.control.gate import GateResult
from lyapcheck.control.gate_formats.words import KEYS, advice, joint_name, largest_text, margin_text
from lyapcheck.files import decimal_text

SCHEMA = "lyapcheck/gate/1"
DIGITS = 20


def render(results: Sequence[GateResult]) -> str:
    """``results: [{name, m, verdict, checks: [...]}]``, numbers as decimal strings, limits enclosed."""
    document = {"schema": SCHEMA, "results": [result_json(result) for result in results]}
    return json.dumps(document, ensure_ascii=False, indent=2) + "\n"


def result_json(result: GateResult) -> dict[str, Any]:
    """One gain set as plain data."""
    return {
        "name": result.name,
        "file": result.file.path,
        "family": result.gains.family,
        "m": result.m,
        "verdict": result.verdict,
        "deciding": list(result.deciding),
        "assumptions": list(result.limits.assumptions),
        "checks": [_check(result, check) for check in result.checks],
    }


def _check(result: GateResult, check: Check) -> dict[str, Any]:
    place = result.file.place(result.gains, KEYS[check.id], check.joint)
    return {
        "id": check.id,
        "joint": None if check.joint is None else joint_name(result, check),
        "verdict": check.verdict,
        "value": decimal_text(check.value),
        "limit": None
        if check.limit is None
        else dict(zip(("lower", "upper"), check.limit.decimals(DIGITS), strict=True)),
        "margin": margin_text(check, 12) or None,
        "largest_admissible": None if check.largest_admissible is None else largest_text(check),
        "line": None if place is None else place.line,
        "column": None if place is None else place.column,
        "message": advice(result, check),
    }
