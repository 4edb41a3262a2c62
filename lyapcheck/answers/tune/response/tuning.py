"""Gains for what is asked at the bench: searched, tried on the whole arm, confirmed by the gate."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from lyapcheck._types import part, silent
from lyapcheck.answers.gate import gate
from lyapcheck.answers.gate.stability import LASALLE, SCALAR
from lyapcheck.answers.running import runs_of
from lyapcheck.answers.tune.response.answer import IN_WORDS, BenchTuning, Candidate
from lyapcheck.answers.tune.response.search import Search
from lyapcheck.answers.tune.response.trial import BY_19, BY_PROOF, Trials
from lyapcheck.answers.tune.tuning import arm_limits, impossible, unknown
from lyapcheck.control.gains import Bounds, GainFile
from lyapcheck.control.judgement import ACCEPTED
from lyapcheck.control.limits import varied_limits
from lyapcheck.control.sampling import record_of
from lyapcheck.files.loop import NOTHING, LoopEntry
from lyapcheck.robots import load
from lyapcheck.robots.vary import at_values, corners, corners_text, outside

if TYPE_CHECKING:
    from lyapcheck._types import Progress
    from lyapcheck.answers.gate import GateResult
    from lyapcheck.control.gains import GainSet
    from lyapcheck.control.limits import Limits
    from lyapcheck.robots import RobotModel
    from lyapcheck.robots.vary import Vary


CONDITIONS = {BY_19: ("19",), BY_PROOF: (SCALAR, LASALLE)}
"""What shows stability beside (10i), by the way that is asked for; the first that the gate accepts counts."""


def tune_for(
    robot: str,
    bench: Trials,
    members: Sequence[int] = (1,),
    bounds: Bounds | None = None,
    varies: tuple[Vary, ...] = (),
    loop: LoopEntry = NOTHING,
    on_progress: Progress | None = None,
) -> BenchTuning:
    """The gains that meet what is asked best, for each member and way to show stability.

    Args:
        robot: a built-in arm, or the path of an arm file.
        bench: what is asked, of which motions, and how stability may be shown.
        members: m of each gain set.
        bounds: limits to take instead of the arm's.
        varies: ranges of the arm's numbers; the worst of motions at their ends counts, limits hold for all.
        loop: how a computer runs the gains, before what the arm file says of it.
        on_progress: receives the fraction done.

    Raises:
        InputError: the arm cannot be used.

    Soundness: each set is accepted by the gate, with (10i) and the condition it names. What motions show is
        floating point, and that no better gains exist is not proved.

    References: (6), (10), (11), (19) of reyes2019family.
    """
    model = load(robot)
    limits = arm_limits(robot, model.n, bounds, varies)
    ranges = {robot: varied_limits(robot, varies)} if varies else None
    arms, tried_on = _arms(robot, model, varies)
    record = record_of(loop, NOTHING, model.loop)
    jobs = [(m, way) for m in dict.fromkeys(members) for way in bench.ways]
    sets: list[Candidate] = []
    reasons = [*unknown(limits), *(text for text in impossible(limits) if "gravity" in text)]
    for done, (m, way) in enumerate([] if reasons else jobs):
        note = f"m = {m}, {IN_WORDS[way]}"
        told = part(on_progress or silent, done / len(jobs), (done + 1) / len(jobs), note)
        search = Search(bench, arms, limits, m, way, record)
        if not search.possible:
            reasons.append(_none(m, way, limits))
            continue
        result = search.run(told)
        judged = accepted(result.gains, way, robot, bounds, ranges, loop)
        own = judged if judged.verdict == ACCEPTED else None
        gains = result.gains if own is None else own.gains
        held = tuple(_held(gains, search))
        sets.append(Candidate(gains, result.trial, way, held, own, runs_of(judged)))
    return BenchTuning(
        robot,
        model,
        bench,
        tuple(sets),
        tuple(dict.fromkeys(reasons)),
        limits.assumptions,
        tried_on,
        bounds or Bounds(),
        varies,
        loop,
    )


def _arms(robot: str, model: RobotModel, varies: tuple[Vary, ...]) -> tuple[tuple[RobotModel, ...], str]:
    """The arms that gains are tried on, and what these are; empty for the arm of the file alone.

    Without ranges to vary: also the ends of what is assumed, all together; viscous friction that is assumed
    without a range may be down to a tenth.
    """
    if not varies:
        low, high = {}, {}
        for key, number in model.numbers.items():
            if number.assumed and (number.ranged or key.endswith("_viscous")):
                low[key], high[key] = number.bounds if number.ranged else (number.value / 10, number.value)
        arms = [at_values(model, values) for values in (low, high) if values]
        return (model, *arms), "the arm of the file and both ends of its assumed numbers" if arms else ""
    ranged = load(robot, vary=varies)
    ends = tuple(arm for _, arm in corners(ranged, varies))
    text = corners_text(ranged, varies)
    if outside(model, ranged):
        return ends, f"{text}; the values of the file lie outside"
    return (model, *ends), f"the nominal arm and {text}"


def _none(m: int, way: str, limits: Limits) -> str:
    if way == BY_19 and not limits.viscous_min:
        return f"m = {m}: (19) admits no k_v without viscous friction; stability by proof does without it"
    rule = "(19) admits no k_v" if way == BY_19 else "(10i) leaves no room for gains"
    return f"m = {m}: {rule} with so few decimal places; raise --digits"


def accepted(
    gains: GainSet,
    way: str,
    robot: str,
    bounds: Bounds | None,
    ranges: dict[str, Limits] | None,
    loop: LoopEntry,
) -> GateResult:
    """The set as the gate accepts it, with the conditions by which it does; else as it does not."""
    for condition in CONDITIONS[way]:
        named = replace(gains, condition=("10i", condition))
        file = GainFile("tuned gains", robot, (named,), bounds or Bounds(), loop=loop)
        (result,) = gate(file, robot, arms=ranges)
        if result.verdict == ACCEPTED:
            break
    return result


def _held(gains: GainSet, search: Search) -> Iterator[str]:
    rows = zip(gains.kp, gains.kv, search.most_sum, search.most_kv, strict=True)
    for kp, kv, most, most_kv in rows:
        rules = ["(10i)"] if kp + kv == most * search.unit else []
        if search.way == BY_19 and kv == most_kv * search.unit:
            rules.append("(19)")
        yield ", ".join(rules)
