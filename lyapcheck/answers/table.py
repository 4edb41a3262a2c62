"""Which γ_m, ρ_m and L_m: the table of the constants of the hyperbolic family."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, partial
from typing import Any

from lyapcheck.certificate import Certificate
from lyapcheck.check.certificate import About
from lyapcheck.check.kinds.constant import ExactNumbers, SeparateBalls
from lyapcheck.check.kinds.norm_bound import NormBound, Supremum
from lyapcheck.check.numbers.balls import Constants, hyperbolic_constants
from lyapcheck.check.numbers.polynomials import Enclosure
from lyapcheck.control.gains import PRINTED_GAMMA
from lyapcheck.control.judgement import judged_statement
from lyapcheck.family.members.hyperbolic import gamma_less_than
from lyapcheck.files.decimals import decimal_text
from lyapcheck.output.answer import Answer
from lyapcheck.output.digits import correct_digits, decimals, ends
from lyapcheck.output.document import Bullets, Document, command
from lyapcheck.output.fields import Field, data, table

TITLE = "Constants of h_m(x) = sinh^(2m-1)x cosh x / (1 + sinh^(2m)x)"
LEGEND = "γ = sup h_m, ρ = sup |h_m'|, L = sup h_m(x)/x. Digits are cut off, not rounded."
CONSTANTS = {"gamma": "γ", "rho": "ρ", "L": "L", "gamma_at": "x of γ", "rho_at": "x of ρ", "L_at": "x of L"}
ENDS = ("lower", "upper")
INFINITY = "∞"

LIMITS = (
    "For m → ∞: γ → √2, ρ = m − 1/2 + O(1/m), L → √2/asinh 1 = 1.6045…; "
    "lyapcheck check every_m.py proves it for all m, asymptotics.py --m … how fast for each."
)
GROWS = (
    "As m grows h goes flat at 0, like x^(2m−1), and γ rises: less torque near the goal, a slower end, "
    "farther rest under dry friction, and less k_p within (10p); lyapcheck simulate shows it in runs."
)
_GUARD_DIGITS = 6
PROOF = "table"
PRECISIONS = (128, 512, 2048)
"""Bits."""
FUNCTIONS = {"gamma": "h", "rho": "dh"}


@dataclass(frozen=True)
class Table(Answer):
    """Certified constants of members of the hyperbolic family, to a number of significant digits.

    Args:
        digits: number of printed digits. The enclosures are tighter.
        rows: the constants of each member.
    """

    schema = "lyapcheck/table/1"

    digits: int
    rows: tuple[Constants, ...]

    def document(self) -> Document:
        """The constants, all digits correct."""
        printed = []
        for m in (row.m for row in self.rows if row.m in PRINTED_GAMMA):
            bounds = "an upper bound of h" if printed_bounds(m) else "not an upper bound, h exceeds it"
            printed.append(f"The paper prints γ_{m} = {decimal_text(PRINTED_GAMMA[m])}: {bounds}.")
        return Document(
            TITLE,
            (
                table(self._fields, [(row,) for row in self.rows]),
                *([Bullets(tuple(printed))] if printed else []),
            ),
            (LIMITS, *([GROWS] if any(row.m > 1 for row in self.rows) else [])),
            (LEGEND,),
            next=command("tune", "buap3", "--m", self.rows[0].m if self.rows else 1),
        )

    def data(self) -> dict[str, Any]:
        """``rows: [{m, gamma: {lower, upper}, …}]``, decimal strings that enclose; ``None`` at infinity."""
        return {"digits": self.digits, "rows": [data(self._fields, row) for row in self.rows]}

    def records(self) -> list[dict[str, Any]]:
        """A row an m."""
        rows = (data(self._fields[:-1], row) for row in self.rows)
        return [{key: dict.fromkeys(ENDS) if of is None else of for key, of in row.items()} for row in rows]

    @cached_property
    def _fields(self) -> tuple[Field, ...]:
        """What is said of a member; last what the paper prints."""

        def cell(value: Enclosure | None) -> str:
            return INFINITY if value is None else correct_digits(value, self.digits)

        both = partial(ends, digits=self.digits)
        constants = (Field(key, key, head, cell, both, "l") for key, head in CONSTANTS.items())
        slope = Field("slope_at_0", lambda row: str(slope_at_zero(row.m)), "h′(0)", align="l")
        return Field("m", "m", "m"), *constants, slope, Field("gamma_printed", lambda row: _printed(row.m))


def build_table(
    members: Sequence[int],
    digits: int = 30,
    on_progress: Callable[[float, str], None] | None = None,
) -> Table:
    """γ_m, ρ_m and L_m of each member, enclosed a few digits tighter than they are shown.

    Args:
        members: m of each row, at least 1.
        digits: significant digits to show, at least 1; all of them correct.
        on_progress: called with the fraction done (0 to 1) and a note.

    Raises:
        ValueError: an m or ``digits`` below 1.

    Soundness: see ``lyapcheck.check.numbers.balls``; digits are cut off from an enclosure, never rounded.

    References: (6), (7) and (8) of reyes2019family.

    Example:
        >>> table = build_table([1, 2, 3], digits=8)
        >>> [correct_digits(row.gamma, 8) for row in table.rows]
        ['1', '1.0535692', '1.1142096']
        >>> decimals(table.rows[1].gamma, 8)
        ('1.0535692', '1.0535693')
        >>> print(table)  # doctest: +ELLIPSIS
        Constants of h_m(x) = ...
    """
    rows, step = [], 1 + len(members) // 10
    for done, m in enumerate(members):
        if on_progress and done and done % step == 0:
            on_progress(done / len(members), f"m = {m}")
        rows.append(hyperbolic_constants(m, digits + _GUARD_DIGITS))
    return Table(digits, tuple(rows))


def slope_at_zero(m: int) -> int:
    """h_m'(0), from (8) at x = 0, where only its first term can be left: (2m − 1) sinh^(2m−2) 0."""
    return int((2 * m - 1) * 0 ** (2 * m - 2))


def _printed(m: int) -> dict[str, Any] | None:
    """What the paper prints of γ, and whether it bounds h."""
    value = PRINTED_GAMMA.get(m)
    return None if value is None else {"value": decimal_text(value), "bounds_h": printed_bounds(m)}


def printed_bounds(m: int) -> bool:
    """Whether h_m never exceeds the printed γ: tanh stays below 1, the others reach their γ."""
    value = PRINTED_GAMMA[m]
    return value >= 1 if m == 1 else gamma_less_than(m, value**2)


def certificates(table: Table) -> dict[str, Certificate]:
    """Certificates by file name; none of a bound that the checker does not accept."""
    made, x = {}, ("var", "x")
    numbers = (ExactNumbers(), *map(SeparateBalls, PRECISIONS))
    for row in table.rows:
        for name, function in FUNCTIONS.items():
            _, upper = decimals(getattr(row, name), table.digits)
            statement = NormBound((function, row.m, x), 1, ("num", str(Fraction(upper))))
            about = About(f"m{row.m}.{name}", f"{name} of m = {row.m} is at most {upper}", row.m, 1, PROOF)
            judged = judged_statement(statement, map(Supremum, numbers))
            made[f"m{row.m}.{name}.json"] = judged.certificate(about)
    return {file: one for file, one in made.items() if one is not None}
