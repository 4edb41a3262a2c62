"""The gate as versioned JSON.

The text is laid out here and not by an encoder: a line for what is said of a gain set as a whole and one for
each check is easy to read, and thousands of sets are written at once.
"""

from __future__ import annotations

from functools import lru_cache
from json import JSONEncoder, loads

from lyapcheck.files.decimals import decimal_text
from lyapcheck.gating.formats.words import KEYS, advice, joint_name, largest_text, margin_text
from lyapcheck.gating.stability import remarks, stable_otherwise

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import Any

    from lyapcheck.control.bracket import Bracket
    from lyapcheck.control.conditions import Check
    from lyapcheck.gating.gate import GateResult

SCHEMA = "lyapcheck/gate/1"
DIGITS = 20
_ENCODE = JSONEncoder(ensure_ascii=False).encode


def render(results: Sequence[GateResult]) -> str:
    """``results: [{name, m, verdict, checks: [...]}]``, numbers as decimal strings, limits enclosed."""
    blocks = ",\n    ".join([_result(result) for result in results])
    return f'{{\n  "schema": "{SCHEMA}",\n  "results": [\n    {blocks}\n  ]\n}}\n'


def result_json(result: GateResult) -> dict[str, Any]:
    """One gain set as plain data."""
    found: dict[str, Any] = loads(_result(result))
    return found


def _result(result: GateResult) -> str:
    checks = ",\n      ".join([_check(result, check) for check in result.checks])
    about = {
        "name": result.name,
        "file": result.file.path,
        "family": result.gains.family,
        "m": result.m,
        "verdict": result.verdict,
        "deciding": result.deciding,
        "strict": result.strict,
        "stable_otherwise": _stable(result),
        "remarks": remarks(result),
        "assumptions": result.limits.assumptions,
    }
    return f'{_text(about).removesuffix("}")}, "checks": [\n      {checks}\n    ]}}'


def _stable(result: GateResult) -> dict[str, Any] | None:
    """The certificate that proves stability whatever (19) says."""
    known = stable_otherwise(result)
    if known is None:
        return None
    return {"condition": known.id, "eps0": None if known.value is None else decimal_text(known.value)}


def _check(result: GateResult, check: Check) -> str:
    place = result.file.place(result.gains, KEYS[check.id], check.joint)
    line, column = ("null", "null") if place is None else (place.line, place.column)
    joint = "null" if check.joint is None else _quoted(joint_name(result, check))
    value = "null" if check.value is None else f'"{decimal_text(check.value)}"'
    limit = "null" if check.limit is None else _limit(check.limit)
    margin = "null" if check.limit is None else f'"{margin_text(check, 12)}"'
    largest = "null" if check.largest_admissible is None else f'"{largest_text(check)}"'
    message = advice(result, check)
    return (
        f'{{"id": "{check.id}", "joint": {joint}, "verdict": "{check.verdict}", "value": {value}, '
        f'"limit": {limit}, "margin": {margin}, "largest_admissible": {largest}, '
        f'"line": {line}, "column": {column}, "message": {_text(message) if message else _NOTHING}}}'
    )


_NOTHING = '""'


def _limit(limit: Bracket) -> str:
    lower, upper = limit.decimals(DIGITS)
    return f'{{"lower": "{lower}", "upper": "{upper}"}}'


def _text(value: object) -> str:
    """A value as JSON."""
    return _ENCODE(value)


@lru_cache(maxsize=256)
def _quoted(text: str) -> str:
    """A name that comes often."""
    return _text(text)
