"""What was judged as JUnit XML: a suite a group, a test case a case, an error a problem of the input.

Characters that XML cannot hold do not print, and come as escapes in every format.
"""

from __future__ import annotations

from itertools import groupby
from xml.etree import ElementTree as ET

from lyapcheck.output.answer import Annotation, Answer, Level


def render(answer: Answer) -> str:
    """Failed cases fail, undecided ones are skipped, remarks are what the suite says."""
    top = ET.Element("testsuites", name=f"lyapcheck {answer.schema.split('/')[1]}")
    for (path, group), result in groupby(answer.annotations(), key=lambda one: (one.path, one.group)):
        _suite(top, path, group, list(result))
    for path, problems in groupby(answer.problems, key=lambda one: one.path):
        name, listed = path or "input", list(problems)
        count = str(len(listed))
        counts = {"tests": count, "failures": "0", "skipped": "0", "errors": count}
        suite = ET.SubElement(top, "testsuite", {"name": name, **counts})
        for problem in listed:
            case = ET.SubElement(suite, "testcase", classname=name, name=problem.key)
            ET.SubElement(case, "error", message=str(problem), type="unusable input")
    ET.indent(top)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + ET.tostring(top, encoding="unicode") + "\n"


def _suite(top: ET.Element, path: str, group: str, result: list[Annotation]) -> None:
    levels = [one.level for one in result]
    suite = ET.SubElement(
        top,
        "testsuite",
        name=group,
        tests=str(len(result) - levels.count(Level.REMARK)),
        failures=str(levels.count(Level.FAILED)),
        skipped=str(levels.count(Level.UNDECIDED)),
        errors="0",
    )
    place = ".".join(part for part in (path, group) if part)
    for one in result:
        if one.level is Level.REMARK:
            continue
        name = " ".join(part for part in (f"({one.rule})", one.case) if part)
        case = ET.SubElement(suite, "testcase", classname=place, name=name)
        if one.level is Level.FAILED:
            ET.SubElement(case, "failure", message=one.message, type=one.level.value)
        elif one.level is Level.UNDECIDED:
            ET.SubElement(case, "skipped", message=one.message)
    said = [one.message for one in result if one.level is Level.REMARK]
    if said:
        ET.SubElement(suite, "system-out").text = "\n".join(said)
