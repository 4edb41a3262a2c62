"""A report prints what SymPy derives, typeset, beside what the checker says of it."""

import pytest

from lyapcheck.answers.derive import derivation
from lyapcheck.answers.gate import GateAnswer
from lyapcheck.answers.table import build_table
from lyapcheck.report.build import render
from lyapcheck.report.jobs import derive_job
from lyapcheck.report.model import Report, published_notes
from lyapcheck.robots import load

TITLE = "What SymPy derives, and what the checker says of it"


@pytest.fixture(scope="module")
def report():
    empty = dict.fromkeys(("epsilon", "claims", "others", "by_size", "runs", "findings"), ())
    return Report(
        robot=load("reyes-kelly2"),
        ms=(2,),
        notes=published_notes(),
        own=True,
        table=build_table((2,)),
        derived=derive_job((2,), "reyes-kelly2"),
        gate=GateAnswer(()),
        figures={},
        **empty,
    )


@pytest.fixture(scope="module")
def files(report):
    return {name: str(content) for name, content in render(report).items()}


def test_the_page_has_it_as_formulas_with_the_comparison_above(files):
    section = files["index.html"].split('<section id="derive">')[1].split("</section>")[0]
    assert TITLE in section
    assert section.index("dV/dt: the terms of (15) add up") < section.index("<math")
    assert section.count('display="block"') == len(derivation(2).data()["formulas"])
    assert 'href="#derive"' in files["index.html"]


def test_members_that_sympy_takes_too_long_for_are_left_out():
    assert derive_job((1, 41), "pendulum1").ms == (1,)
