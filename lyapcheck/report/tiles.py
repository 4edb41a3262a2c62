"""What an engineer asks about gains on an arm of one's own: six tiles, and what to do about them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import ceil, degrees
from typing import TYPE_CHECKING, Any

from lyapcheck.answers import arm_words, bounds_words, file_words
from lyapcheck.answers.gate.friction import ANYWHERE, farthest
from lyapcheck.answers.gate.words import advices
from lyapcheck.answers.running import runs_of
from lyapcheck.answers.running.holds import HOLDS, NO_LINKS, HoldsCheck, falls, farthest_unknown
from lyapcheck.answers.running.sampled import SAMPLED, SampledCheck
from lyapcheck.check.kinds.inertia import PostureWitness
from lyapcheck.check.kinds.sampled_unstable import GrowingMotion
from lyapcheck.check.loop.chain import UNIT, Posture, RigidLink
from lyapcheck.check.numbers.vectors import Algebra, Matrix, Vector
from lyapcheck.control.conditions import ACCEPTED, REJECTED, Check, Conditions
from lyapcheck.control.sampling import time_text
from lyapcheck.family.base import named
from lyapcheck.files.decimals import decimal_text, significant_up
from lyapcheck.output.digits import at_least
from lyapcheck.output.document import command
from lyapcheck.promise import all_say
from lyapcheck.report.findings import and_list
from lyapcheck.report.model import Motion, Tile, keeps_limits

if TYPE_CHECKING:
    from lyapcheck._types import Array
    from lyapcheck.answers.gate.judge import GateResult
    from lyapcheck.report.model import Report, RunRow
    from lyapcheck.robots import RobotModel

NARROW = 10
"""Per cent that a motor has in reserve, below which a tile is amber."""
USUAL_RATE = 1000
"""Hz, asked about where a file gives no rate."""
SWINGS = 20
"""Per cent of a step, overshoot above which a tile is amber."""
FAR = 5
"""Degrees off the goal, above which a tile is amber."""


def tiles(result: GateResult, model: RobotModel, run: RunRow | None) -> tuple[Tile, ...]:
    """The six tiles of a gain set: motors, stability, rate, behaviour, dry friction, assumed numbers."""
    robot = result.limits.robot or model.name
    gate = ("gate", *file_words(result.file, robot))
    member = (*(() if result.m is None else ("--m", result.m)), *bounds_words(result.file.bounds))
    targets = ("--overshoot", 5, "--settle", 2.5, *(("--rest-error", FAR) if model.dry else ()))
    tune = command("tune", *arm_words(robot), *member, *targets, "--out", "tuned.toml")
    return (
        _motors(result, command(*gate)),
        _stability(result, command(*gate, "--condition", "lasalle")),
        _rate(result, model, gate),
        _behaviour(run, result, tune, command("simulate", *gate[1:])),
        _friction(result, model, tune),
        _assumed(model, command("robot", *arm_words(robot), "--assumptions")),
    )


def with_before(report: Report, old: Mapping[str, Any]) -> Report:
    """The same with the answers of an older report, as its data has them, where they were others."""
    was = {(one["gains"], one["subject"]): one["number"] for one in old.get("tiles", ())}
    changed = {
        name: tuple(
            replace(one, before=before) if (before := was.get((name, one.subject), "")) != one.number else one
            for one in known
        )
        for name, known in report.tiles.items()
    }
    return replace(report, tiles=changed)


def _motors(result: GateResult, ask: str) -> Tile:
    """Whether k_p + k_v leaves the motors within their limits at every state, by (10i)."""
    subject, joints = "Motors", result.limits.joints
    every = Conditions(result.limits, named(result.gains.family, result.m).gamma).all(result.gains, ("10i",))
    checks = [check for check in every if check.id == "10i"]
    failed = [check for check in checks if check.verdict == REJECTED]
    if failed:
        names = and_list([joints[one.joint or 0] for one in failed])
        most = ", ".join(f"{joints[one.joint or 0]} {_largest(one)}" for one in failed)
        todo = f"Lower k_p + k_v, with these largest values in N·m: {most}."
        return Tile(subject, "can saturate", f"{names}: (10i) fails.", "bad", (todo, ask))
    known = [
        (int(100 * (check.limit.lower - check.value) / check.limit.lower), check)  # rounded down
        for check in checks
        if check.verdict == ACCEPTED and check.limit is not None and check.value is not None
        if check.limit.lower > 0
    ]
    if len(known) < len(joints):
        text = "A torque limit is missing, or h has no bound."
        return Tile(subject, "not known", text, "open", ("Give each joint a torque limit.", ""))
    share, least = min(known, key=lambda pair: pair[0])
    name, under = joints[least.joint or 0], result.file.bounds.said
    at, end = decimal_text(least.value or 0), "" if least.limit is None else at_least(least.limit.lower)
    text = f"No motor can saturate (proved{under}). {name} is closest: k_p + k_v = {at} of {end} N·m."
    for _, check in known:
        text = check.own_promise.says(text)
    return Tile(subject, f"{share} % in reserve", text, "good" if share >= NARROW else "warn")


def _largest(check: Check) -> str:
    return "none" if check.largest_admissible is None else check.largest_admissible.text


def _stability(result: GateResult, ask: str) -> Tile:
    """Stability of (11), for a controller of infinite rate that knows gravity and motors without limits."""
    subject, proof, under = "Stability", result.stable, result.file.bounds.said
    known = result.record is None or result.record.knows_gravity
    where = ""
    end = f"for a controller of infinite rate{'' if known else ' that knows all gravity'}."
    if proof is not None:
        how = "by LaSalle's theorem" if proof.id == "lasalle" else f"ε₀ = {at_least(proof.value or 0)}"
        where = " at nominal numbers" if result.limits.nominal else ""
        said, promises = f"Proved at every state{where}{under}, {how}, {end}", [proof.own_promise]
    elif result.verdict_of(("19",)) == ACCEPTED:
        said = f"Proved by (19){under}, {end}"
        promises = [check.own_promise for check in result.checks if check.id == "19"]
    else:
        reason = next(iter(advices(result)), "No proof was found")
        return Tile(subject, "undecided", f"{reason}.", "open", ("Look for another proof.", ask))
    if keeps_limits(result):
        number = f"stable{where}{'' if known else ' if all gravity is known'}"
        return Tile(subject, all_say(promises, number), all_say(promises, said), "good" if known else "warn")
    text = f"{said} Nothing shows that the motors stay within their limits."
    number = "stable while no motor saturates"
    return Tile(subject, all_say(promises, number), all_say(promises, text), "warn")


def _rate(result: GateResult, model: RobotModel, gate: Sequence[object]) -> Tile:
    """Stability as a computer runs the gains; without a rate, the periods that a usual computer may take."""
    subject = "Sampling rate"
    check = next(one for one in runs_of(result) if one.id == SAMPLED)
    refuted = check.refuted if isinstance(check, SampledCheck) else None
    growing = refuted.proof if refuted is not None and isinstance(refuted.proof, GrowingMotion) else None
    fast = USUAL_RATE if growing is None else max(USUAL_RATE, ceil(2 / growing.period))
    if isinstance(check, SampledCheck) and check.most is not None:
        fast = max(USUAL_RATE, ceil(1 / check.most))
    ask = command(*gate, "--rate", fast)
    if not isinstance(check, SampledCheck):
        return Tile(subject, "not known", f"{check.reason}.", "open", ("Ask at a rate.", ask))
    said = check.sentences(False) or [check.reason]
    decided = check.verdict in (ACCEPTED, REJECTED) or check.most is not None or check.from_rest is not None
    if check.named and check.value is not None and not decided:
        said.insert(0, f"no proof and no counterexample at {time_text(check.value)}")
    text = "".join(f"{one[:1].upper()}{one[1:]}. " for one in said if one).rstrip()
    posture = () if growing is None else _posture(model, [float(x) for x in growing.goal])
    # of (P) nothing is known before it is asked for, and of an arm with dry friction it does not speak
    from_rest = not check.rests and check.record.within is None
    simulated = command("simulate", *gate[1:], "--rate", fast)
    prove = ("Ask for a proof from rest.", f"{ask} --within 90")
    unproved = prove if from_rest else ("No rate is proved: lower k_v, or look at a simulation.", simulated)
    if check.named and check.value is not None:
        period = time_text(check.value)
        if check.verdict == ACCEPTED:
            number = f"{period}: {'comes to rest' if check.rests else 'stable'}"
            number = f"stable {check.narrow}" if check.narrow else number
            return Tile(subject, check.own_promise.says(number), text, "good")
        todo = unproved if check.most is None and growing is None else ("Raise the rate, or lower k_v.", ask)
        word, tone = ("unstable", "bad") if check.verdict == REJECTED else ("undecided", "open")
        return Tile(subject, f"{period}: {word}", text, tone, todo, posture=posture)
    stated = (f"State the rate, for example rate = {fast} under [loop] in the gain file.", ask)
    if check.most is not None and check.up_to is not None:
        return Tile(subject, check.up_to.says(f"at most {time_text(check.most)}"), text, "warn", stated)
    if growing is None:
        return Tile(subject, "no rate known", text, "open", unproved)
    return Tile(subject, f"unstable at {time_text(growing.period)}", text, "warn", stated, posture=posture)


def _posture(model: RobotModel, degrees: Sequence[float]) -> tuple[Motion, ...]:
    """The arm at one place, drawn as a motion that stands still."""
    import numpy as np

    return drawn_motions(model, np.zeros(1), np.radians([degrees]))


def _behaviour(run: RunRow | None, result: GateResult, tune: str, look: str) -> Tile:
    """What one simulated motion of (11) does; of a loop that a computer runs it is a hint only."""
    subject = "Behaviour"
    if run is None:
        return Tile(subject, "not run", "No motion was simulated.", "open")
    over = max((x for x in run.overshoot if x is not None), default=0.0)
    settled = [x for x in run.settling if x is not None]
    goal = f"{', '.join(f'{x:g}' for x in run.target)}"
    text = f"Simulated from {', '.join(f'{x:g}' for x in run.start)} to {goal}°, without dry friction."
    number = f"{over:.0f} % overshoot, "
    if result.record is not None:
        text = text.replace("without", "at an infinite rate, with all gravity known, without")
        todo = ("Look at the loop as a computer runs it.", look)
        return Tile(subject, f"{number}if ideal", text, "warn", todo)
    if len(settled) < len(run.settling) or not run.complete:
        todo = ("Ask for a settling time.", tune)
        return Tile(subject, f"{number}not settled in {run.time:g} s", text, "warn", todo)
    number = f"{number}settled in {max(settled):.2g} s"
    if over < SWINGS:
        return Tile(subject, number, text, "good")
    return Tile(subject, number, text, "warn", ("Ask for less overshoot.", tune))


def _friction(result: GateResult, model: RobotModel, tune: str) -> Tile:
    """How far from the goal dry friction and unknown gravity may leave the arm."""
    subject = "Dry friction"
    stated = result.record is not None and not result.record.knows_gravity
    loads = [check for check in result.checks if check.id == HOLDS and stated]
    if fallen := [check for check in loads if isinstance(check, HoldsCheck) and check.verdict == REJECTED]:
        return _fallen(fallen, result.limits.joints, model, tune)
    dry, loaded = farthest(result, model), farthest_unknown(loads)
    if loads and loaded is None:
        reason = next((check.reason for check in loads if check.reason), "")
        lower = "Raise k_p, or lower the unknown load."
        todo = ("Give the arm by its links." if reason == NO_LINKS else lower, "")
        return Tile(subject, "no bound", f"{reason[:1].upper()}{reason[1:]}.", "open", todo)
    known = [one for one in (loaded, dry) if one is not None]
    if not known:
        return Tile(subject, "none known", "The arm file gives no dry friction.", "open")
    most, words = max(known, key=lambda one: one[0])
    text = f"{words[:1].upper()}{words[1:]}."
    if dry is None:
        text += " The arm file gives no dry friction."
    if most >= ANYWHERE:
        return Tile(subject, "no bound", text, "bad", ("Raise k_p, or lower the friction.", tune))
    number = f"up to {decimal_text(significant_up(most, 4) if most else most)}°"
    if model.of_unknown_friction:
        todo = ("State the dry friction of each joint.", "")
        return Tile(subject, f"{number}, known in part", text, "open", todo)
    near = most <= FAR
    todo = ("", "") if near else ("Ask for a smaller error at rest.", tune)
    return Tile(subject, number, text, "good" if near else "warn", todo)


def _fallen(checks: Sequence[HoldsCheck], joints: Sequence[str], model: RobotModel, tune: str) -> Tile:
    """The joints that fall under an unknown load, and the arm where the first of them does."""
    names = and_list([joints[one.joint or 0] for one in checks])
    text = ". ".join(falls(one, joints) for one in checks)
    first = checks[0]
    proof = None if first.judgement is None else first.judgement.proof
    place = [degrees(x) for x in proof.q] if isinstance(proof, PostureWitness) else None
    return Tile(
        "Dry friction",
        f"{names} {'falls' if len(checks) == 1 else 'fall'}",
        f"{text}.",
        "bad",
        (f"Raise k_p, or lower the unknown load, {first.unknown}.", tune),
        posture=() if place is None else _posture(model, place),
    )


def _assumed(model: RobotModel, ask: str) -> Tile:
    """How many numbers of the arm nobody measured."""
    numbers = list(model.numbers.values())
    assumed = [number for number in numbers if number.assumed]
    number = f"{len(assumed)} of {len(numbers)} numbers"
    if not assumed:
        return Tile("Assumed", number, "All numbers of the arm are from its source.", "good")
    exact = sum(not one.ranged for one in assumed)
    if exact:
        text, todo = f"{exact} of them without a range.", "Measure them, or give each a range."
    else:
        text, todo = "Each of them has a range.", "Measure them to narrow their ranges."
    return Tile("Assumed", number, text, "warn", (todo, ask))


# --- The arm as a picture: places of its joints along the simulated motion, seen from the side.


FRAMES = 40


def drawn_motions(model: RobotModel, t: Array, q: Array, frames: int = FRAMES) -> tuple[Motion, ...]:
    """The arm along a run; M(q) and g(q) alone give no lengths of links, so then a dial for each joint.

    Args:
        t: times, (N,), s.
        q: angles, (N, n), rad.
    """
    import numpy as np

    chain, seconds = model.fixed().chain, float(t[-1] - t[0])
    picked = np.unique(np.searchsorted(t, np.linspace(t[0], t[-1], frames)).clip(0, len(t) - 1))
    if chain is None:
        hands = np.stack([np.cos(q[picked]), np.sin(q[picked])], axis=-1)
        return tuple(
            Motion(tuple(((0.0, 0.0), (float(x), float(y))) for x, y in hands[:, i]), seconds, joint)
            for i, joint in enumerate(model.joints)
        )
    places = np.array([_places(chain.links, q[k]) for k in picked], dtype=float)
    up = -np.array([float(x) for x in chain.fall])
    up = up / np.linalg.norm(up) if np.linalg.norm(up) > 0 else np.array([0.0, 1.0, 0.0])
    across = places.reshape(-1, 3) - np.outer(places.reshape(-1, 3) @ up, up)
    _, _, rows = np.linalg.svd(across - across.mean(axis=0), full_matrices=False)
    side = rows[0] - (rows[0] @ up) * up
    side /= np.linalg.norm(side)
    flat = np.stack([places @ side, places @ up], axis=-1)
    rounded = [[(float(x), float(y)) for x, y in frame] for frame in np.round(flat, 4)]
    return (Motion(tuple(tuple(frame) for frame in rounded), seconds),)


def _places(links: Sequence[RigidLink], q: Array) -> list[Vector]:
    """Base, each joint, and the centre of mass of the last link as its end."""
    import numpy as np

    of = Algebra(float)
    place: Vector = [0.0] * 3
    turn: Matrix = UNIT
    result = [place]
    for link, own in zip(links, Posture(links, [*np.sin(q)], [*np.cos(q)], of).turns, strict=True):
        place, turn = of.add(place, of.apply(turn, link.origin)), of.product(turn, own)
        result.append(place)
    return [*result, of.add(place, of.apply(turn, links[-1].com))]
