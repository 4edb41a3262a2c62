"""What an engineer asks about gains on an arm of one's own: six tiles, and what to do about them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from lyapcheck.answers import arm_words, file_words
from lyapcheck.answers.gate.friction import ANYWHERE, farthest
from lyapcheck.answers.gate.words import advices
from lyapcheck.answers.running import runs_of
from lyapcheck.answers.running.sampled import SAMPLED, SampledCheck
from lyapcheck.check.kinds.sampled_unstable import GrowingMotion
from lyapcheck.control.conditions import ACCEPTED, REJECTED, Check, Conditions
from lyapcheck.control.sampling import time_text
from lyapcheck.family.base import named
from lyapcheck.files.decimals import decimal_text
from lyapcheck.output.digits import at_least
from lyapcheck.output.document import command
from lyapcheck.report.findings import and_list
from lyapcheck.report.model import Motion, Tile

if TYPE_CHECKING:
    from lyapcheck._types import Array
    from lyapcheck.answers.gate.judge import GateResult
    from lyapcheck.check.loop.chain import RigidLink
    from lyapcheck.report.model import Report, RunRow
    from lyapcheck.robots import RobotModel

NARROW = 10
"""Per cent that a motor has in reserve, below which a tile is amber."""
SWINGS = 20
"""Per cent of a step, overshoot above which a tile is amber."""
FAR = 5
"""Degrees off the goal, above which a tile is amber."""


def tiles(result: GateResult, model: RobotModel, run: RunRow | None) -> tuple[Tile, ...]:
    """The six tiles of a gain set: motors, stability, rate, behaviour, dry friction, assumed numbers."""
    robot = result.limits.robot or model.name
    arm, gate = arm_words(robot), command("gate", *file_words(result.file, robot))
    return (
        _motors(result, gate),
        _stability(result, gate),
        _rate(result, model, gate),
        _behaviour(run, command("tune", *arm, "--settle", "2", "--overshoot", "5")),
        _friction(result, model, command("tune", *arm, "--rest-error", FAR)),
        _assumed(model, command("robot", *arm, "--assumptions")),
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


def _motors(result: GateResult, gate: str) -> Tile:
    """Whether k_p + k_v leaves the motors within their limits at every state, by (10i)."""
    subject, joints = "Motors", result.limits.joints
    every = Conditions(result.limits, named(result.gains.family, result.m).gamma).all(result.gains, ("10i",))
    checks = [check for check in every if check.id == "10i"]
    failed = [check for check in checks if check.verdict == REJECTED]
    if failed:
        names = and_list([joints[one.joint or 0] for one in failed])
        most = ", ".join(f"{joints[one.joint or 0]} {_largest(one)}" for one in failed)
        todo = f"Lower k_p + k_v, with these largest values in N·m: {most}."
        return Tile(subject, "can saturate", f"{names}: (10i) fails.", "bad", (todo, gate))
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
    name = joints[least.joint or 0]
    at = decimal_text(least.value or 0)
    text = f"No motor can saturate (proved). {name} is closest, at k_p + k_v = {at} N·m."
    for _, check in known:
        text = check.own_promise.says(text)
    tone = "good" if share >= NARROW else "warn"
    return Tile(subject, f"{share} % in reserve", text, tone)


def _largest(check: Check) -> str:
    return "none" if check.largest_admissible is None else check.largest_admissible.text


def _stability(result: GateResult, gate: str) -> Tile:
    """Stability of (11), for a controller of infinite rate."""
    subject, proof = "Stability", result.stable
    if proof is not None and proof.verdict == ACCEPTED:
        how = "by LaSalle's theorem" if proof.id == "lasalle" else f"ε₀ = {at_least(proof.value or 0)}"
        said = proof.own_promise.says(f"Proved at every state, {how}, for a controller of infinite rate.")
        return Tile(subject, proof.own_promise.says("stable"), said, "good")
    if result.verdict == ACCEPTED:
        said = result.says("Proved by (19), for a controller of infinite rate.")
        return Tile(subject, result.says("stable"), said, "good")
    reason = next(iter(advices(result)), "No proof was found.")
    todo = ("Look for another proof.", f"{gate} --condition lasalle")
    return Tile(subject, "undecided", f"{reason}.", "open", todo)


def _rate(result: GateResult, model: RobotModel, gate: str) -> Tile:
    """Stability as a computer runs the gains; without a rate, the periods that a usual computer may take."""
    subject = "Sampling rate"
    check = next(one for one in runs_of(result) if one.id == SAMPLED)
    ask = f"{gate} --rate 1000"
    if not isinstance(check, SampledCheck):
        return Tile(subject, "not known", f"{check.reason}.", "open", ("Ask at a rate.", ask))
    text = ". ".join(one[:1].upper() + one[1:] for one in check.sentences(False)) or check.reason
    text = f"{text}." if text and not text.endswith(".") else text
    if check.named and check.value is not None:
        period, slower = time_text(check.value), ("Raise the rate, or lower k_v.", ask)
        if check.verdict == ACCEPTED:
            return Tile(subject, check.own_promise.says(f"{period}: stable"), text, "good")
        word, tone = ("unstable", "bad") if check.verdict == REJECTED else ("undecided", "open")
        return Tile(subject, f"{period}: {word}", text, tone, slower, posture=_posture(check, model))
    stated = ("State the rate: rate = … under [loop] in the gain file.", ask)
    if check.most is not None and check.up_to is not None:
        return Tile(subject, check.up_to.says(f"at most {time_text(check.most)}"), text, "warn", stated)
    proof = None if check.refuted is None else check.refuted.proof
    known = isinstance(proof, GrowingMotion)
    number = f"unstable at {time_text(proof.period)}" if isinstance(proof, GrowingMotion) else "no rate known"
    return Tile(subject, number, text, "warn" if known else "open", stated, posture=_posture(check, model))


def _posture(check: SampledCheck, model: RobotModel) -> Motion | None:
    """The arm at the goal near which motions grow."""
    import numpy as np

    proof = None if check.refuted is None else check.refuted.proof
    if not isinstance(proof, GrowingMotion):
        return None
    return drawn_motion(model, np.zeros(1), np.radians([[float(x) for x in proof.goal]]))


def _behaviour(run: RunRow | None, tune: str) -> Tile:
    """What one simulated motion does."""
    subject = "Behaviour"
    if run is None:
        return Tile(subject, "not run", "No motion was simulated.", "open")
    over = max((x for x in run.overshoot if x is not None), default=0.0)
    settled = [x for x in run.settling if x is not None]
    goal = f"{', '.join(f'{x:g}' for x in run.target)}"
    text = f"Simulated from {', '.join(f'{x:g}' for x in run.start)} to {goal}°, without dry friction."
    number = f"{over:.0f} % overshoot, "
    if len(settled) == len(run.settling) and run.complete:
        return Tile(
            subject, f"{number}settled in {max(settled):.2g} s", text, "good" if over < 20 else "warn"
        )
    todo = ("Ask for a settling time.", tune)
    return Tile(subject, f"{number}not settled in {run.time:g} s", text, "warn", todo)


def _friction(result: GateResult, model: RobotModel, tune: str) -> Tile:
    """How far from the goal dry friction may leave the arm."""
    subject = "Dry friction"
    known = farthest(result.gains, model)
    if known is None:
        text = "The arm file gives no dry friction."
        return Tile(subject, "none known", text, "open")
    most, words = known
    text = f"{words[:1].upper()}{words[1:]}."
    if most >= ANYWHERE:
        todo = ("Raise k_p, or lower the friction.", "")
        return Tile(subject, "no bound", text, "bad", todo)
    number = f"up to {decimal_text(most)}°"
    if model.of_unknown_friction:
        todo = ("State the dry friction of each joint.", "")
        return Tile(subject, f"{number}, known in part", text, "open", todo)
    if most <= FAR:
        return Tile(subject, number, text, "good")
    return Tile(subject, number, text, "warn", ("Ask for a smaller error at rest.", tune))


def _assumed(model: RobotModel, listed: str) -> Tile:
    """How many numbers of the arm nobody measured."""
    numbers = list(model.numbers.values())
    assumed = sum(number.assumed for number in numbers)
    number = f"{assumed} of {len(numbers)} numbers"
    if not assumed:
        return Tile("Assumed", number, "All numbers of the arm are from its file.", "good")
    text = "The verdicts are about the arm with these numbers."
    todo = ("Measure them, or give each a range.", listed)
    return Tile("Assumed", number, text, "warn", todo)


# --- The arm as a picture: places of its joints along the simulated motion, seen from the side.


FRAMES = 40


def drawn_motion(model: RobotModel, t: Array, q: Array, frames: int = FRAMES) -> Motion | None:
    """The arm along a run; ``None`` where its links are not known.

    Args:
        t: times, (N,), s.
        q: angles, (N, n), rad.
    """
    import numpy as np

    chain = model.fixed().chain
    if chain is None:
        return None
    picked = np.unique(np.searchsorted(t, np.linspace(t[0], t[-1], frames)).clip(0, len(t) - 1))
    places = np.array([_places(chain.links, q[k]) for k in picked])
    up = -np.array([float(x) for x in chain.fall])
    up = up / np.linalg.norm(up) if np.linalg.norm(up) > 0 else np.array([0.0, 1.0, 0.0])
    across = places.reshape(-1, 3) - np.outer(places.reshape(-1, 3) @ up, up)
    _, _, rows = np.linalg.svd(across - across.mean(axis=0), full_matrices=False)
    side = rows[0] - (rows[0] @ up) * up
    side /= np.linalg.norm(side)
    flat = np.stack([places @ side, places @ up], axis=-1)
    rounded = [[(float(x), float(y)) for x, y in frame] for frame in np.round(flat, 4)]
    return Motion(tuple(tuple(frame) for frame in rounded), float(t[-1] - t[0]))


def _places(links: Sequence[RigidLink], q: Array) -> list[Array]:
    """Base, each joint, and the centre of mass of the last link as its end."""
    import numpy as np

    place, turn, result = np.zeros(3), np.eye(3), [np.zeros(3)]
    for link, angle in zip(links, q, strict=True):
        axis, origin, own = (np.array(x, dtype=float) for x in (link.axis, link.origin, link.turn))
        place = place + turn @ origin
        cross = np.cross(np.eye(3), axis)
        rotation = np.outer(axis, axis) + np.cos(angle) * (np.eye(3) - np.outer(axis, axis))
        turn = turn @ own @ (rotation + np.sin(angle) * cross)
        result.append(place)
    result.append(place + turn @ np.array(links[-1].com, dtype=float))
    return result
