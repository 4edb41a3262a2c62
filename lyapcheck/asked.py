"""Questions about an arm and its gains as statements, made from the files and options of the user alone.

An answer compares them with what was judged (``lyapcheck.promise``). So nothing here may come from a search,
a certificate or a nominal arm, unless the sentence is about the nominal arm and says so.
"""

from __future__ import annotations

from dataclasses import fields, replace
from fractions import Fraction
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from lyapcheck.check.kinds.all_of import AllOf
from lyapcheck.check.kinds.gate_accepted import GateAccepted
from lyapcheck.check.kinds.gravity import GravityBelow, GravityOfPotential
from lyapcheck.check.kinds.inertia import MassAbove, MassBelow
from lyapcheck.robots.dynamics import FEW_JOINTS, TooManyTerms
from lyapcheck.robots.trig import to_terms

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

    from lyapcheck.check.kinds.chain import ChainAbove, ChainBelow, ChainCoriolisBelow, ChainGravityBelow
    from lyapcheck.check.kinds.decreasing import Decreasing
    from lyapcheck.check.kinds.link_bounds import ChainDecreasing
    from lyapcheck.check.kinds.resting import Resting
    from lyapcheck.check.kinds.sampled import SampledStable
    from lyapcheck.check.kinds.sampled_from_rest import SampledFromRest
    from lyapcheck.check.statement import Ends, Statement
    from lyapcheck.control.gains import Bounds, GainSet
    from lyapcheck.control.sampling import LoopRecord
    from lyapcheck.robots import RobotModel
    from lyapcheck.robots.dynamics import Chain


def decreasing(
    gains: GainSet,
    arm: RobotModel,
    eps0: Fraction,
    coupling: tuple[Fraction, ...] = (),
    *,
    nominal: bool = False,
    viscous_min: Fraction | None = None,
) -> Decreasing | ChainDecreasing:
    """Does V fall at every state of every arm in the ranges, with this ε₀? See `Decreasing`.

    Of exact links whose M is too long to be written out the same is asked about the links.

    Args:
        gains: the controller.
        arm: as the user gave it.
        eps0: that is printed.
        coupling: the diagonal of Λ, where one is printed.
        nominal: the question is about the nominal numbers of the arm alone.
        viscous_min: λmin(B) that replaces the arm's, N·m·s/rad.
    """
    from lyapcheck.check.kinds.decreasing import Decreasing
    from lyapcheck.check.kinds.link_bounds import ChainDecreasing

    viscous = viscous_of(arm, viscous_min, nominal=nominal)
    arm = arm.fixed() if nominal else arm
    try:
        mass = arm.mass_terms
    except TooManyTerms:
        if arm.chain is None or coupling:
            raise
        return ChainDecreasing(arm.chain.links, viscous, eps0=eps0, **_controller(gains))
    return Decreasing(
        mass=mass,
        viscous=viscous,
        parameters=arm.ranges_of_mass,
        **_controller(gains),
        eps0=eps0,
        coupling=coupling,
    )


def _controller(gains: GainSet) -> dict[str, Any]:
    return {"family": gains.family, "m": gains.m, "kp": tuple(gains.kp), "kv": tuple(gains.kv)}


def resting(gains: GainSet, dry: Sequence[Fraction], errors: Sequence[Fraction | None]) -> Resting:
    """Does each joint rest within its error under dry friction of this size, N·m? See `Resting`."""
    from lyapcheck.check.kinds.resting import Resting

    return Resting(gains.family, gains.m, tuple(gains.kp), tuple(dry), tuple(errors))


def sampled(
    gains: GainSet,
    loop: LoopRecord,
    viscous_min: Sequence[Fraction],
    arm: RobotModel | None = None,
    k_g: Sequence[Fraction] = (),
    conclusion: str = "goal",
) -> SampledStable:
    """Are these gains on a computer stable, for all of the ranges of the arm? See `SampledStable`.

    Args:
        gains: the controller.
        loop: how the computer runs it.
        viscous_min: least friction of each joint, N·m·s/rad.
        arm: without it any serial revolute arm with bounds ``k_g`` is asked about.
        k_g: bounds of the torques of gravity, N·m, a premise.
        conclusion: *goal*, or *rest* under any other gravity.

    Raises:
        TooManyTerms: M of the arm is too long to be written out, and its links are not exact.
    """
    from lyapcheck.check.kinds.sampled import SampledStable

    assert loop.period is not None
    chain = None if arm is None or arm.n <= FEW_JOINTS else arm.chain
    model = arm if chain is None else None
    return SampledStable(
        **_controller(gains),
        viscous_min=tuple(viscous_min),
        k_g=() if arm else tuple(k_g),
        links=chain.links if chain else (),
        fall=chain.fall if chain else (),
        mass=model.mass_terms if model else (),
        potential=tuple(to_terms(model.potential)) if model else (),
        parameters=model.ranges if model else (),
        period=loop.period,
        stretch=loop.stretch,
        delay=loop.delay,
        taps=loop.filter,
        conclusion=conclusion,
    )


def sampled_from_rest(
    gains: GainSet, loop: LoopRecord, arm: RobotModel, within: Fraction, viscous_min: Fraction | None = None
) -> SampledFromRest:
    """Do these gains bring the arm to each goal from rest within so many degrees, at exactly this period?

    Args:
        gains: the controller.
        loop: how the computer runs it: backward differences, intervals of the nominal period.
        arm: for all of its ranges; ``fixed()`` asks about its nominal inertia, not about its friction.
        within: of every |e_i|, degrees.
        viscous_min: λmin(B) that replaces the arm's, N·m·s/rad.

    Raises:
        TooManyTerms: M of the arm is too long to be written out.
    """
    from lyapcheck.check.kinds.sampled_from_rest import SampledFromRest

    assert loop.period is not None
    return SampledFromRest(
        **_controller(gains),
        viscous=viscous_of(arm, viscous_min),
        mass=arm.mass_terms,
        potential=tuple(to_terms(arm.potential)),
        parameters=arm.ranges,
        period=loop.period,
        delay=loop.delay,
        within=within,
    )


def bound_of_constant(name: str, arm: RobotModel, end: Fraction, by_links: bool) -> Statement:
    """Is a constant of the arm above this number (λmin(M)), or at most this number (all others)?

    Args:
        name: ``lambda_min``, ``lambda_max``, ``k_c``, ``k_g`` or ``k_g1`` and so on.
        arm: for all values of its ranges.
        end: the number that is printed.
        by_links: ask about the links of the arm, whose numbers are exact, not about M(q) and g(q) in full.
    """
    if by_links:
        assert arm.chain is not None
        return along_links(name, arm.chain, end)
    ranges = arm.ranges
    if name == "lambda_min":
        return MassAbove(arm.mass_terms, ranges, end)
    if name == "lambda_max":
        return MassBelow(arm.mass_terms, ranges, end)
    if name == "k_c":
        from lyapcheck.check.kinds.coriolis import CoriolisBelow

        return CoriolisBelow(arm.mass_terms, ranges, end)
    gravity = tuple(tuple(to_terms(arm.gravity[i])) for i in joints_of(name, arm.n))
    return GravityBelow(arm.n, gravity, ranges, end)


def along_links(
    name: str, chain: Chain, end: Fraction
) -> ChainAbove | ChainBelow | ChainCoriolisBelow | ChainGravityBelow:
    """The same of exact links."""
    from lyapcheck.check.kinds.chain import ChainAbove, ChainBelow, ChainCoriolisBelow, ChainGravityBelow

    if name == "lambda_min":
        return ChainAbove(chain.links, end)
    if name == "lambda_max":
        return ChainBelow(chain.links, end)
    if name == "k_c":
        return ChainCoriolisBelow(chain.links, end)
    return ChainGravityBelow(chain.links, chain.fall, tuple(i + 1 for i in joints_of(name, chain.n)), end)


def joints_of(name: str, n: int) -> Sequence[int]:
    """The joints, from 0, whose torque of gravity a constant bounds: all for ``k_g``, one for ``k_g2``."""
    return range(n) if name == "k_g" else [int(name.removeprefix("k_g")) - 1]


def over_ranges(stated: Statement, arm: RobotModel) -> Statement | None:
    """Does the same hold for all values of the ranges of M and g? ``None``: the kind knows no ranges."""
    if isinstance(stated, AllOf):
        parts = [(name, over_ranges(part, arm)) for name, part in stated.parts]
        known = tuple((name, part) for name, part in parts if part is not None)
        return AllOf(known) if len(known) == len(parts) else None
    names = {one.name for one in fields(stated)}  # type: ignore[arg-type]
    if "parameters" not in names:
        return None
    asked: dict[str, Any] = {"parameters": arm.ranges}
    if "mass" in names:
        asked["mass"] = arm.mass_terms
    return replace(stated, **asked)  # type: ignore[type-var]


def gate_accepted(
    gains: GainSet,
    arm: RobotModel | None,
    bounds: Bounds,
    k_g: tuple[Fraction, ...],
    conditions: Collection[str],
) -> GateAccepted:
    """Do the conditions on numbers hold for every arm in the ranges, where gravity keeps to k_g?

    Args:
        gains: the controller.
        arm: as the user gave it, with all ranges; ``None`` where the gain file gives its limits alone.
        bounds: limits of the gain file, which go before those of the arm.
        k_g: a bound of each gravity torque, N·m; whether the arm keeps it asks `gravity_kept`.
        conditions: those that decide; of them the ones on numbers.
    """
    parameters, viscous, limits = _of_motors(arm, bounds, len(k_g))
    return GateAccepted(
        joints=len(k_g),
        gravity=(),
        potential=(),
        parameters=parameters,
        k_g=k_g,
        viscous=viscous,
        limits=limits,
        **_controller(gains),
        conditions=tuple(name for name in ("10", "10p", "10i", "19") if name in conditions),
        stability=(),
    )


@lru_cache(maxsize=16)
def _of_motors(
    arm: RobotModel | None, bounds: Bounds, n: int
) -> tuple[tuple[Ends, ...], tuple[Ends, ...], tuple[Fraction | None, ...]]:
    """Ranges of parameters and friction, and the least torque limits."""
    if arm is None:
        least = bounds.viscous_min or Fraction(0)
        return (), ((least, least),) * n, bounds.torque or (None,) * n
    own = tuple(None if limit is None else limit.bounds[0] for limit in arm.torque_limit)
    return arm.ranges, viscous_of(arm, bounds.viscous_min), bounds.torque or own


def viscous_of(
    arm: RobotModel, viscous_min: Fraction | None = None, *, nominal: bool = False
) -> tuple[Ends, ...]:
    """The range of each viscous friction; all from a λmin(B) on that replaces the arm's, N·m·s/rad."""
    own = tuple((b.value, b.value) if nominal else b.bounds for b in arm.viscous)
    if viscous_min in (None, min(low for low, _ in own)):
        return own
    return tuple((viscous_min, max(viscous_min, high)) for _, high in own)


def gravity_kept(arm: RobotModel, k_g: tuple[Fraction, ...]) -> AllOf:
    """Is g the slope of the potential, and |g_i(q)| ≤ k_gi at every posture of every arm in the ranges?

    Of exact links whose g is too long to be written out the second is asked.
    """
    try:
        gravity = tuple(tuple(to_terms(torque)) for torque in arm.gravity)
    except TooManyTerms:
        if arm.chain is None:
            raise
        return AllOf(tuple((f"g{i}", along_links(f"k_g{i}", arm.chain, k)) for i, k in enumerate(k_g, 1)))
    ranges = arm.ranges
    parts = [GravityBelow(arm.n, (entry,), ranges, k) for entry, k in zip(gravity, k_g, strict=True)]
    slope = GravityOfPotential(gravity, tuple(to_terms(arm.potential)), ranges)
    return AllOf((("potential", slope), *((f"g{i}", part) for i, part in enumerate(parts, 1))))


def definite(arm: RobotModel) -> MassAbove | ChainAbove:
    """Is M(q) positive definite for every arm in the ranges? Of links where M is too long to be written."""
    from lyapcheck.check.kinds.chain import ChainAbove

    try:
        mass = arm.mass_terms
    except TooManyTerms:
        if arm.chain is None:
            raise
        return ChainAbove(arm.chain.links, Fraction(0))
    return MassAbove(mass, arm.ranges, Fraction(0))
