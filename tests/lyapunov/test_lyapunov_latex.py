"""The LaTeX of every formula becomes well-formed MathML."""

from __future__ import annotations

from xml.etree import ElementTree

import pytest
from latex2mathml.converter import convert

from lyapcheck.lyapunov.latex import latex_forms, latex_sum
from lyapcheck.lyapunov.printed import PRINTED_14, PRINTED_15, Term


@pytest.mark.parametrize("name", sorted(latex_forms()))
def test_each_form_is_one_well_formed_formula(name: str) -> None:
    text = latex_forms()[name]
    assert ElementTree.fromstring(convert(text)).tag.endswith("math")
    assert text.count("{") == text.count("}")
    assert "aligned" not in text


@pytest.mark.parametrize("term", [*PRINTED_14, *PRINTED_15], ids=lambda term: f"{term.number}{term.matrix}")
def test_each_printed_term_is_well_formed(term: Term) -> None:
    ElementTree.fromstring(convert(term.latex))


def test_a_sum_starts_without_a_plus() -> None:
    assert latex_sum(PRINTED_14).startswith(r"\dot q^T K_p")
    assert latex_sum(PRINTED_15).startswith("- ")
