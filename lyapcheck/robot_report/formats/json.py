"""The report of an arm as versioned JSON."""

from __future__ import annotations

import json
from fractions import Fraction
from importlib.metadata import version
from typing import Any

from lyapcheck.constants import SEED, Constant
from lyapcheck.files import decimal_text
from lyapcheck.robot_report.build import RobotReport
from lyapcheck.robot_report.certified import Certified
from lyapcheck.robot_report.properties import Property
from lyapcheck.robots import Number

SCHEMA = "lyapcheck/robot/1"
_DIGITS = 15


def render(report: RobotReport) -> str:
    """``properties: [{id, verdict, …}], constants: [{name, lower, upper, …}], joints: […], numbers: {…}``."""
    model = report.model
    document = {
        "schema": SCHEMA,
        "version": version("lyapcheck"),
        "robot": model.name,
        "title": model.title,
        "n": model.n,
        "seed": SEED,
        "properties": [_property(row) for row in report.properties],
        "prints": [_property(row) for row in report.prints],
        "constants": [_constant(report, constant) for constant in report.constants],
        "joints": [
            {
                "name": joint,
                "viscous": _number(model.viscous[i]),
                "coulomb": _number(model.coulomb[i]),
                "torque_limit": _number(model.torque_limit[i]),
                "encoder": model.encoder[i],
                "gravity_bound": _number(model.gravity_bound[i]),
            }
            for i, joint in enumerate(model.joints)
        ],
        "numbers": {name: _number(number) for name, number in model.numbers.items()},
        "parameters": list(model.parameters),
        "assumptions": list(model.assumptions),
    }
    return json.dumps(document, ensure_ascii=False, indent=2) + "\n"


def _property(row: Property) -> dict[str, Any]:
    finding = row.finding
    return {
        "id": row.id,
        "statement": row.statement,
        "verdict": row.verdict.value,
        "grade": finding.grade.label,
        "method": finding.method,
        "reason": finding.reason,
        "witness": finding.witness,
        "evidence": finding.evidence,
    }


def _constant(report: RobotReport, constant: Constant) -> dict[str, Any]:
    """``lower`` and ``upper`` are the ends in floating point, as in ``numeric``."""
    lower, upper = constant.enclosure.decimals(_DIGITS)
    n, shown = report.model.n, report.certified.get(constant.name, Certified())
    return {
        "name": constant.name,
        "unit": constant.unit,
        "lower": lower,
        "upper": upper,
        "certified": {"lower": _end(shown.lower), "upper": _end(shown.upper)},
        "numeric": {"lower": lower, "upper": upper},
        "gap": f"{constant.gap:.3e}",
        "q": [repr(x) for x in constant.state[:n]],
        "x": [repr(x) for x in constant.state[n:]] or None,
        "boxes": constant.boxes,
    }


def _end(value: Fraction | None) -> str | None:
    return None if value is None else decimal_text(value)


def _number(number: Number | None) -> dict[str, Any] | None:
    if number is None:
        return None
    low, high = number.bounds
    return {
        "value": decimal_text(number.value),
        "unit": number.unit,
        "source": number.source,
        "assumed": number.assumed,
        "low": decimal_text(low),
        "high": decimal_text(high),
        "note": number.note,
    }
