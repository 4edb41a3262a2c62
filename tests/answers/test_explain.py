"""Claims explained: every claim there is, in every format, and statements that read as they are decided."""

import csv
import io
import re
from dataclasses import replace
from fractions import Fraction

import mpmath
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lyapcheck.answers.check.run import paper_case_data
from lyapcheck.answers.explain import explain
from lyapcheck.check.expressions.expression import variables
from lyapcheck.check.expressions.text import expression_text
from lyapcheck.claims import var
from lyapcheck.claims.claim import Case, Lacking
from lyapcheck.claims.script import SHIPPED, find_script, load_proof
from lyapcheck.claims.statements import AllOf
from lyapcheck.errors import InputError
from lyapcheck.output.document import Bullets
from tests.oracle.numbers import Undefined, Unsure, constant, lifted
from tests.oracle.trees import Evaluation

pytestmark = pytest.mark.usefixtures("in_this_process")


def test_claims_of_every_proof_are_explained():
    every = [(script, known) for script in SHIPPED for known in load_proof(find_script(script)).claims]
    for script, known in every[::61]:
        result = explain(known, script)
        assert result.id == known
        assert result.says
        assert result.lacking or (result.parts and result.procedures)
        lines = str(result).splitlines()
        assert lines[0].startswith(f"{known}: “")
        assert max(map(len, lines)) <= 100, "combining accents take no column"
        assert not any(line != line.rstrip() for line in lines)


def test_a_script_is_found_by_the_claim_alone():
    assert explain("16.6").script == "published.py"
    assert explain("A.gamma").script == "asymptotics.py"


@pytest.mark.parametrize(
    ("written", "meant"), [("(19)", "19"), (" 7A ", "7a"), ("p", "P"), ("a.GAMMA", "A.gamma")]
)
def test_an_id_may_be_written_loosely(written, meant):
    assert explain(written).id == meant


@pytest.mark.parametrize(
    ("written", "words"),
    [
        ("16_6", "did you mean 16.6"),
        ("T1", "did you mean T1.torque.m1.base"),
        ("nonsense", "id = nonsense: no claim has this id; lyapcheck explain lists the ids"),
        ("", "no claim has this id"),
    ],
)
def test_an_unknown_id_is_refused_with_the_likely_ones(written, words):
    with pytest.raises(InputError, match=re.escape(words)):
        explain(written)


def test_the_text_is_cited_by_authors_and_year_where_the_bibliography_knows_it():
    of_a_script = explain("7a")
    for reference, cited in (
        ("tomei1991adaptive", "Tomei (1991)"),
        ("santibanez1997strict", "Santibáñez and Kelly (1997)"),
        ("kelly2005control", "Kelly et al. (2005)"),
        ("my thesis, p. 3 (draft", "my thesis, p. 3 (draft"),
    ):
        assert f"(7) of {cited}; claimed in " in str(replace(of_a_script, reference=reference, place="(7)"))


def test_lists_of_how_it_is_decided_stay_lists():
    (section,) = [block for block in explain("7b").document().details if block.title == "How it is decided"]
    first, rules, last = section.blocks
    assert isinstance(rules, Bullets)
    assert [item[:5] for item in rules.items] == ["k = 0", "k = 1"]
    assert first.text.startswith("Bounds ‖")
    assert last.text.startswith("Try the vectors that are worst")


def test_what_cannot_be_decided_says_why():
    result = explain("18.gains")
    assert (result.parts, result.procedures) == ((), ())
    assert "take a smaller K_v" in str(result)
    (row,) = csv.DictReader(io.StringIO(result.written("csv")))
    assert (row["id"], row["statement"]) == ("18.gains", result.lacking)


x, y = var("x"), var("y")


trees = st.recursive(
    st.one_of(
        st.sampled_from([("var", "x"), ("var", "y"), ("pi",), ("gamma", 2), ("rho", 2), ("L", 3)]),
        st.fractions(min_value=-3, max_value=3, max_denominator=40).map(lambda q: ("num", str(q))),
    ),
    lambda part: st.one_of(
        st.tuples(st.just("add"), part, part, part),
        st.tuples(st.just("add"), part, part),
        st.tuples(st.just("mul"), part, part),
        st.tuples(st.just("div"), part, part),
        st.tuples(st.just("neg"), part),
        st.tuples(st.sampled_from(["sin", "atan", "tanh"]), part),
        st.tuples(st.just("pow"), part, st.integers(0, 3)),
    ),
    max_leaves=12,
)


@given(tree=trees)
def test_brackets_are_where_they_must_be(tree):
    """The text, read again by Python's grammar, has the value of the expression."""
    assert variables(tree) <= {"x", "y"}
    with mpmath.workdps(40):
        try:
            expected = lifted(Evaluation(POINT).of(tree)).low
        except (Undefined, Unsure):
            return
        assert mpmath.almosteq(reread(expression_text(tree)), expected, 1e-9, 1e-9)


POINT = {"x": Fraction("0.37"), "y": Fraction("-1.9")}


def reread(text):
    text = re.sub(
        "[⁰¹²³⁴⁵⁶⁷⁸⁹]+", lambda k: "**" + k[0].translate(str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹", "0123456789")), text
    )
    for a, b in (("−", "-"), ("·", "*"), ("π", "pi"), ("γ", "gamma"), ("ρ", "rho")):
        text = text.replace(a, b)
    text = re.sub(r"(?<![\w.])(\d+(?:\.\d+)?)", r"mpf('\1')", text)
    text = re.sub(r"\*\*mpf\('(\d+)'\)", r"**\1", text)
    known = POINT | {f"{kind}_{m}": constant(kind, m) for kind, m in (("gamma", 2), ("rho", 2), ("L", 3))}
    names = {name: lifted(number).low for name, number in known.items()}
    functions = {name: getattr(mpmath, name) for name in ("sin", "atan", "tanh", "mpf")}
    return eval(text, {"__builtins__": {}}, {**names, **functions, "pi": +mpmath.pi})


def test_the_statements_of_every_proof_can_be_written_out():
    case, written = Case(*paper_case_data(2)), 0
    for script in SHIPPED:
        for claim in load_proof(find_script(script)).claims.values():
            try:
                statement = claim.statement(case)
            except Lacking:
                continue
            parts = statement.parts if isinstance(statement, AllOf) else (("", statement),)
            written += any(part.text() for _, part in parts)
    assert written > 100
