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
    best_units,
    binding,
    gain_ranges,
    obstacle,
    propose,
)
from lyapcheck.answers.tune.targets import Targets, arms_over, impossible, limits_with, unknown
from lyapcheck.control.conditions import ACCEPTED
from lyapcheck.control.gains import Bounds, GainFile
from lyapcheck.control.limits import Limits
from lyapcheck.control.sampling import record_of
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
    record_of(loop, NOTHING, model.loop)  # or say what is wrong with it
    wanted = (targets or Targets()).for_joints(model.n)
    limits, repeated = _limits(ranged, wanted, bounds or Bounds())
    sets = [_tuned(m, model, limits, wanted) for m in dict.fromkeys(members)]
    if gains := tuple(item.gains for item in sets if item.gains is not None):
        file = GainFile("tuned gains", None, gains, repeated, loop=loop)
        results = {result.name: result for result in gate(file, model)}
        sets = [item if item.gains is None else _as_judged(item, results[item.name]) for item in sets]
    return Tuning(model.address, model.title, wanted, limits, repeated, tuple(sets), loop)


def _limits(arm: RobotModel, targets: Targets, bounds: Bounds) -> tuple[Limits, Bounds]:
    """The limits to tune to, and those that the gain file must repeat: all, where they are those of ranges.

    Of gravity those that the arm keeps, whatever was given.
    """
    limits = limits_with(arm, bounds)
    pairs = zip(limits.torque, targets.peak_share, strict=True)
    less = [
        most if most is None or share == 1 else round_down(most * share, WRITTEN_PLACES)
        for most, share in pairs
    ]
    known = tuple(most for most in less if most is not None)
    if limits.varied:
        bounds = Bounds(limits.viscous_min or None, None, limits.gravity)
    elif bounds.gravity is not None:
        bounds = replace(bounds, gravity=limits.gravity)
    if len(known) == arm.n and (limits.varied or min(targets.peak_share) < 1):
        bounds = replace(bounds, torque=known)
    return replace(limits, torque=tuple(less)), bounds


def _tuned(m: int, model: RobotModel, limits: Limits, targets: Targets) -> TunedSet:
    """The gain set of one member."""
    name = f"tau_m{m}"
    if reasons := impossible(limits):
        return TunedSet(name, m, INFEASIBLE, reasons=tuple(reasons))
    if reasons := unknown(limits):
        return TunedSet(name, m, UNDECIDED, reasons=tuple(reasons))
    ranges = gain_ranges(m, model, limits, targets)
    obstacles = [obstacle(each, i, limits, targets) for i, each in enumerate(ranges)]
    if any(obstacles):
        return TunedSet(name, m, INFEASIBLE, reasons=tuple(filter(None, obstacles)))
    status, proposed = propose(ranges)
    starts: Sequence[float | None] = [kv for _, kv in proposed] or [None] * len(ranges)
    joints = []
    for joint, each, start in zip(limits.joints, ranges, starts, strict=True):
        units = best_units(each, start)
        kp, kv = (each.unit * k for k in units)
        damping = None if each.damping is None else each.damping.reached(kp, kv)
        ends = binding(each, *units)
        joints.append(TunedJoint(joint, kp, kv, each.sum_limit, each.kv_limit, *ends, damping))
    return TunedSet(name, m, TUNED, tuple(joints), program=status)


def _as_judged(item: TunedSet, result: GateResult) -> TunedSet:
    """A set that the gate accepts; else none, with the gate's reasons other than its gains.

    Such as an arm file that contradicts itself.

    Raises:
        ArithmeticError: the gate rejects the gains, which would be a fault of tuning.
    """
    if result.verdict == ACCEPTED:
        return replace(item, runs=runs_of(result))
    reasons = tuple(advice(result, check) for check in result.failures if check.id not in result.deciding)
    if not reasons:
        raise ArithmeticError(f"the gate says {result.verdict} to the tuned gains {result.name}")
    return TunedSet(item.name, item.m, INFEASIBLE, reasons=reasons, rejected=True)
