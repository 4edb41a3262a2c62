"""Questions about an arm and its gains as statements, made from the files and options of the user alone.

An answer compares them with what was judged (``lyapcheck.promise``). So nothing here may come from a search,
a certificate or a nominal arm, unless the sentence is about the nominal arm and says so.
"""

from __future__ import annotations

from dataclasses import fields, replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from lyapcheck.check.kinds.all_of import AllOf
from lyapcheck.check.kinds.chain import ChainAbove, ChainBelow, ChainGravityBelow
from lyapcheck.check.kinds.chain_coriolis import ChainCoriolisBelow
from lyapcheck.check.kinds.coriolis_below import CoriolisBelow
from lyapcheck.check.kinds.decreasing import Decreasing
from lyapcheck.check.kinds.gravity import GravityBelow
from lyapcheck.check.kinds.inertia import MassAbove, MassBelow
from lyapcheck.check.kinds.resting import Resting
from lyapcheck.robots.trig import to_terms
from lyapcheck.search.inertia import mass_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from lyapcheck.check.statement import Ends, Statement
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


def bound_of_constant(name: str, arm: Plant, end: Fraction, along_links: bool) -> Statement:
    """Is a constant of the arm above this number (λmin(M)), or at most this number (all others)?

    Args:
        name: ``lambda_min``, ``lambda_max``, ``k_c``, ``k_g`` or ``k_g1`` and so on.
        arm: for all values of its ranges.
        end: the number that is printed.
        along_links: ask about the links of the arm, whose numbers are exact, not about M(q) and g(q) in full.
    """
    if along_links:
        return _of_links(name, arm, end)
    ranges = tuple(number.bounds for number in arm.parameters.values())
    if name == "lambda_min":
        return MassAbove(mass_of(arm), ranges, end)
    if name == "lambda_max":
        return MassBelow(mass_of(arm), ranges, end)
    if name == "k_c":
        return CoriolisBelow(mass_of(arm), ranges, end)
    gravity = tuple(tuple(to_terms(arm.gravity[i])) for i in _joints(name, arm))
    return GravityBelow(arm.n, gravity, ranges, end)


def _of_links(name: str, arm: Plant, end: Fraction) -> Statement:
    chain = arm.chain
    assert chain is not None
    if name == "lambda_min":
        return ChainAbove(chain.links, end)
    if name == "lambda_max":
        return ChainBelow(chain.links, end)
    if name == "k_c":
        return ChainCoriolisBelow(chain.links, end)
    return ChainGravityBelow(chain.links, chain.fall, tuple(i + 1 for i in _joints(name, arm)), end)


def _joints(name: str, arm: Plant) -> range:
    """All joints for ``k_g``, one for ``k_g2``."""
    if name == "k_g":
        return range(arm.n)
    joint = int(name.removeprefix("k_g")) - 1
    return range(joint, joint + 1)


def over_ranges(stated: Statement, arm: Plant) -> Statement | None:
    """Does the same hold for all values of the ranges of M and g? ``None``: the kind knows no ranges."""
    if isinstance(stated, AllOf):
        parts = [(name, over_ranges(part, arm)) for name, part in stated.parts]
        known = tuple((name, part) for name, part in parts if part is not None)
        return AllOf(known) if len(known) == len(parts) else None
    names = {one.name for one in fields(stated)}  # type: ignore[arg-type]
    if "parameters" not in names:
        return None
    asked: dict[str, Any] = {"parameters": tuple(number.bounds for number in arm.parameters.values())}
    if "mass" in names:
        asked["mass"] = mass_of(arm)
    return replace(stated, **asked)  # type: ignore[type-var]
