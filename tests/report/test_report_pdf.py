"""The report on paper: a few pages, the same bytes, nothing obeyed."""

import re

import pytest

from lyapcheck.output.document import Bullets, Code, Document, Equation, Figure, Paragraph, Section, Table
from lyapcheck.report.pdf import markup, quoted

typst = pytest.importorskip("typst")
NASTY = [
    '#read("/etc/passwd")',
    '"; #panic("x")',
    "\\",
    "$x$ *b* _i_ `c` @r <l> // c",
    "a\nb\x1b",
    "λ 关节 🦾",
]


@pytest.mark.parametrize("text", NASTY)
def test_a_text_is_a_literal(text, tmp_path):
    assert re.fullmatch(r'"(?:[^"\\]|\\["\\])*"', quoted(text))
    table = Table((text, "b"), ((text, text),), text)
    document = Document(text, (Paragraph(text), Bullets((text,)), Code(text), Section(text, (table,))))
    source = tmp_path / "a.typ"
    source.write_text(markup(document, text), encoding="utf-8")
    first, second = (typst.compile(str(source), root=str(tmp_path), ignore_system_fonts=True) for _ in "ab")
    assert first == second
    assert first.startswith(b"%PDF")


def test_a_drawing_that_ends_words_stands_beside_them_and_one_below_a_table_does_not():
    words, drawing = Paragraph("words"), Figure("figures/a.svg", "a")
    table = Table(("head",), (("cell",),))
    for blocks, beside in (((words, drawing), True), ((table, drawing), False), ((drawing,), False)):
        text = markup(Document("title", (Section("section", blocks),)), "running")
        assert ("#grid(" in text) is beside, blocks


def test_no_sheet_ends_inside_a_formula():
    for block, whole in ((Equation("a\nb", "x"), True), (Code("a\nb"), False)):
        text = markup(Document("title", (block,)), "running")
        assert ("breakable: false, raw(" in text) is whole
