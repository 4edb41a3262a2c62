"""Proof scripts whose words would steer a terminal, a page, a spreadsheet or a CI system."""

import pytest

from lyapcheck.answers.explain import explain
from lyapcheck.answers.recheck import Recheck
from lyapcheck.check.recheck import gather, recheck
from lyapcheck.claims import run_proof
from lyapcheck.output.answer import FORMATS, JUDGED_FORMATS
from tests.answers.test_hostile_names import CHECKS, NASTY

pytestmark = pytest.mark.usefixtures("in_this_process")

SCRIPT = """
from lyapcheck.claims import *
proof = Proof({title!r}, {title!r})
for k, words in enumerate({words!r}):
    about = dict(section=words, place=words)
    proof.add(f"{{k}} {{words}}", words, Constant(expr(k % 2) <= 0), **about)
proof.add("last", " ".join({words!r}), Constant(expr(0) <= 1), uses=["1 " + {words!r}[1]])
"""


@pytest.fixture(scope="module")
def script(tmp_path_factory):
    path = tmp_path_factory.mktemp("nasty") / "mine.py"
    path.write_text(SCRIPT.format(title=" ".join(NASTY), words=NASTY), encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def result(script):
    return run_proof(script, ms=(1,), n=1)


@pytest.mark.parametrize("form", JUDGED_FORMATS)
def test_no_format_of_check_obeys_an_author(form, result):
    assert [row.verdict.value for row in result.claims[:2]] == ["proved", "refuted"]
    check(form, result.written(form))


@pytest.mark.parametrize("form", FORMATS)
def test_no_format_of_explain_obeys_an_author(form, script):
    check(form, explain("last", str(script)).written(form))


@pytest.mark.parametrize("form", JUDGED_FORMATS)
def test_no_format_of_recheck_obeys_an_author(form, result, tmp_path):
    for k, certificate in enumerate(result.certificates.values()):
        (tmp_path / f"{k}|<script>_$&%#^~[x]`*.json").write_text(certificate.text(), encoding="utf-8")
    outcome = Recheck(recheck(gather([tmp_path])))
    assert outcome.outcome.code == 0
    check(form, outcome.written(form))


def check(form, text):
    """What a format must hold, and nothing that does not print."""
    assert text.replace("\n", "").isprintable()
    CHECKS[form](text)
