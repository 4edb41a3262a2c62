"""Every format of an answer: what it says is shown, nothing of what it says is obeyed."""

from __future__ import annotations

import json
import re
from dataclasses import dataclass
from importlib import import_module
from xml.etree import ElementTree as ET

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from lyapcheck.output.answer import FORMATS, JUDGED_FORMATS, Annotation, Answer, Level
from lyapcheck.output.document import Bullets, Code, Document, Paragraph, Section, Table
from lyapcheck.output.escapes import document_text, latex_text, printable
from lyapcheck.output.json import LONGEST, laid_out
from lyapcheck.output.text import Depth, View, render
from tests.helpers.letters import letters

NASTY = [
    "<script>alert(1)</script>",
    "<b>&amp;\"'</b>",
    "a|b|c\\",
    "`code` *bold* _it_ ~~no~~ [x](javascript:y) ![z](w) <!-- # -->",
    "a\nb\r\nc",
    "::error file=x,line=1::owned",
    "100%0A, a:b",
    "\x1b[31mred\x07\x00",
    "\u202egnp.exe \u2028 \ufffe \u00a0",
    "λ 关节 🦾",
    "]]> --> %1B",
    "### heading",
    "@everyone #1",
    "=cmd|' /C calc'!A0",
    "$\\frac$ 100% {x} ^ ~ _ &",
]
NAMES = st.one_of(st.sampled_from(NASTY), letters(1, 12))


@dataclass(frozen=True)
class Sample(Answer):
    """An answer with a text in every place that can hold one."""

    schema = "lyapcheck/sample/1"
    name: str

    def document(self):
        name = self.name
        table = Table((name, "value"), ((name, "1"), ("b", name)), name)
        inner = Section(name, (Paragraph(name), table))
        return Document(name, (Bullets((name, name)), Code(name), inner), (name,))

    def data(self):
        return {"results": [{"name": self.name, self.name: {"inner": [self.name, 1, None]}}]}

    def annotations(self):
        return [
            Annotation(
                level, f"rule-{level.value}", self.name, self.name, self.name, self.name, self.name, 3, 5
            )
            for level in Level
        ]


# --- names -------------------------------------------------------------------------------------------


@given(NAMES)
def test_a_text_stays_on_its_lines_in_a_terminal(name):
    text = Sample(name).written("text")
    assert text.replace("\n", "").isprintable()
    assert printable(name).split() == [] or printable(name).split()[0] in text


@given(NAMES)
def test_latex_obeys_nothing(name):
    head = next(line for line in Sample(name).written("latex").splitlines() if line.startswith(r"\section*"))
    inside = head.removeprefix(r"\section*{").removesuffix("}")
    bare = re.sub(r"\\text\w+\{\}|\\ensuremath\{([^{}]|\{[^{}]*\})*\}|\\[&%$#_{}]", "", inside)
    assert not set(bare) & set("\\&%$#_{}~^"), head


def test_latex_writes_signs_of_formulas():
    assert latex_text("γ_2 ≤ √3") == r"\ensuremath{\gamma}\_2 \ensuremath{\le} \ensuremath{\surd}3"
    assert latex_text("q̇ᵀ é") == r"\ensuremath{\dot{q}}\ensuremath{^{T}} é"


@given(NAMES)
def test_json_reads_back(name):
    result = json.loads(Sample(name).written("json"))
    assert result["results"] == Sample(name).data()["results"]
    assert result["schema"] == "lyapcheck/sample/1"
    assert result["version"] == result["versions"]["lyapcheck"]


@given(NAMES)
def test_sarif_keeps_texts_and_leaves_passed_cases_out(name):
    (run,) = json.loads(Sample(name).written("sarif"))["runs"]
    assert [result["level"] for result in run["results"]] == ["error", "warning", "note"]
    for result in run["results"]:
        assert result["message"]["text"] == f"{name}: {name}: {name}"
        assert run["tool"]["driver"]["rules"][result["ruleIndex"]]["id"] == result["ruleId"]
        (place,) = result["locations"]
        assert re.fullmatch(r"[A-Za-z0-9._~/%-]+", place["physicalLocation"]["artifactLocation"]["uri"])
        assert place["physicalLocation"]["region"] == {"startLine": 3, "startColumn": 5}
    assert len({result["partialFingerprints"]["case/v1"] for result in run["results"]}) == 3


@given(NAMES)
@example("\x00\ud7ff\ue000\uffff\t")
def test_junit_shows_what_prints(name):
    """XML 1.0 has no control characters: what does not print comes as an escape, line ends and tabs apart."""
    shown = "".join(c if c in "\n\r\t" else document_text(c) for c in name)
    (suite,) = ET.fromstring(Sample(name).written("junit"))
    assert suite.get("name") == shown
    assert [suite.get(count) for count in ("tests", "failures", "skipped")] == ["3", "1", "1"]
    assert [case.get("name") for case in suite.iter("testcase")] == [
        f"(rule-{level}) {shown}" for level in ("passed", "failed", "undecided")
    ]
    assert suite.findtext("system-out") == document_text(name)


@pytest.mark.parametrize("format", JUDGED_FORMATS)
def test_a_format_ends_its_last_line_and_is_the_same_twice(format):  # noqa: A002
    once = Sample("a").written(format)
    assert once == Sample("a").written(format)
    assert once.endswith("\n")
    assert not once.endswith("\n\n")


def test_what_judges_has_the_formats_of_all_and_three_more():
    assert {*FORMATS} == {*JUDGED_FORMATS} - {"sarif", "junit", "github"}


def test_an_answer_prints_as_text_and_shows_itself_in_a_notebook():
    assert f"{Sample('a')}\n" == Sample("a").written("text")
    assert Sample("a")._repr_html_() == Sample("a").written("html")


def render_as(format, document):  # noqa: A002
    return import_module(f"lyapcheck.output.{format}").render(document)


# --- the terminal ------------------------------------------------------------------------------------

LINES = st.lists(st.text("abcdef", min_size=1, max_size=14), max_size=40).map(" ".join)


@st.composite
def tables(draw):
    columns = draw(st.integers(2, 9))
    align = "".join(draw(st.lists(st.sampled_from("lr"), min_size=columns, max_size=columns)))
    row = st.tuples(*[LINES if side == "l" else st.text("0123.", min_size=1, max_size=9) for side in align])
    heads = draw(st.tuples(*[st.text("abc", min_size=1, max_size=9)] * columns))
    return Table(heads, tuple(draw(st.lists(row, min_size=1, max_size=4))), align=align)


@given(tables(), st.integers(60, 120))
def test_a_table_fits_in_a_terminal_and_numbers_stand_whole(table, width):
    """Columns are left out and words cut off by default; with -v the others follow below."""
    text = render(Document("t", (table,)), View(width=width))
    assert all(len(line) <= width for line in text.splitlines())
    assert len(text.splitlines()) == 3 + len(table.rows)
    whole = render(Document("t", (table,)), View(Depth.VERBOSE, width=width))
    assert all(cell in whole for row in table.rows for cell in row)


def test_columns_are_straight_and_decimal_points_below_each_other():
    table = Table(("joint", "value"), (("base", "1.5"), ("shoulder", "-22.25"), ("关节", "3"), ("x", "none")))
    assert render(Document("t", (table,))).splitlines()[2:] == [
        "joint      value",
        "base        1.5",
        "shoulder  -22.25",
        "关节        3",
        "x           none",
    ]


def test_the_least_important_columns_are_dropped_and_follow_with_more():
    row = ("1", "1" * 40, "2" * 40, "3" * 20)
    table = Table(("m", "a", "b", "c"), (row,), drop=(1,))
    text = render(Document("t", (table,)), View(width=80))
    assert [part in text for part in row] == [True, False, True, True]
    whole = render(Document("t", (table,)), View(Depth.VERBOSE, width=80))
    assert whole.count("m  ") == 2
    assert all(part in whole for part in row)


def test_each_depth_adds_to_the_one_before():
    document = Document("✓ a", (Bullets(("b",)),), ("f",), ("c",), (Code("d"),), "e", "lyapcheck gate 'x y'")
    shown = [render(document, View(depth)) for depth in Depth]
    assert shown[:2] == ["✓ a\n", "✓ a\n  c\n\n- b\n\n  e\n  next: lyapcheck gate 'x y'\n"]
    assert "    d\n" in shown[2]
    assert "- f\n" not in shown[2]
    assert "- f\n" in shown[3]
    for format in ("markdown", "html", "latex"):  # noqa: A001
        assert all(text in render_as(format, document) for text in ("a", "c", "e", "x y"))


def test_rows_of_other_lengths_are_refused():
    with pytest.raises(ValueError, match="different lengths"):
        Table(("a", "b"), (("1",),))


def test_colour_adds_nothing_but_colour():
    table = Table(("", "verdict"), (("✓", "proved"), ("✗", "refuted"), ("?", "undecided")), align="ll")
    document = Document("✗ 1 refuted", (table, Bullets(("proved",))), ("a note",))
    coloured = render(document, View(Depth.EXPLAINED, colour=True))
    assert re.sub(r"\x1b\[\d+m", "", coloured) == render(document, View(Depth.EXPLAINED))
    assert "\x1b[31mrefuted\x1b[0m" in coloured
    assert "- proved" in coloured


# --- JSON --------------------------------------------------------------------------------------------

JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | letters(most=30),
    lambda inner: st.lists(inner, max_size=5) | st.dictionaries(letters(most=9), inner, max_size=5),
    max_leaves=30,
)


@given(JSON)
def test_a_layout_is_the_value(value):
    assert json.loads(laid_out(value)) == value


def test_a_record_stands_on_a_line():
    rows = [{"name": "a", "limit": {"lower": "1", "upper": "2"}}] * 2
    assert laid_out({"rows": rows, "n": 1}).splitlines() == [
        "{",
        '  "rows": [',
        '    {"name": "a", "limit": {"lower": "1", "upper": "2"}},',
        '    {"name": "a", "limit": {"lower": "1", "upper": "2"}}',
        "  ],",
        '  "n": 1',
        "}",
    ]
    assert max(map(len, laid_out([["x" * 30] * 40]).splitlines())) < LONGEST


@dataclass(frozen=True)
class Number(Answer):
    """An answer with data that are no list of results."""

    schema = "lyapcheck/number/1"

    def document(self):
        return Document("one", ())

    def data(self):
        return {"number": 1}


@pytest.mark.parametrize("name", FORMATS)
def test_data_without_results_are_one_row(name):
    assert Number().written(name)
    assert [dict(row) for row in Number().records()] == [{"number": 1}]
