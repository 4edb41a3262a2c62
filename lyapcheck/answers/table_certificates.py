"""Certificates of a table of constants: each γ_m and ρ_m, rounded up as in JSON, bounds its function."""

from __future__ import annotations

from contextlib import suppress
from fractions import Fraction
from typing import TYPE_CHECKING

from lyapcheck.certificate import Certificate
from lyapcheck.check.certificate import About
from lyapcheck.check.expressions.expression import Tree
from lyapcheck.check.kinds.constant import ExactNumbers, SeparateBalls
from lyapcheck.check.kinds.norm_bound import NormBound, Supremum
from lyapcheck.check.refusal import Refused
from lyapcheck.check.verify import Accepted, verify
from lyapcheck.output.digits import decimals

if TYPE_CHECKING:
    from lyapcheck.answers.table import Table

PROOF = "table"
PRECISIONS = (128, 512, 2048)
"""Bits."""
FUNCTIONS = {"gamma": "h", "rho": "dh"}


def certificates(table: Table) -> dict[str, Certificate]:
    """Certificates by file name; none of a bound that the checker does not accept."""
    made = {}
    for row in table.rows:
        for name, function in FUNCTIONS.items():
            _, upper = decimals(getattr(row, name), table.digits)
            x: Tree = ("var", "x")
            statement = NormBound((function, row.m, x), 1, ("num", str(Fraction(upper))))
            shown = _shown(statement)
            if shown is None:
                continue
            accepted, proof = shown
            about = About(f"m{row.m}.{name}", f"{name} of m = {row.m} is at most {upper}", row.m, 1, PROOF)
            certificate = Certificate(about, statement, accepted.verdict, accepted.grade, proof)
            made[f"m{row.m}.{name}.json"] = certificate
    return made


def _shown(statement: NormBound) -> tuple[Accepted, Supremum] | None:
    """The verdict on a bound and what shows it; ``None`` where the numbers are too close to it."""
    for numbers in (ExactNumbers(), *map(SeparateBalls, PRECISIONS)):
        with suppress(Refused):
            proof = Supremum(numbers)
            return verify(statement, proof), proof
    return None
