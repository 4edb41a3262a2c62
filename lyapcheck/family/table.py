"""The table of γ_m, ρ_m and L_m as data; ``table_formats`` writes it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction

from lyapcheck.check.numbers.constants import Constants, gamma_less_than, hyperbolic_constants
from lyapcheck.check.numbers.enclosure import Enclosure
from lyapcheck.family.asymptotes import Asymptotes, asymptotes

PRINTED_GAMMA = {1: Fraction(1), 2: Fraction(105, 100), 3: Fraction(111, 100)}
"""The γ_m that the paper prints after (7)."""

_GUARD_DIGITS = 6
_RESTS_DIGITS = 12
"""More digits still, where the constants are compared with numbers that come close to them."""


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
    """Certified constants of members of the hyperbolic family, to a number of significant digits.

    Args:
        digits: how many are shown; the enclosures are tighter.
        rows: the constants of each member.
        budget: what an arm's torque limits leave to the gains.
        asymptotes: for each row what the constants come close to as m grows.
    """

    digits: int
    rows: tuple[Constants, ...]
    budget: Budget | None = None
    asymptotes: tuple[Asymptotes, ...] | None = None

    def __str__(self) -> str:
        """As ``lyapcheck table`` prints it."""
        from lyapcheck.family.table_formats import renderer

        return renderer("text")(self)

    def _repr_html_(self) -> str:
        """The tables, for a notebook."""
        from lyapcheck.family.table_formats import renderer

        return renderer("html")(self)


def build_table(
    members: Sequence[int],
    digits: int = 30,
    on_progress: Callable[[float, str], None] | None = None,
    *,
    with_asymptotes: bool = False,
) -> Table:
    """γ_m, ρ_m and L_m of each member, enclosed a few digits tighter than they are shown.

    Args:
        members: m of each row, at least 1.
        digits: significant digits to show, at least 1; all of them correct.
        on_progress: called with the fraction done (0 to 1) and a note.
        with_asymptotes: add what the constants come close to as m grows.

    Raises:
        ValueError: an m or ``digits`` below 1.

    Soundness: see ``lyapcheck.check.numbers.constants``; digits are cut off from an enclosure, never rounded.

    References: (6), (7) and (8) of reyes2019family.

    Example:
        >>> table = build_table([1, 2, 3], digits=8)
        >>> [row.gamma.correct_digits(8) for row in table.rows]
        ['1', '1.0535692', '1.1142096']
        >>> table.rows[1].gamma.decimals(8)
        ('1.0535692', '1.0535693')
        >>> print(table)  # doctest: +ELLIPSIS
        Constants of h_m(x) = ...
    """
    rows, step = [], 1 + len(members) // 10
    exact = digits + _GUARD_DIGITS + (_RESTS_DIGITS if with_asymptotes else 0)
    for done, m in enumerate(members):
        if on_progress and done and done % step == 0:
            on_progress(done / len(members), f"m = {m}")
        rows.append(hyperbolic_constants(m, exact))
    tails = tuple(asymptotes(row, exact) for row in rows) if with_asymptotes else None
    return Table(digits, tuple(rows), asymptotes=tails)


def slope_at_zero(m: int) -> int:
    """h_m'(0), from (8) at x = 0, where only its first term can be left: (2m − 1) sinh^(2m−2) 0."""
    return int((2 * m - 1) * 0 ** (2 * m - 2))


def printed_bounds(m: int) -> bool:
    """Whether h_m never exceeds the printed γ: tanh stays below 1, the others reach their γ."""
    value = PRINTED_GAMMA[m]
    return value >= 1 if m == 1 else gamma_less_than(m, value**2)
