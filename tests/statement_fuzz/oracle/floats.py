"""Expressions at many points in floating point: where to look, never what is so."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from functools import lru_cache
from typing import Any

import numpy as np

from tests.statement_fuzz.oracle import family
from tests.statement_fuzz.oracle.evaluate import LEAVES, Tree
from tests.statement_fuzz.oracle.numbers import Unsure, lifted

ALIAS = {"asin": "arcsin", "acos": "arccos", "atan": "arctan"}


def at(tree: Tree, points: Mapping[str, Any], known: dict[int, Any]) -> Any:
    """An expression at many points; NaN or infinite where it is undefined."""
    if id(tree) not in known:
        known[id(tree)] = _at(tree, points, known)
    return known[id(tree)]


def _at(tree: Tree, points: Mapping[str, Any], known: dict[int, Any]) -> Any:
    kind, *rest = tree
    if kind == "var":
        return points[rest[0]]
    if kind in LEAVES:
        return _number(kind, *rest)
    if kind in ("h", "dh", "potential"):
        return _member(kind, rest[0], at(rest[1], points, known))
    if kind == "pow":
        base = at(rest[0], points, known)
        return base ** np.float64(rest[1]) if rest[1] else base * 0 + 1
    return _operation(kind, [at(part, points, known) for part in rest])


def _number(kind: str, which: Any = None) -> Any:
    if kind == "num":
        return _float(which)
    return np.float64(np.pi) if kind == "pi" else _constant(kind, which)


def _operation(kind: str, parts: list[Any]) -> Any:
    if kind == "add":
        return sum(parts[1:], parts[0])
    if kind == "mul":
        result = parts[0]
        for part in parts[1:]:
            result = result * part
        return result
    if kind == "neg":
        return -parts[0]
    if kind == "div":
        return np.divide(parts[0], parts[1])
    return getattr(np, ALIAS.get(kind, kind))(parts[0])


@lru_cache(maxsize=4096)
def _float(text: str) -> Any:
    value = Fraction(text)
    try:
        return np.float64(float(value))
    except OverflowError:
        return np.float64("inf") if value > 0 else np.float64("-inf")


@lru_cache(maxsize=256)
def _constant(kind: str, m: int) -> Any:
    try:
        return np.float64(float(lifted(family.constant(kind, m)).low))
    except Unsure:
        return np.float64("nan")


def _member(kind: str, m: int, x: Any) -> Any:
    s, c = np.sinh(x), np.cosh(x)
    bottom = 1 + s ** (2 * m)
    if kind == "h":
        return s ** (2 * m - 1) * c / bottom
    if kind == "potential":
        return np.log(bottom) / (2 * m)
    slope = s ** (2 * m) + (2 * m - 1) * s ** (2 * m - 2) * c**2
    return (slope * bottom - 2 * m * s ** (4 * m - 2) * c**2) / bottom**2
