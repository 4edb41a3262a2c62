"""What a report says: words of proof by promises alone, and words for extreme results."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import Any

import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

from lyapcheck.promise import promises_as_seen
from lyapcheck.report.document import ReportAnswer
from lyapcheck.report.model import Report
from lyapcheck.report.write import render
from tests.helpers.redrawn import other
from tests.house.test_promises import said, words_of_proof


def of_others(report: Report) -> set[str]:
    """What the gate says, which its own test holds to its promises, and what people have written."""
    notes = json.dumps(ReportAnswer(report).data()["findings"], ensure_ascii=False)
    known = {*said(report.gate), *report.notes.known, notes}
    return known | {
        text for row in report.every_claim for text in (row.id, row.section, row.heading, *row.uses)
    }


@pytest.mark.slow
def test_every_word_of_proof_in_a_report_is_a_promise(report: Report) -> None:
    others = of_others(report)
    titles = {row.title for row in report.every_claim} | {row.comment for row in report.every_claim}
    with promises_as_seen():
        texts = [text for text in said(ReportAnswer(report)) if text not in others | titles]
        left = [text for text in texts if words_of_proof(text) and text not in json.dumps(others_of(report))]
    assert not left


def others_of(report: Report) -> list[Any]:
    return [vars(finding) for finding in report.findings]


@pytest.mark.slow
@settings(
    max_examples=10,
    deadline=None,
    derandomize=True,
    phases=(Phase.generate,),
    suppress_health_check=list(HealthCheck),
)
@given(st.data())
def test_reports_have_words_for_extreme_results(report: Report, data: st.DataObject) -> None:
    def draw(values: Any) -> Any:
        return data.draw(st.sampled_from(list(values)))

    rows = {name: other(getattr(report, name), draw) for name in ("epsilon", "runs", "findings")}
    text = render(replace(report, **rows))
    json.loads(str(text["report.json"]))
    assert "nan" not in str(text["report.md"]).split()
