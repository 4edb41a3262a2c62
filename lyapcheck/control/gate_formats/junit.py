"""The gate as JUnit XML: a suite a gain set, a test case a check."""

from __future__ import annotations

from collections.abc import Sequence
from xml.etree import ElementTree as ET

from lyapcheck.control.conditions import Check
from lyapcheck.control.gate import GateResult
from lyapcheck.control.gate_formats.words import advice, joint_name


def render(results: Sequence[GateResult]) -> str:
    """Rejected checks fail, undecided ones are skipped; checks that do not decide are left out."""
    top = ET.Element("testsuites", name="lyapcheck gate")
    for result in results:
        _suite(top, result)
    ET.indent(top)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + ET.tostring(top, encoding="unicode") + "\n"


def _suite(top: ET.Element, result: GateResult) -> None:
    checks = [check for check in result.checks if check.id in result.deciding]
    counts = {
        verdict: sum(check.verdict == verdict for check in checks) for verdict in ("rejected", "undecided")
    }
    suite = ET.SubElement(
        top,
        "testsuite",
        name=result.name,
        tests=str(len(checks)),
        failures=str(counts["rejected"]),
        skipped=str(counts["undecided"]),
        errors="0",
    )
    for check in checks:
        _case(suite, result, check)


def _case(suite: ET.Element, result: GateResult, check: Check) -> None:
    case = ET.SubElement(
        suite,
        "testcase",
        classname=f"{result.file.path}.{result.name}",
        name=f"({check.id}) {joint_name(result, check)}",
    )
    if check.verdict == "rejected":
        ET.SubElement(case, "failure", message=advice(result, check), type="rejected")
    elif check.verdict == "undecided":
        ET.SubElement(case, "skipped", message=advice(result, check))
