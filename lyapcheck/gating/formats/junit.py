"""The gate as JUnit XML: a suite a gain set, a test case a check."""

from __future__ import annotations

from re import compile as pattern
from xml.etree import ElementTree as ET

from lyapcheck.gating.formats.words import advice, joint_name
from lyapcheck.gating.stability import remarks
from lyapcheck.output.escapes import printable

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Sequence

    from lyapcheck.control.conditions import Check
    from lyapcheck.gating.gate import GateResult

_NOT_XML = pattern(r"[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
"""Characters that no XML 1.0 document may hold, not even as a reference."""


def render(results: Sequence[GateResult]) -> str:
    """Rejected checks fail; undecided ones are skipped, or fail where the gate is strict.

    Checks that do not decide are left out.
    """
    top = ET.Element("testsuites", name="lyapcheck gate")
    for result in results:
        _suite(top, result)
    ET.indent(top)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + ET.tostring(top, encoding="unicode") + "\n"


def _suite(top: ET.Element, result: GateResult) -> None:
    checks = [check for check in result.checks if check.id in result.deciding]
    failed = sum(result.failed(check) for check in checks)
    skipped = sum(check.verdict == "undecided" for check in checks) if not result.strict else 0
    suite = ET.SubElement(
        top,
        "testsuite",
        name=_text(result.name),
        tests=str(len(checks)),
        failures=str(failed),
        skipped=str(skipped),
        errors="0",
    )
    for check in checks:
        _case(suite, result, check)
    said = remarks(result)
    if said:
        ET.SubElement(suite, "system-out").text = _text("\n".join(said))


def _case(suite: ET.Element, result: GateResult, check: Check) -> None:
    case = ET.SubElement(
        suite,
        "testcase",
        classname=_text(f"{result.file.path}.{result.name}"),
        name=_text(f"({check.id}) {joint_name(result, check)}"),
    )
    if result.failed(check):
        ET.SubElement(case, "failure", message=_text(advice(result, check)), type=check.verdict)
    elif check.verdict == "undecided":
        ET.SubElement(case, "skipped", message=_text(advice(result, check)))


def _text(text: str) -> str:
    """The text with what XML cannot hold written as an escape."""
    return _NOT_XML.sub(lambda found: printable(found[0]), text)
