"""The cells that the formats for people share: tables of correct digits, and the notes under them."""

from __future__ import annotations

from dataclasses import dataclass

from lyapcheck.check.numbers.constants import Constants
from lyapcheck.check.numbers.enclosure import Enclosure
from lyapcheck.family.table import PRINTED_GAMMA, Table, printed_bounds, slope_at_zero

INFINITY, NONE = "∞", "none"
REST_DIGITS = 6

LIMITS = (
    "For m → ∞: γ → √2, ρ = m − 1/2 + O(1/m), L → √2/asinh 1 = 1.6045…; "
    "lyapcheck check every_m.py proves it for all m, asymptotics.py --m … how fast for each."
)
LEADING = (
    "Leading terms for m → ∞: γ ~ √2 (1 − (1 + ln 4m)/(4m)), ρ ~ m − 1/2 + 9/(16m), "
    "L ~ √2/asinh 1 · (1 − κ (1 + ln(m/κ))/m) with κ = (1 + √2/asinh 1)/4."
)

RESTS = (
    "Proved by every_m.py: 3/32 < (γ − leading) m²/(√2 ln² 4m) < 1/6 for all m ≥ 2, −3/4 < (ρ − leading) m² "
    "< 0 for all m ≥ 12; by asymptotics.py for each m: both, and 1/5 < (L − leading) asinh 1 m²/(√2 ln² 4m) "
    "< 1/3."
)


@dataclass(frozen=True)
class Block:
    """One table: what it is, where that has to be said, the heads and the cells."""

    title: str
    heads: tuple[str, ...]
    rows: list[list[str]]


def values(table: Table) -> Block:
    """γ, ρ and L."""
    rows = [_row(table, row, row.gamma, row.rho, row.L) for row in table.rows]
    return Block("", ("m", "γ", "ρ", "L"), rows)


def places(table: Table) -> Block:
    """Where each is reached, and the slope at 0."""
    rows = [
        [*_row(table, row, row.gamma_at, row.rho_at, row.L_at), str(slope_at_zero(row.m))]
        for row in table.rows
    ]
    return Block("", ("m", "x of γ", "x of ρ", "x of L", "h′(0)"), rows)


def constants(table: Table) -> Block:
    """Values and places side by side."""
    left, right = values(table), places(table)
    rows = [[*a, *b[1:]] for a, b in zip(left.rows, right.rows, strict=True)]
    return Block("", (*left.heads, *right.heads[1:]), rows)


def others(table: Table) -> list[Block]:
    """The tables that were asked for beside the constants."""
    return [block for block in (_asymptotes(table), _budget(table)) if block is not None]


def notes(table: Table) -> list[str]:
    """A line for each printed γ in the table, and what is proved about large m."""
    printed = [
        f"The paper prints γ_{row.m} = {float(PRINTED_GAMMA[row.m]):g}: "
        + ("an upper bound of h." if printed_bounds(row.m) else "not an upper bound, h exceeds it.")
        for row in table.rows
        if row.m in PRINTED_GAMMA
    ]
    return [*printed, LIMITS, *([RESTS] if table.asymptotes else [])]


def _asymptotes(table: Table) -> Block | None:
    if table.asymptotes is None:
        return None
    heads = ("m", "γ leading", "γ − leading", "ρ leading", "ρ − leading", "L leading", "L − leading")
    rows = []
    for row, tail in zip(table.rows, table.asymptotes, strict=True):
        pairs = ((tail.gamma, tail.gamma_rest), (tail.rho, tail.rho_rest), (tail.L, tail.L_rest))
        cells = [
            text
            for leading, rest in pairs
            for text in (_cell(leading, table.digits), _cell(rest, min(table.digits, REST_DIGITS)))
        ]
        rows.append([str(row.m), *cells])
    return Block(LEADING, heads, rows)


def _budget(table: Table) -> Block | None:
    budget = table.budget
    if budget is None:
        return None
    rows = [
        [str(row.m), *(NONE if limit is None else _cell(limit, table.digits) for limit in limits)]
        for row, limits in zip(table.rows, budget.rows, strict=True)
    ]
    title = f"Torque budget of {budget.robot}: k_p + k_v < (τmax − k_g)/(√n γ), N·m."
    return Block(title, ("m", *budget.joints), rows)


def _row(table: Table, row: Constants, *cells: Enclosure | None) -> list[str]:
    return [str(row.m), *(_cell(value, table.digits) for value in cells)]


def _cell(value: Enclosure | None, digits: int) -> str:
    return INFINITY if value is None else value.correct_digits(digits)
