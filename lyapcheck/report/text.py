"""How numbers and names are written in documents; shared by the HTML and the Markdown templates."""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from lyapcheck.output.digits import shown
from lyapcheck.report.model import ClaimRow

SYMBOLS = {"proved": "✓", "refuted": "✗", "undecided": "?", "error": "!", "accepted": "✓", "rejected": "✗"}


GRADES = {
    "kernel": "a theorem of Coq's kernel",
    "exact": "rational numbers and symbolic normal forms",
    "enclosure": "balls that enclose the exact numbers",
    "numeric": "floating point, which decides nothing",
}
WHOSE = {
    "quoted": "The paper's own.",
    "implied": "Implied: the paper's argument or its tables rely on it.",
    "ours": "Ours: a further question or a repair. It can be no error of the paper.",
}


def fixed(value: Any, places: int = 2) -> str:
    """A number to some decimal places; a dash where there is none."""
    return "–" if value is None or math.isnan(float(value)) else shown(float(value), f".{places}f")


def joined(values: Sequence[Any], places: int = 2) -> str:
    """A list of numbers in one cell."""
    return ", ".join(fixed(value, places) for value in values)


def plural(count: int, noun: str) -> str:
    """``1 claim``, ``3 claims``."""
    return f"{count} {noun}" if count == 1 else f"{count} {noun}s"


MOST_COORDINATES = 3
"""A witness with more coordinates than this is given in the table of claims only."""


def witness_words(row: ClaimRow) -> str:
    """Both sides of a refuted relation, in as few digits as tell them apart, and where: for an overview."""
    witness = row.decision.witness or {}
    if "point" not in witness:
        return "; ".join(f"{name}: {value}" for name, value in witness.items())
    point = [f"{name} = {value}" for name, value in witness["point"].items()]
    where = f" at {', '.join(point)}" if 0 < len(point) <= MOST_COORDINATES else ""
    sides = witness["left"], witness["right"]
    words = ([span_words(side, digits) for side in sides] for digits in range(6, 17, 2))
    whole = ["–".join(dict.fromkeys(side)) for side in sides]
    left, right = next((pair for pair in words if pair[0] != pair[1]), whole)
    extra = [f"; {name}: {span_words(witness[name])}" for name in witness if name.endswith("gives it")]
    return f"{left} is not {witness['operator'].replace('<=', '≤')} {right}{where}{''.join(extra)}"


def span_words(ends: Sequence[str], digits: int = 6) -> str:
    """An enclosure in a few digits; a range where its ends differ by more."""
    short = (f"{float(end):.{digits}g}" for end in ends)
    low, high = (f"−{one[1:]}" if one.startswith("-") else one for one in short)
    return low if low == high else f"{low} to {high}"


def and_list(names: Sequence[str]) -> str:
    """``a``, ``a and b``, ``a, b and c``."""
    *most, last = names
    return f"{', '.join(most)} and {last}" if most else last


def member_words(ms: Sequence[int]) -> str:
    """``m = 1, 2``; ``all m`` where it concerns all."""
    return f"m = {', '.join(map(str, ms))}" if ms else "all m"


LETTERS = {
    "gamma": "γ",
    "rho": "ρ",
    "beta": "β_M",
    "kc": "k_c",
    "eps0": "ε₀",
    "kp": "λmin(K_p)",
    "kp_min": "λmin(K_p)",
    "kv": "λmax(K_v)",
    "b": "λmin(B)",
    "more": "λmax(B) − λmin(B)",
    "share": "ε/ε₀",
}
OF_JOINTS = {"kp": "k_p", "kv": "k_v", "e": "q̃_", "q": "q_", "w": "q̇_", "x": "x_", "c": "c_"}


def letter(name: str) -> str:
    """A letter of the paper's script as the paper writes it, with the number of its joint."""
    stem = name.rstrip("0123456789")
    if name in LETTERS or stem == name or stem not in OF_JOINTS:
        return LETTERS.get(name, name)
    return f"{OF_JOINTS[stem]}{name[len(stem) :]}"


def short_number(value: str) -> str:
    """A rational as a decimal where that is exact and short, else as it is."""
    number = Fraction(value)
    decimal = f"{float(number):.6g}"
    return decimal if "e" not in decimal and Fraction(decimal) == number else value


def witness_place(row: ClaimRow) -> str:
    """For how many joints, which member and where a claim fails: letters that are 0 are left out."""
    point = (row.decision.witness or {})["point"]
    where = [f"{name} = {value}" for name, value in (("n", row.n), ("m", row.m)) if value]
    where += [f"{letter(name)} = {short_number(value)}" for name, value in point.items() if value != "0"]
    return ", ".join(where)


def witness_sides(row: ClaimRow) -> str:
    """Both sides of the relation that fails."""
    witness = row.decision.witness or {}
    left, right = span_words(witness["left"]), span_words(witness["right"])
    return f"{left} is not {witness['operator'].replace('<=', '≤')} {right}"
