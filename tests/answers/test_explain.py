"""Claims explained: every claim there is, in every format, and statements that read as they are decided."""

import csv
import io
import json
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
from lyapcheck.claims import cosh, dh, expr, gamma, h, log, potential, rho, secant_bound, sqrt, tanh, var
from lyapcheck.claims.claim import Case, Lacking
from lyapcheck.claims.script import SHIPPED, find_script, load_proof
from lyapcheck.claims.statements import AllOf
from lyapcheck.errors import InputError
from lyapcheck.output.document import Bullets
from lyapcheck.output.text import Depth, View
from tests.helpers.command import invoke
from tests.oracle.numbers import Undefined, Unsure, constant, lifted
from tests.oracle.trees import Evaluation

pytestmark = pytest.mark.usefixtures("in_this_process")


def run(*arguments):
    return invoke("explain", *arguments)


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


@pytest.mark.slow
def test_what_is_printed_answers_the_five_questions():
    out = run("16.9", "-v").stdout
    places = [
        out.index(text)
        for text in (
            "✓ 16.9: proved for m = 1, 2, 3\n",
            "  “½ε² hᵀ(C+Cᵀ)h ≤ ε ε₀ n γ² k_c ‖q̃‖‖q̇‖” (the author's words)\n",
            "  (16), term 9 of Reyes-Cortés et al. (2019); claimed in published.py\n",
            "What is decided, for m = 2, n = 3\n",
            "How it is decided\n",
            "Upper bounds for every n: each term in words",
            "What it uses\n",
            "\n2.6    a constant k_c gives ‖C(q,x)y‖ ≤ k_c ‖x‖ ‖y‖\n",
            "What uses it\n",
            "\n16     dV/dt ≤ ",
            "\n  next: lyapcheck check published.py --only 16.9\n",
        )
    ]
    assert places == sorted(places)


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


def test_a_flow_is_explained_with_its_obligations_and_sums_of_squares_with_their_rule():
    flow, identity, implication = explain("P", "textbook.py").procedures
    assert "every part p is 0 wherever dV/dt" in " ".join(flow.split()).replace("Every", "every")
    assert identity.startswith("Identities")
    assert "both hypotheses, they are an equation" in " ".join(implication.split())
    assert "then for sums of squares" in implication


def test_what_cannot_be_decided_says_why():
    result = explain("18.gains")
    assert (result.parts, result.procedures) == ((), ())
    assert "take a smaller K_v" in str(result)
    (row,) = csv.DictReader(io.StringIO(result.written("csv")))
    assert (row["id"], row["statement"]) == ("18.gains", result.lacking)


@pytest.mark.parametrize(
    ("known", "says"),
    [
        ("7a", "‖(h_2(x))ᵢ‖ ≤ √3·γ_2 for all x in R^3"),
        ("T1.torque.m2.elbow", "150 = 15"),
        ("T2.19.m2.true", "0.223 < 0.406/(√3·γ_2)"),
        ("S4.norm.m1", "√(e1² + e2² + e3²) is 0.5934 for e1 = −0.5774, e2 = 0.1272, e3 = −0.051"),
    ],
)
def test_the_statement_that_is_decided_is_written_out(known, says):
    parts = " ".join(part.says for part in explain(known).parts)
    assert says in parts


def test_a_theorem_is_written_out_with_its_condition_and_the_bound_of_the_rate():
    (part,) = explain("P").parts
    assert "Lyapunov's direct method" in part.says
    assert "h_reach·Kv_max < B_min" in part.says
    assert "dV/dt ≤ −(" in part.says
    assert "globally asymptotically stable" in part.says


def test_json_and_markdown_hold_the_same():
    result, says = explain("12d"), "the printed derivative is the derivative of h_m"
    data = json.loads(run("12d", "--format", "json").stdout)
    assert data["schema"] == "lyapcheck/explain/1"
    assert data["uses"] == [{"id": "8", "says": says}]
    assert [part["name"] for part in data["parts"]] == [part.name for part in result.parts]
    assert data["run"] == "lyapcheck check published.py --only 12d"
    shown = result.written("markdown")
    assert shown.startswith("# 12d: ")
    assert f"| 8 | {says} |" in shown
    assert data["run"] in shown


def test_a_notebook_gets_the_statement_and_what_it_uses():
    result = explain("7a")
    shown = result._repr_html_()
    assert "<p>‖(h_2(x))ᵢ‖ ≤ √3·γ_2" in shown
    tables = (result.uses, result.used_by, result.near)
    assert all(tables)
    assert shown.count("<tr>") == 3 + sum(map(len, tables))


def test_other_claims_about_the_same_formula_are_named():
    assert {"19n", "19.gains", "T2.19.m2.true"} < {name for name, _ in explain("19").near}
    assert "Also about (16)\n" in explain("16.6").written("text", View(Depth.VERBOSE))
    assert explain("2.7").near == ()


x, y = var("x"), var("y")


@pytest.mark.parametrize(
    ("expression", "text"),
    [
        (x + y - 1, "x + y − 1"),
        (x - (y - 1), "x − (y − 1)"),
        (-(x + 1) * y, "(−(x + 1))·y"),
        (x / (y * 2), "x/(y·2)"),
        (x / y / 2, "x/y/2"),
        ((x / 2) ** 3, "(x/2)³"),
        (expr("-1/3") ** 2, "(−1/3)²"),
        (sqrt(3) * gamma(2), "√3·γ_2"),
        (sqrt(x + 1), "√(x + 1)"),
        (sqrt(x) ** 2, "(√x)²"),
        (1 / sqrt(x**2), "1/√(x²)"),
        (abs(x) * tanh(y), "|x|·tanh(y)"),
        (h(3, x) - dh(3, x), "h_3(x) − h_3′(x)"),
        (log(cosh(x)) + potential(1, y), "ln(cosh(x)) + U_1(y)"),
        (expr("0.223") * rho(1) + secant_bound(4), "0.223·ρ_1 + L_4"),
        (x**12, "x¹²"),
    ],
)
def test_expressions_read_as_one_writes_them(expression, text):
    assert expression_text(expression.tree) == text


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
