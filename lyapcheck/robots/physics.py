"""A check that an arm as described can exist: M positive definite at a spread of states."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from itertools import islice, product

from flint import fmpq, fmpq_mat

from lyapcheck.check.numbers.polynomials import rational
from lyapcheck.files.decimals import decimal_text
from lyapcheck.files.fields import Notes
from lyapcheck.robots.model import RobotModel

_STATES = 8
_MOST_CORNERS = 64


def check_positive_definite(model: RobotModel, place: str, notes: Notes) -> None:
    """Note a problem when M is not positive definite at a state, at a corner of the parameter ranges."""
    broken = impossible_state(model)
    if broken:
        repair = "every joint must move some inertia: check masses, inertias, signs and ranges"
        notes.fail((place,), None, broken, repair)


def impossible_state(model: RobotModel) -> str:
    """Where M is not positive definite, as the rule that this breaks; empty when no such state was found.

    Exact at each state, but at finitely many: it finds slips in a file and proves nothing. A chain of bodies
    each with a moment about its own axis has no such state, see ``check.kinds.chain``.
    """
    chain = model.chain
    if chain is not None and all(link.fits and link.about_axis > 0 for link in chain.links):
        return ""
    for corner, state in product(_corners(model), range(_STATES)):
        tangents = [_tangent(state, joint) for joint in range(model.n)]
        sin = [2 * t / (1 + t * t) for t in tangents]
        cos = [(1 - t * t) / (1 + t * t) for t in tangents]
        parameters = {name: rational(value) for name, value in corner.items()}
        if not _positive_definite(model.mass_at(sin, cos, rational, parameters)):
            where = [f"cos q{i + 1} = {value}" for i, value in enumerate(cos)]
            where += [f"{name} = {decimal_text(value)}" for name, value in corner.items()]
            return f"makes M not positive definite, e.g. at {', '.join(where)}"
    return ""


def _corners(model: RobotModel) -> Iterator[dict[str, Fraction]]:
    """Corners of the box of parameters, the first few when there are very many."""
    bounds = [number.bounds for number in model.parameters.values()]
    for values in islice(product(*bounds), _MOST_CORNERS):
        yield dict(zip(model.parameters, values, strict=True))


def _tangent(state: int, joint: int) -> fmpq:
    """tan(q/2) of a joint: 0 everywhere in the first state, then spread over the circle."""
    return fmpq((state * (2 * joint + 3)) % 23, 5) * (-1 if state % 2 else 1)


def _positive_definite(rows: list[list[fmpq]]) -> bool:
    """All leading principal minors are positive."""
    return all(fmpq_mat([row[:k] for row in rows[:k]]).det() > 0 for k in range(1, len(rows) + 1))
