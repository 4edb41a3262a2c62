"""For which arms a row of the report holds: all values of the ranges, or nominal numbers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from lyapcheck.check.kinds.all_of import AllOf
from lyapcheck.claims.certificates import file_name

if TYPE_CHECKING:
    from lyapcheck.answers.robot.facts import ArmFacts
    from lyapcheck.check.statement import Statement
    from lyapcheck.robots import RobotModel

RANGES, NOMINAL = "all values of the ranges", "nominal numbers"
FRICTION = "2.7"
"""The property of B, whose statement has no ranges; the others are about M, C and g."""


def uncertain(model: RobotModel) -> bool:
    """Whether the file gives a range to a number that the properties are about."""
    return any(number.ranged for number in (*model.parameters.values(), *model.viscous))


def extent(report: ArmFacts, name: str) -> str:
    """For which arms the certificate of that name holds; empty without one, and for an arm without ranges.

    A row whose parts differ is no more than its weakest part.
    """
    model = report.model
    certificate = report.certificates.get(file_name(name, None))
    if certificate is None or not uncertain(model):
        return ""
    numbers = model.viscous if name == FRICTION else model.parameters.values()
    if not any(number.ranged for number in numbers):
        return RANGES
    every = all(_over_ranges(part, model) for part in _parts(certificate.statement))
    return RANGES if every and name != FRICTION else NOMINAL


def _parts(statement: Statement) -> Sequence[Statement]:
    return [part for _, part in statement.parts] if isinstance(statement, AllOf) else [statement]


def _over_ranges(statement: Statement, model: RobotModel) -> bool:
    """Whether a statement has the ranges of M and of the potential in it."""
    return getattr(statement, "parameters", ()) == tuple(
        number.bounds for number in model.parameters.values()
    )


def together(ids: Sequence[str], every: Sequence[str]) -> str:
    """Some ids of a list, neighbours as a span: ``2.1, 2.3–2.5``."""
    spans: list[list[str]] = []
    for before, name in zip(["", *every], every, strict=False):
        if name in ids:
            if before in ids:
                spans[-1].append(name)
            else:
                spans.append([name])
    return ", ".join(f"{one[0]}–{one[-1]}" if len(one) > 2 else ", ".join(one) for one in spans)
