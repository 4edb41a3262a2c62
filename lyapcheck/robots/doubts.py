"""What makes the numbers of an arm doubtful: templates and wrong units; no verdict rests on it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from math import sqrt
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from lyapcheck.robots.fields import Number
    from lyapcheck.robots.plant import RobotModel

HEAVIEST, LONGEST = 1000, 5
"""kg of one body, and m from joint to joint: of arms nobody bolts to a floor."""
LIGHTEST, STEEPEST = 1, 30
"""m/s² of free fall, from the moon to a large planet."""
SAME = 2
"""So many joints with the same limit and friction are doubted; either alone with twice as many."""


def doubts(model: RobotModel) -> tuple[str, ...]:
    """A sentence on everything that looks like a template or another unit."""
    return (*_templates(model), *_units(model))


def _templates(model: RobotModel) -> Iterator[str]:
    friction = _values(model.viscous)
    limits = _values(model.torque_limit)
    if friction and not any(friction):
        yield "Viscous friction is 0 for every joint, as files say that do not know it"
        friction = None
    same = [
        words
        for words, values in (("viscous friction", friction), ("torque limit", limits))
        if values is not None and len(values) >= SAME and len(set(values)) == 1
    ]
    if len(same) == 2 or (same and model.n >= 2 * SAME):
        verb = "are" if len(same) == 2 else "is"
        words = " and ".join(same).capitalize()
        yield f"{words} {verb} the same for every joint, as in templates; measured ones differ"


def _values(numbers: Sequence[Number | None]) -> list[Fraction] | None:
    """Exact numbers of every joint; ``None`` where one is missing, assumed or a range."""
    known = [x.value for x in numbers if x is not None and not x.assumed and not x.ranged]
    return known if len(known) == len(numbers) else None


def _units(model: RobotModel) -> Iterator[str]:
    chain = model.fixed().chain
    if chain is None:
        return
    for name, link in zip(model.joints, chain.links, strict=True):
        far = max(sqrt(sum(float(x) ** 2 for x in vector)) for vector in (link.origin, link.com))
        if link.mass > HEAVIEST:
            yield f"What {name} moves has a mass of {float(link.mass):.6g} kg: is that in grams?"
        if far > LONGEST:
            yield f"{name} or its body is {far:.6g} m away from the joint before: is that in mm?"
        spread = (
            sqrt(float(sum(link.inertia[i][i] for i in range(3))) / (2 * float(link.mass)))
            if link.mass
            else 0
        )
        if spread > LONGEST:
            yield f"The inertia behind {name} is that of a body of {spread:.6g} m: is it in kg·mm² or g·m²?"
    size = sqrt(sum(float(x) ** 2 for x in chain.fall))
    if chain.fall[2] > 0 and chain.fall[2] >= max(map(abs, chain.fall[:2])):
        yield f"Gravity points upwards: g_z = {float(chain.fall[2]):.6g} m/s²"
    if size and not LIGHTEST < size < STEEPEST:
        yield f"Free fall of {size:.6g} m/s² is that of no place where arms stand"
