"""The gate as JUnit XML: a suite a gain set, a test case a check."""

from __future__ import annotations

from collections.abc import Sequence
from re import compile as pattern
from xml.etree import ElementTree as ET

from lyapcheck.control.conditions import Check
from lyapcheck.control.gate import GateResult
from lyapcheck.control.gate_formats.words import advice, joint_name
from lyapcheck.files import printable

_NOT_XML = pattern(r"[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
"""Characters that no XML 1.0 document may hold, not even as a reference."""


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
        name=_text(result.name),
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
        classname=_text(f"{result.file.path}.{result.name}"),
        name=_text(f"({check.id}) {joint_name(result, check)}"),
    )
    if check.verdict == "rejected":
        ET.SubElement(case, "failure", message=_text(advice(result, check)), type="rejected")
    elif check.verdict == "undecided":
        ET.SubElement(case, "skipped", message=_text(advice(result, check)))


def _text(text: str) -> str:
    """The text with what XML cannot hold written as an escape."""
    return _NOT_XML.sub(lambda found: printable(found[0]), text)
