"""Formulas that SymPy has derived, as text of several lines and in LaTeX."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from sympy.printing.latex import latex
from sympy.printing.pretty.pretty import PrettyPrinter
from sympy.printing.pretty.stringpict import prettyForm
from sympy.printing.str import sstr

from lyapcheck.output.document import Block, Equation, Paragraph

COLUMNS = 74
"""Of a formula in a terminal, beside its indent."""


@dataclass(frozen=True)
class Formula:
    """One formula ``name = value``.

    Args:
        id: its number in the paper, or a word.
        says: what it is.
        name: the left side in letters.
        head: the left side in LaTeX.
        value: the right side, a SymPy expression.
    """

    id: str
    says: str
    name: str
    head: str
    value: Any

    def blocks(self) -> tuple[Block, ...]:
        """What it is, and the formula."""
        shown = PrettyPrinter({"use_unicode": True})._print(self.value)
        whole = prettyForm(*prettyForm(f"{self.name} = ").right(shown))
        text = whole.render(num_columns=COLUMNS, wrap_line=True, use_unicode=True)
        lines = "\n".join(line.rstrip() for line in text.splitlines())
        equation = Equation(lines, f"{self.head} = {latex(self.value)}")
        return (Paragraph(self.says), equation) if self.says else (equation,)

    def data(self) -> dict[str, Any]:
        """The formula as SymPy reads it, and in LaTeX."""
        return {"id": self.id, "name": self.name, "sympy": sstr(self.value), "latex": latex(self.value)}
