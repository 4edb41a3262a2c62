"""The report of an arm for programs."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

from lyapcheck.answers.robot.certified import CertifiedBounds
from lyapcheck.answers.robot.extent import extent
from lyapcheck.constants import SEED
from lyapcheck.files.decimals import decimal_text
from lyapcheck.output.digits import decimals
from lyapcheck.promise import told

if TYPE_CHECKING:
    from lyapcheck.answers.robot.facts import ArmFacts
    from lyapcheck.answers.robot.properties import PropertyResult
    from lyapcheck.constants import ConstantResult
    from lyapcheck.robots import Number

_DIGITS = 15


def report_data(report: ArmFacts) -> dict[str, Any]:
    """All of it; exact numbers as decimal strings."""
    model = report.model
    return {
        "robot": model.name,
        "title": model.title,
        "n": model.n,
        "seed": SEED,
        "properties": [property_data(row, extent(row, model)) for row in report.properties],
        "prints": [property_data(row, extent(row, model)) for row in report.prints],
        "constants": [constant_data(report, constant) for constant in report.constants],
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


def property_data(row: PropertyResult, about: str = "") -> dict[str, Any]:
    """One property, or a claim about the print, and for which arms it holds where the arm has ranges."""
    finding = row.finding
    return {
        "id": row.id,
        "statement": finding.says(row.statement),
        "verdict": row.word,
        "for": about or None,
        "grade": finding.grade.label,
        "method": finding.says(finding.method),
        "reason": finding.reason,
        "witness": finding.witness,
        "evidence": told(finding.promise, finding.evidence),
    }


def constant_data(report: ArmFacts, constant: ConstantResult) -> dict[str, Any]:
    """``lower`` and ``upper`` are the ends in floating point, as in ``numeric``, and ``gap`` is theirs."""
    lower, upper = decimals(constant.enclosure, _DIGITS)
    n, shown = report.model.n, report.certified.get(constant.name, CertifiedBounds())
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
