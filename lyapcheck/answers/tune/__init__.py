"""The largest gains of an arm: the convex program proposes, exact arithmetic disposes, the gate confirms."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from lyapcheck.answers.gate import GateResult, gate
from lyapcheck.answers.gate.words import advice
from lyapcheck.answers.running import runs_of
from lyapcheck.answers.tune.answer import (
    INFEASIBLE,
    TUNED,
    UNDECIDED,
    TunedJoint,
    TunedSet,
    Tuning,
)
from lyapcheck.answers.tune.largest import (
    Damping,
    GainRange,
    best_units,
    binding,
    damping_of,
    gain_range_of,
    obstacle,
    propose,
)
from lyapcheck.answers.tune.targets import Targets, arms_over, impossible, limits_with, unknown
from lyapcheck.control.conditions import ACCEPTED
from lyapcheck.control.gains import Bounds, GainFile
from lyapcheck.control.limits import Limits
from lyapcheck.family.base import named
from lyapcheck.files.decimals import round_down
from lyapcheck.files.loop import NOTHING, LoopEntry
from lyapcheck.robots import ArmLike, RobotModel

if TYPE_CHECKING:
    from lyapcheck.robots.fields import Vary

WRITTEN_PLACES = 12


def tune(
    robot: ArmLike,
    members: Sequence[int] = (1, 2, 3),
    targets: Targets | None = None,
    bounds: Bounds | None = None,
    varies: tuple[Vary, ...] = (),
    loop: LoopEntry = NOTHING,
) -> Tuning:
    """Find the largest k_p, and with it the largest k_v, that meet (10p), (19) and the targets.

    Args:
        robot: an arm, its name or the path of its file.
        members: the order m of each gain set.
        targets: stiffness, damping and torque. Default: as much damping as (19) allows.
        bounds: limits that replace the arm's.
        varies: ranges of the arm's numbers for the limits, if ``robot`` is a name or path.
        loop: the sampled loop, which replaces the arm file's.

    Raises:
        InputError: the arm or a target cannot be used.

    Soundness: every gain is an exact decimal that the gate accepted. Exact arithmetic also decides that no
        gain can be one unit of the last digit larger. The convex program only proposes.

    References: (10), (19) and Section 4 of reyes2019family.

    Example:
        >>> tuning = tune("buap3", [1])
        >>> [float(joint.kp) for joint in tuning.sets[0].joints]
        [28.633, 63.112, 7.381]
        >>> stiff = tune("reyes-kelly2", [2], Targets.of(peak_share="0.8", kv_share="0.5"))
        >>> stiff.sets[0].gains.kp
        (Fraction(53439, 1000), Fraction(6771, 1000))
        >>> print(stiff)  # doctest: +ELLIPSIS
        ✓ reyes-kelly2: the largest gains within (10p) and (19)
        ...
    """
    model, ranged = arms_over(robot, varies)
    wanted = (targets or Targets()).for_joints(model.n)
    limits, repeated = _limits(ranged, wanted, bounds or Bounds())
    found = tuple(_tuned(m, model, limits, wanted) for m in dict.fromkeys(members))
    sets = _confirmed(found, model, repeated, loop)
    return Tuning(model.address, model.title, wanted, limits, repeated, sets, loop)


def _repeated(bounds: Bounds, limits: Limits) -> Bounds:
    """The bounds that the gain file must repeat: all of them, where they are those of ranges.

    Of gravity those that the arm keeps, whatever was given.
    """
    known = tuple(limit for limit in limits.torque if limit is not None)
    if not limits.varied:
        return replace(bounds, gravity=None if bounds.gravity is None else limits.gravity)
    return Bounds(limits.viscous_min or None, known if len(known) == limits.n else None, limits.gravity)


def _limits(arm: RobotModel, targets: Targets, bounds: Bounds) -> tuple[Limits, Bounds]:
    """The limits to tune to, and those that the gain file must repeat."""
    limits = limits_with(arm, bounds)
    bounds = _repeated(bounds, limits)
    if all(share == 1 for share in targets.peak_share):
        return limits, bounds
    torque = tuple(
        None if limit is None else round_down(limit * share, WRITTEN_PLACES)
        for limit, share in zip(limits.torque, targets.peak_share, strict=True)
    )
    known = tuple(limit for limit in torque if limit is not None)
    repeated = replace(bounds, torque=known if len(known) == arm.n else bounds.torque)
    return replace(limits, torque=torque), repeated


def _tuned(m: int, model: RobotModel, limits: Limits, targets: Targets) -> TunedSet:
    """The gain set of one member."""
    name = f"tau_m{m}"
    if reasons := impossible(limits):
        return TunedSet(name, m, INFEASIBLE, reasons=tuple(reasons))
    if reasons := unknown(limits):
        return TunedSet(name, m, UNDECIDED, reasons=tuple(reasons))
    gain_ranges = _rooms(m, model, limits, targets)
    obstacles = [obstacle(gain_range, i, limits, targets) for i, gain_range in enumerate(gain_ranges)]
    if any(obstacles):
        return TunedSet(name, m, INFEASIBLE, reasons=tuple(filter(None, obstacles)))
    proposal = propose(gain_ranges)
    starts = proposal.kv or (None,) * len(gain_ranges)
    units = [best_units(gain_range, start) for gain_range, start in zip(gain_ranges, starts, strict=True)]
    joints = zip(limits.joints, gain_ranges, units, strict=True)
    return TunedSet(name, m, TUNED, tuple(_joint(*each) for each in joints), program=proposal.status)


def _rooms(m: int, model: RobotModel, limits: Limits, targets: Targets) -> list[GainRange]:
    gamma = named("hyperbolic", m).gamma
    dampings: Sequence[Damping | None] = (None,) * model.n
    if targets.damping:
        dampings = damping_of(limits.model or model, m, targets.damping, limits.viscous_min)
    return [gain_range_of(i, limits, gamma, targets, damping) for i, damping in enumerate(dampings)]


def _joint(name: str, gain_range: GainRange, units: tuple[int, int]) -> TunedJoint:
    kp_bound, kv_bound = binding(gain_range, *units)
    kp, kv = (gain_range.unit * k for k in units)
    damping = None if gain_range.damping is None else gain_range.damping.reached(kp, kv)
    return TunedJoint(name, kp, kv, gain_range.sum_limit, gain_range.kv_limit, kp_bound, kv_bound, damping)


def _confirmed(
    sets: Sequence[TunedSet], model: RobotModel, repeated: Bounds, loop: LoopEntry
) -> tuple[TunedSet, ...]:
    """Let the gate judge the gain file that will be written.

    A set that the gate rejects for another reason than its gains, such as an arm file that contradicts
    itself, is none; the reason is the gate's.

    Raises:
        ArithmeticError: the gate rejects the gains of one, which would be a fault of tuning.
    """
    gains = tuple(item.gains for item in sets if item.gains is not None)
    if not gains:
        return tuple(sets)
    file = GainFile("tuned gains", None, gains, repeated, loop=loop)
    answers = {result.name: result for result in gate(file, model)}
    return tuple(item if item.gains is None else _as_judged(item, answers[item.name]) for item in sets)


def _as_judged(item: TunedSet, result: GateResult) -> TunedSet:
    """A set that was accepted as it is; else the reasons that are not its gains."""
    if result.verdict == ACCEPTED:
        return replace(item, runs=runs_of(result))
    reasons = tuple(advice(result, check) for check in result.failures if check.id not in result.deciding)
    if not reasons:
        raise ArithmeticError(f"the gate says {result.verdict} to the tuned gains {result.name}")
    return TunedSet(item.name, item.m, INFEASIBLE, reasons=reasons, rejected=True)
