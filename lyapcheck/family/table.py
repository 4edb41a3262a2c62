"""The table of γ_m, ρ_m and L_m, as data and as text, JSON, CSV, Markdown or LaTeX."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from lyapcheck.check.constants import Constants, gamma_less_than, hyperbolic_constants
from lyapcheck.check.enclosure import Enclosure

SCHEMA = "lyapcheck/table/1"
VALUES = ("gamma", "rho", "L")
PLACES = ("gamma_at", "rho_at", "L_at")
PRINTED_GAMMA = {1: Fraction(1), 2: Fraction(105, 100), 3: Fraction(111, 100)}
"""The γ_m that the paper prints after (7)."""

LIMITS = (
    "For m → ∞: γ → √2, ρ = m − 1/2 + O(1/m), L → √2/asinh 1 = 1.6045…; "
    "lyapcheck check asymptotics.py --m … proves how fast."
)

_GUARD_DIGITS = 6


@dataclass(frozen=True)
class Budget:
    """What an arm leaves to k_p + k_v: (τmax − k_g)/(√n γ) of each joint, N·m, a tuple a row of the table.

    ``None`` where a joint has no torque limit, or none above its gravity torque.
    """

    robot: str
    joints: tuple[str, ...]
    rows: tuple[tuple[Enclosure | None, ...], ...]


@dataclass(frozen=True)
class Table:
    """Certified constants of members of the hyperbolic family, to a number of significant digits."""

    digits: int
    rows: tuple[Constants, ...]
    budget: Budget | None = None


def build_table(
    members: Sequence[int], digits: int, on_progress: Callable[[float, str], None] | None = None
) -> Table:
    """The constants of each member, enclosed a few digits tighter than they are shown."""
    rows, step = [], 1 + len(members) // 10
    for done, m in enumerate(members):
        if on_progress and done and done % step == 0:
            on_progress(done / len(members), f"m = {m}")
        rows.append(hyperbolic_constants(m, digits + _GUARD_DIGITS))
    return Table(digits, tuple(rows))


def as_text(table: Table) -> str:
    """Two blocks of aligned columns: the constants, and where each is reached."""
    legend = (
        "Constants of h_m(x) = sinh^(2m-1)x cosh x / (1 + sinh^(2m)x), certified.",
        "γ = sup h_m   ρ = sup |h_m'|   L = sup h_m(x)/x.   Digits are cut off, not rounded.",
    )
    values = _aligned(("m", "γ", "ρ", "L"), _shown(table, VALUES))
    places = _aligned(("m", "x of γ", "x of ρ", "x of L"), _shown(table, PLACES))
    blocks = ["\n".join(legend), values, places]
    if table.budget is not None:
        blocks += [_budget_title(table.budget), _aligned(("m", *table.budget.joints), _budget_cells(table))]
    blocks.append("\n".join(_notes(table)))
    return "\n\n".join(block for block in blocks if block) + "\n"


def as_json(table: Table) -> str:
    """The rows with bounds as decimal strings that enclose; ``null`` for a place at infinity."""
    rows = [_row(row, table.digits) for row in table.rows]
    if table.budget is None:
        return json.dumps({"schema": SCHEMA, "digits": table.digits, "rows": rows}, indent=2) + "\n"
    for row, limits in zip(rows, table.budget.rows, strict=True):
        row["budget"] = [
            {"joint": joint, "limit": _bounds(limit, table.digits)}
            for joint, limit in zip(table.budget.joints, limits, strict=True)
        ]
    document = {"schema": SCHEMA, "digits": table.digits, "robot": table.budget.robot, "rows": rows}
    return json.dumps(document, ensure_ascii=False, indent=2) + "\n"


def as_csv(table: Table) -> str:
    """A line for each m, with a lower and an upper column for each quantity; empty at infinity."""
    names = VALUES + PLACES
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    joints = [f"budget_{joint}" for joint in table.budget.joints] if table.budget else []
    writer.writerow(["m", *(f"{name}_{end}" for name in (*names, *joints) for end in ("lower", "upper"))])
    for index, row in enumerate(table.rows):
        values = [getattr(row, name) for name in names]
        values += table.budget.rows[index] if table.budget else []
        writer.writerow([row.m, *(end for value in values for end in _ends(value, table.digits))])
    return text.getvalue()


def as_markdown(table: Table) -> str:
    """One Markdown table, all digits correct."""
    heads = ("m", "γ", "ρ", "L", "x of γ", "x of ρ", "x of L")
    lines = [_piped(heads), _piped(["---:"] * len(heads))]
    lines += [_piped(cells) for cells in _shown(table, VALUES + PLACES)]
    if table.budget is not None:
        joints = ("m", *table.budget.joints)
        lines += ["", _budget_title(table.budget), "", _piped(joints), _piped(["---:"] * len(joints))]
        lines += [_piped(cells) for cells in _budget_cells(table)]
    return "\n".join([*lines, "", *_notes(table)]).rstrip("\n") + "\n"


def as_latex(table: Table) -> str:
    """A ``tabular`` environment, all digits correct."""
    heads = (r"$m$", r"$\gamma_m$", r"$\rho_m$", r"$L_m$", r"$x_\gamma$", r"$x_\rho$", r"$x_L$")
    blocks = _tabular(heads, _shown(table, VALUES + PLACES))
    if table.budget is not None:
        joints = [joint.replace("_", r"\_") for joint in table.budget.joints]
        blocks += ["", *_tabular(["$m$", *joints], _budget_cells(table))]
    return "\n".join(blocks) + "\n"


RENDERERS: dict[str, Callable[[Table], str]] = {
    "text": as_text,
    "json": as_json,
    "csv": as_csv,
    "markdown": as_markdown,
    "latex": as_latex,
}


def _shown(table: Table, names: Iterable[str]) -> list[list[str]]:
    """The cells of each row: m and the correct digits of each quantity."""
    names = tuple(names)
    return [[str(row.m), *(_cell(getattr(row, name), table.digits) for name in names)] for row in table.rows]


def _cell(value: Enclosure | None, digits: int) -> str:
    return "∞" if value is None else value.correct_digits(digits)


def _ends(value: Enclosure | None, digits: int) -> tuple[str, str]:
    return ("", "") if value is None else value.decimals(digits)


def _budget_title(budget: Budget) -> str:
    return f"Torque budget of {budget.robot}: k_p + k_v < (τmax − k_g)/(√n γ), N·m."


def _budget_cells(table: Table) -> list[list[str]]:
    """The cells of each row: m and the budget of each joint."""
    limits = table.budget.rows if table.budget else ()
    return [
        [str(row.m), *("none" if value is None else value.correct_digits(table.digits) for value in values)]
        for row, values in zip(table.rows, limits, strict=True)
    ]


def _tabular(heads: Sequence[str], rows: list[list[str]]) -> list[str]:
    """The lines of a ``tabular`` environment."""
    body = [" & ".join(cells).replace("∞", r"$\infty$") + r" \\" for cells in rows]
    columns = "r" + "l" * (len(heads) - 1)
    head = [rf"\begin{{tabular}}{{{columns}}}", r"\hline", " & ".join(heads) + r" \\", r"\hline"]
    return [*head, *body, r"\hline", r"\end{tabular}"]


def _bounds(value: Enclosure | None, digits: int) -> dict[str, str] | None:
    return None if value is None else dict(zip(("lower", "upper"), value.decimals(digits), strict=True))


def _row(row: Constants, digits: int) -> dict[str, Any]:
    bounds = {name: _bounds(getattr(row, name), digits) for name in VALUES + PLACES}
    return {"m": row.m, **bounds, "gamma_printed": _printed(row.m)}


def _printed(m: int) -> dict[str, Any] | None:
    """The γ_m printed in the paper, and whether it really bounds h_m; ``None`` where none is printed."""
    value = PRINTED_GAMMA.get(m)
    if value is None:
        return None
    return {"value": f"{float(value):g}", "bounds_h": _printed_bounds(m)}


def _printed_bounds(m: int) -> bool:
    """Whether h_m never exceeds the printed γ: tanh stays below 1, the others reach their γ."""
    value = PRINTED_GAMMA[m]
    return value >= 1 if m == 1 else gamma_less_than(m, value**2)


def _notes(table: Table) -> list[str]:
    """A line for each printed γ in the table, and one for what the constants tend to."""
    known = [row.m for row in table.rows if row.m in PRINTED_GAMMA]
    printed = [
        f"The paper prints γ_{m} = {float(PRINTED_GAMMA[m]):g}: "
        + ("an upper bound of h." if _printed_bounds(m) else "not an upper bound, h exceeds it.")
        for m in known
    ]
    return [*printed, LIMITS]


def _aligned(heads: Sequence[str], rows: list[list[str]]) -> str:
    widths = [max(map(len, column)) for column in zip(heads, *rows, strict=True)]
    lines = [_padded(heads, widths), "  ".join("─" * width for width in widths)]
    return "\n".join(lines + [_padded(row, widths) for row in rows])


def _padded(cells: Sequence[str], widths: Sequence[int]) -> str:
    first, *rest = zip(cells, widths, strict=True)
    return "  ".join([first[0].rjust(first[1]), *(cell.ljust(width) for cell, width in rest)]).rstrip()


def _piped(cells: Iterable[str]) -> str:
    return f"| {' | '.join(cells)} |"
