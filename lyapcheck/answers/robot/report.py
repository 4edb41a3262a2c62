"""Rows and words that the text and the Markdown have in common."""

from __future__ import annotations

from typing import TYPE_CHECKING

from lyapcheck.files import decimal_text
from lyapcheck.robot_report.certified import Certified
from lyapcheck.robots.number import with_unit

if TYPE_CHECKING:
    from lyapcheck.constants import Constant
    from lyapcheck.robot_report.build import RobotReport
    from lyapcheck.robot_report.properties import Property
    from lyapcheck.robots import Number

SYMBOLS = {"lambda_min": "λmin(M)", "lambda_max": "λmax(M) = β_M"}
_DIGITS = 6
CONSTANT_HEADS = (
    "constant",
    "certified: above",
    "at most",
    "numeric: at least",
    "at most",
    "unit",
    "gap",
    "shown at q (rad)",
)
JOINT_HEADS = ("joint", "viscous (N·m·s/rad)", "Coulomb (N·m)", "torque limit (N·m)", "encoder (counts/turn)")


def headline(report: RobotReport) -> str:
    """What arm this is."""
    model = report.model
    return f"{model.title}: {model.name}, {model.n} joint{'s' if model.n > 1 else ''}"


def constant_row(report: RobotReport, constant: Constant) -> tuple[str, ...]:
    """One constant: the ends that certificates show, and those of floating point, rounded outward."""
    shown = report.certified.get(constant.name, Certified())
    known = ["–" if end is None else decimal_text(end) for end in (shown.lower, shown.upper)]
    low, high = constant.enclosure.decimals(_DIGITS)
    state = ", ".join(f"{x:.4f}" for x in constant.state)
    gap = "0" if constant.gap == 0 else f"{100 * constant.gap:.2g} %"
    return (SYMBOLS.get(constant.name, constant.name), *known, low, high, constant.unit, gap, state)


def joint_rows(report: RobotReport) -> list[tuple[str, ...]]:
    """One row a joint."""
    model = report.model
    return [
        (
            joint,
            _value(model.viscous[i]),
            _value(model.coulomb[i]),
            _value(model.torque_limit[i]),
            "–" if model.encoder[i] is None else str(model.encoder[i]),
        )
        for i, joint in enumerate(model.joints)
    ]


def number_line(name: str, number: Number) -> str:
    """A number with where it comes from."""
    low, high = number.bounds
    between = f" (between {decimal_text(low)} and {decimal_text(high)})" if number.ranged else ""
    origin = "assumed" if number.assumed else number.source
    return f"{name} = {with_unit(number.value, number.unit)}{between}{f', {origin}' if origin else ''}"


def evidence(row: Property) -> str:
    """What supports the verdict."""
    finding = row.finding
    parts = [finding.method, finding.reason]
    if finding.witness is not None:
        point = ", ".join(f"{name} = {value}" for name, value in finding.witness["point"].items())
        left, right = (finding.witness[side][0] for side in ("left", "right"))
        at = f"at {point}: " if point else ""
        parts.append(f"{at}not {left} {finding.witness['operator']} {right}")
    return "; ".join(part for part in parts if part)


def _value(number: Number | None) -> str:
    if number is None:
        return "–"
    return decimal_text(number.value) + (" (assumed)" if number.assumed else "")
