"""The table of constants as LaTeX ``tabular`` environments."""

from __future__ import annotations

from lyapcheck.escapes import latex_text
from lyapcheck.family.table import Table
from lyapcheck.family.table_formats.blocks import INFINITY, Block, constants, others

HEADS = {
    "m": r"$m$",
    "γ": r"$\gamma_m$",
    "ρ": r"$\rho_m$",
    "L": r"$L_m$",
    "x of γ": r"$x_\gamma$",
    "x of ρ": r"$x_\rho$",
    "x of L": r"$x_L$",
    "h′(0)": r"$h_m'(0)$",
    "γ leading": r"$\bar\gamma_m$",
    "γ − leading": r"$\gamma_m-\bar\gamma_m$",
    "ρ leading": r"$\bar\rho_m$",
    "ρ − leading": r"$\rho_m-\bar\rho_m$",
    "L leading": r"$\bar L_m$",
    "L − leading": r"$L_m-\bar L_m$",
}
"""The heads of the columns; those that are not here are names of joints."""


def render(table: Table) -> str:
    """The constants, then what was asked for beside them; all digits correct."""
    blocks = [constants(table), *others(table)]
    return "\n\n".join("\n".join(_tabular(block)) for block in blocks) + "\n"


def _tabular(block: Block) -> list[str]:
    """The lines of a ``tabular`` environment."""
    heads = [HEADS.get(head) or latex_text(head) for head in block.heads]
    body = [" & ".join(cells).replace(INFINITY, r"$\infty$") + r" \\" for cells in block.rows]
    columns = "r" + "l" * (len(heads) - 1)
    head = [rf"\begin{{tabular}}{{{columns}}}", r"\hline", " & ".join(heads) + r" \\", r"\hline"]
    return [*head, *body, r"\hline", r"\end{tabular}"]
