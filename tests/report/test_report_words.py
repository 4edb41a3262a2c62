"""What a report says: words of proof by promises alone, and words for extreme results."""

import json
import re
from dataclasses import replace
from random import Random

import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

from lyapcheck.report.build import render
from lyapcheck.report.document import ReportAnswer
from tests.helpers.redrawn import other
from tests.helpers.words_of_proof import promises_as_seen, said, values, words_of_proof


@pytest.mark.slow
def test_every_word_of_proof_in_a_report_is_a_promise(report):
    """But those of the gate, which a test of its own holds to promises, and what people have written."""
    rows = report.every_claim
    written = {*said(report.gate), *report.notes.known}
    written |= {text for row in rows for text in (row.id, row.section, row.heading, row.kind, *row.uses)}
    written |= {text for row in rows for text in (row.title, row.comment)}
    written |= {text for row in rows if row.decision.promise is None for text in values(row.data())}
    written |= {text for row in rows for text in row.decision.rules} | set(report.certificates)
    written |= {box.title for box in (*report.notes.chain, *report.notes.route)}
    for finding in report.findings:
        written |= {
            *values(vars(finding) | vars(finding.note)),
            *(f"{term}: {text}" for term, text in finding.about.items()),
        }
    with promises_as_seen():
        left = {text for text in said(ReportAnswer(report)) if words_of_proof(text)} - written
    assert not left


@pytest.mark.slow
@settings(
    max_examples=10,
    deadline=None,
    derandomize=True,
    phases=(Phase.generate,),
    suppress_health_check=list(HealthCheck),
)
@given(st.integers(0, 2**32))
def test_reports_have_words_for_extreme_results(report, seed):
    draw = Random(seed).choice
    rows = {name: other(getattr(report, name), draw) for name in ("epsilon", "runs", "findings")}
    text = render(replace(report, **rows))
    json.loads(str(text["report.json"]))
    assert not re.findall(r"\b(?:nan|inf)\b", str(text["report.md"]))
