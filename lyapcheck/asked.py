"""Questions about an arm and its gains as statements, made from the files and options of the user alone.

An answer compares them with what was judged (``lyapcheck.promise``). So nothing here may come from a search,
a certificate or a nominal arm, unless the sentence is about the nominal arm and says so.
"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

from lyapcheck.check.kinds.decreasing import Decreasing
from lyapcheck.check.kinds.resting import Resting
from lyapcheck.search.inertia import mass_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from lyapcheck.check.statement import Ends
    from lyapcheck.control.gains import GainSet
    from lyapcheck.robots.plant import Plant


def parameters_of(arm: Plant) -> tuple[Ends, ...]:
    """The range of each parameter of M; one that M does not depend on is held at its value."""
    first, rows = 2 * arm.n, mass_of(arm)
    terms = (powers for row in rows for entry in row for powers, _ in entry)
    used = {place for powers in terms for place, power in enumerate(powers[first:]) if power}
    return tuple(
        number.bounds if place in used else (number.value, number.value)
        for place, number in enumerate(arm.parameters.values())
    )


def decreasing(
    gains: GainSet,
    arm: Plant,
    eps0: Fraction,
    coupling: tuple[Fraction, ...] = (),
    *,
    nominal: bool = False,
) -> Decreasing:
    """Does V fall at every state of every arm in the ranges, with this ε₀? See `Decreasing`.

    Args:
        gains: the controller.
        arm: as the user gave it.
        eps0: that is printed.
        coupling: the diagonal of Λ, where one is printed.
        nominal: the question is about the nominal numbers of the arm alone.
    """
    arm = arm.fixed() if nominal else arm
    return Decreasing(
        mass=mass_of(arm),
        viscous=tuple((b.value, b.value) if nominal else b.bounds for b in arm.viscous),
        parameters=parameters_of(arm),
        family=gains.family,
        m=gains.m,
        kp=tuple(gains.kp),
        kv=tuple(gains.kv),
        eps0=eps0,
        coupling=coupling,
    )


def resting(gains: GainSet, dry: Sequence[Fraction], errors: Sequence[Fraction | None]) -> Resting:
    """Does each joint rest within its error under dry friction of this size, N·m? See `Resting`."""
    return Resting(gains.family, gains.m, tuple(gains.kp), tuple(dry), tuple(errors))
