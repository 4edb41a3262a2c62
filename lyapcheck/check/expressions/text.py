"""Expressions as a reader writes them: sums, products and powers with as few brackets as they need."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from fractions import Fraction
from typing import Any

from lyapcheck.check.expressions.expression import CONSTANTS, FAMILY, LEAVES, Tree

SUM, PRODUCT, POWER, ATOM = range(4)
"""How tightly the outermost operation of a text binds."""
NAMES = {
    "pi": "π",
    "gamma": "γ_{}",
    "rho": "ρ_{}",
    "L": "L_{}",
    "h": "h_{}",
    "dh": "h_{}′",
    "potential": "U_{}",
    "log": "ln",
}
DECIMALS = 6
SUPERSCRIPTS = str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹")
Text = tuple[str, int]


def expression_text(tree: Tree) -> str:
    """The expression on one line."""
    return _text(tree)[0]


def _text(tree: Tree) -> Text:
    kind, *rest = tree
    if kind == "num":
        shown = number_text(value := Fraction(rest[0]))
        return shown, SUM if value < 0 else PRODUCT if "/" in shown else ATOM
    if kind in LEAVES:
        name = rest[0] if kind == "var" else NAMES[kind]
        return name.format(rest[0]) if kind in CONSTANTS else name, ATOM
    if kind in FAMILY:
        return f"{NAMES[kind].format(rest[0])}({expression_text(rest[1])})", ATOM
    shape = SHAPES.get(kind)
    if shape is not None:
        return shape(rest)
    if kind == "abs":
        return f"|{expression_text(rest[0])}|", ATOM
    return f"{NAMES.get(kind, kind)}({expression_text(rest[0])})", ATOM


def number_text(value: Fraction) -> str:
    """A decimal where a short one says it exactly, a fraction otherwise."""
    scaled = value * 10**DECIMALS
    if scaled.denominator != 1 or value.denominator == 1:
        return str(value).replace("-", "−")
    digits = str(abs(scaled.numerator)).rjust(DECIMALS + 1, "0")
    sign = "−" if value < 0 else ""
    return f"{sign}{digits[:-DECIMALS]}.{digits[-DECIMALS:]}".rstrip("0")


def diagonal_text(entries: Iterable[Fraction]) -> str:
    """``diag(a, b, …)``."""
    return f"diag({', '.join(map(number_text, entries))})"


def list_text(values: Iterable[Fraction]) -> str:
    """``(a, b, …)``."""
    return f"({', '.join(map(number_text, values))})"


def angles_text(values: Iterable[Fraction | None]) -> str:
    """Angles exactly in rad, and about what that is in degrees; ``∞`` where there is no bound."""
    known = tuple(values)
    radians = ", ".join("∞" if x is None else number_text(x) for x in known)
    degrees = ", ".join("∞" if x is None else f"{math.degrees(x):.5g}°" for x in known)
    return f"({radians}) rad (about {degrees})"


def _root(rest: list[Any]) -> Text:
    text, binding = _text(rest[0])
    return (f"√{text}" if binding == ATOM and text.isalnum() else f"√({text})"), POWER


def _sum(rest: list[Any]) -> Text:
    first, *others = rest
    text = expression_text(first)
    for part in others:
        shown = _text(part)[0]
        text += f" − {shown[1:]}" if shown.startswith("−") else f" + {shown}"
    return text, SUM


def _product(rest: list[Any]) -> Text:
    """The factors; the sign of a number at the front stands before all of them."""
    first, *others = rest
    value = Fraction(first[1]) if first[0] == "num" else Fraction(0)
    if not others or value >= 0:
        return "·".join(_bracketed(part, PRODUCT) for part in rest), PRODUCT
    positive = others if value == -1 else [("num", str(-value)), *others]
    text, binding = _product(positive)
    return f"−{text if binding != SUM else f'({text})'}", SUM


def _power(rest: list[Any]) -> Text:
    if rest[1] == 1:
        return _text(rest[0])
    return f"{_bracketed(rest[0], ATOM)}{str(rest[1]).translate(SUPERSCRIPTS)}", POWER


def _bracketed(tree: Tree, least: int) -> str:
    text, binding = _text(tree)
    return text if binding >= least else f"({text})"


SHAPES: dict[str, Callable[[list[Any]], Text]] = {
    "add": _sum,
    "mul": _product,
    "div": lambda rest: (f"{_bracketed(rest[0], PRODUCT)}/{_bracketed(rest[1], POWER)}", PRODUCT),
    "neg": lambda rest: (f"−{_bracketed(rest[0], PRODUCT)}", SUM),
    "pow": _power,
    "sqrt": _root,
    "vec": lambda rest: (rest[0], ATOM),
    "mat": lambda rest: (rest[0], ATOM),
    "diag": lambda rest: (f"diag({rest[0]})", ATOM),
    "rate": lambda rest: (f"d/dt({expression_text(rest[0])})", ATOM),
    "sum": lambda rest: _sum(rest) if rest else ("0", ATOM),
    "scale": _product,
    "apply": _product,
    "dot": lambda rest: (f"{_bracketed(rest[0], ATOM)}ᵀ·{_bracketed(rest[1], PRODUCT)}", PRODUCT),
    "transpose": lambda rest: (f"{_bracketed(rest[0], ATOM)}ᵀ", POWER),
}
