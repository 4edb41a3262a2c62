"""The table of constants as versioned JSON."""

from __future__ import annotations

import json
from typing import Any

from lyapcheck.check.numbers.constants import Constants
from lyapcheck.check.numbers.enclosure import Enclosure
from lyapcheck.family.asymptotes import Asymptotes
from lyapcheck.family.table import PRINTED_GAMMA, Table, printed_bounds, slope_at_zero

SCHEMA = "lyapcheck/table/1"


def render(table: Table) -> str:
    """``rows: [{m, gamma: {lower, upper}, …}]``, decimal strings that enclose; ``null`` at infinity."""
    document: dict[str, Any] = {"schema": SCHEMA, "digits": table.digits}
    if table.budget is not None:
        document["robot"] = table.budget.robot
    document["rows"] = [_row(table, index) for index in range(len(table.rows))]
    return json.dumps(document, ensure_ascii=False, indent=2) + "\n"


def _row(table: Table, index: int) -> dict[str, Any]:
    row, digits = table.rows[index], table.digits
    found = {"m": row.m, **_constants(row, digits), "slope_at_0": str(slope_at_zero(row.m))}
    found["gamma_printed"] = _printed(row.m)
    if table.asymptotes is not None:
        found["asymptotics"] = _asymptotics(table.asymptotes[index], digits)
    if table.budget is not None:
        found["budget"] = [
            {"joint": joint, "limit": _bounds(limit, digits)}
            for joint, limit in zip(table.budget.joints, table.budget.rows[index], strict=True)
        ]
    return found


def _constants(row: Constants, digits: int) -> dict[str, Any]:
    names = ("gamma", "rho", "L", "gamma_at", "rho_at", "L_at")
    return {name: _bounds(getattr(row, name), digits) for name in names}


def _asymptotics(tail: Asymptotes, digits: int) -> dict[str, Any]:
    return {
        name: {"leading": _bounds(leading, digits), "rest": _bounds(rest, digits)}
        for name, leading, rest in (
            ("gamma", tail.gamma, tail.gamma_rest),
            ("rho", tail.rho, tail.rho_rest),
            ("L", tail.L, tail.L_rest),
        )
    }


def _printed(m: int) -> dict[str, Any] | None:
    """The γ_m printed in the paper, and whether it really bounds h_m; ``None`` where none is printed."""
    value = PRINTED_GAMMA.get(m)
    return None if value is None else {"value": f"{float(value):g}", "bounds_h": printed_bounds(m)}


def _bounds(value: Enclosure | None, digits: int) -> dict[str, str] | None:
    return None if value is None else dict(zip(("lower", "upper"), value.decimals(digits), strict=True))
