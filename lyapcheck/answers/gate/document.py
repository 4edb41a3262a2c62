"""The gate's answer for people: a headline, the deciding rows, remarks and the next command."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from itertools import chain
from typing import TYPE_CHECKING

from lyapcheck.answers import arm_words, assumed_line, bounds_words, file_words
from lyapcheck.answers.gate import accepting, proved_otherwise, remarks, without_19
from lyapcheck.answers.gate.friction import ANYWHERE, farthest, swinging, without_friction
from lyapcheck.answers.gate.judge import BREAKS_19, GateResult
from lyapcheck.answers.gate.words import FIELDS, RULES, SYMBOLS, Row, about, advices, repairs
from lyapcheck.answers.running import INFINITE, open_as_run, unstable_alone
from lyapcheck.answers.running.holds import HOLDS, NO_LINKS, farthest_unknown
from lyapcheck.answers.running.sampled import SampledCheck
from lyapcheck.control.conditions import ACCEPTED, REJECTED, UNDECIDED, Check
from lyapcheck.control.gains import CERTIFICATES
from lyapcheck.control.sampling import exact_only, loop_words
from lyapcheck.output.document import Block, Bullets, Document, Section, Table, command
from lyapcheck.output.fields import table
from lyapcheck.output.text import HEADLINE
from lyapcheck.promise import all_say

if TYPE_CHECKING:
    from lyapcheck.answers.gate import GateAnswer
    from lyapcheck.answers.gate.friction import Fact

NAMED = "!"
"""Accepted, with a fact that no condition is about."""
MOST_ROWS, MOST_REMARKS = 16, 3
TARGETS = "--overshoot", "5", "--settle", "2"


def document(answer: GateAnswer) -> Document:
    """One gain set with its deciding checks, or a row a set."""
    lead, said, details = _of_one(answer[0]) if len(answer) == 1 else _of_many(answer)
    if any(result.record is None or result.record.period is None for result in answer):
        lead[1:] = ["; ".join([*lead[1:], INFINITE])]
    # what nobody may miss: ranges with their cost, an arm file that looks wrong, bounds without proof
    every = [result.limits for result in answer]
    warned = ((*one.ranges, *one.doubts, *(one.gravity_notes if one.model else ())) for one in every)
    said = list(dict.fromkeys([*chain.from_iterable(warned), *said]))
    many = len(answer) > 1
    rows = sorted(_rows(answer), key=lambda row: (row.check.verdict == ACCEPTED, many and _room(row.check)))
    blocks: list[Block] = [_table(rows[:MOST_ROWS], many)] if rows else []
    if len(rows) > MOST_ROWS:
        said.insert(0, f"{len(rows) - MOST_ROWS} further rows: -v shows them")
    blocks += [Bullets(tuple(said[:MOST_REMARKS]))] if said else []
    checks = () if many else chain.from_iterable(result.checks for result in answer)
    kept = [Row(answer[0], one) for one in checks if not any(one is row.check for row in rows[:MOST_ROWS])]
    more: list[Block] = [Section("Other conditions", (_table(kept),))] if kept else []
    more += (
        [Section("Further remarks", (Bullets(tuple(said[MOST_REMARKS:])),))] if said[MOST_REMARKS:] else []
    )
    shown = dict.fromkeys(check.id for result in answer for check in result.checks)
    formulas = tuple(f"({name}) {RULES[name].formula}" for name in shown)
    more += [*details, Section("Formulas", (Bullets(formulas),))] if formulas else details
    notes = dict.fromkeys(text for result in answer for text in result.rests_on)
    count = len({problem.path for problem in answer.problems})
    unread = f"; {count} other file{'s' * (count > 1)} cannot be used" if count else ""
    return Document(
        f"{_title(answer)}{unread}",
        tuple(blocks),
        tuple(notes),
        tuple(lead[:2]),
        tuple(more),
        _assumed(answer),
        _next(answer),
    )


def _of_one(result: GateResult) -> tuple[list[str], list[str], list[Block]]:
    """More of the headline, remarks and details."""
    said, fixes = remarks(result), repairs(result)
    if result.verdict == ACCEPTED:
        aside = [] if "19" in result.deciding else without_19(result)
        details: list[Block] = [Section("(19)", (Bullets(tuple(aside)),))] if aside else []
        found = fact(result)
        open_ = open_as_run(result.checks)
        if found and found[1] == unstable_alone(result.checks):
            open_ = open_as_run(result.checks, unstable=False)
        lead = [_meaning(result), *([open_] if open_ and found and found[1] != open_ else [])]
        if len(standing(result)) > HEADLINE and len(joined := "; ".join(lead)) <= HEADLINE:
            lead = [joined]
        return lead, [text for text in said if text not in aside], details
    wrong = Section("What is wrong", (Bullets((*advices(result), *said)),))
    if result.standing == BREAKS_19:
        return [proved_otherwise(result, titled=True)], [*fixes, *said[1:]], [wrong]
    short = [text for text in fixes[:1] if len(text) <= HEADLINE]
    return short, [*fixes[len(short) :], *said], [wrong]


def _of_many(answer: GateAnswer) -> tuple[list[str], list[str], list[Block]]:
    failed = [result for result in answer if result.verdict != ACCEPTED]
    accepted = [result for result in answer if result.verdict == ACCEPTED]
    lead = list(dict.fromkeys(_meaning(result, "accepted: ") for result in accepted))
    lead = lead if len(lead) == 1 else []
    far = _farthest(answer) if failed else None
    said = [far[1]] if far else []
    for result in failed:
        fixes = [proved_otherwise(result)] if result.standing == BREAKS_19 else repairs(result)
        said += [f"{result.name}: {text}" for text in fixes[:1]]
    return lead, said, [_section(result) for result in answer]


def _meaning(result: GateResult, before: str = "") -> str:
    """What an accepted set is known to do."""
    limits, torques = result.limits, [result.verdict_of((name,)) for name in ("10i", "10p")]
    words = ", ".join(_holds(result, name) for name in result.deciding)
    if set(result.deciding) & set(CERTIFICATES) and ACCEPTED not in torques:
        words += " while no motor saturates"
    where = "under [bounds]" if limits.model is None else f"for {limits.model.name}{result.file.bounds.said}"
    return result.says(f"{before}{words}, proved {where}{' over its ranges' if limits.varied else ''}")


def _holds(result: GateResult, name: str) -> str:
    for check in result.checks:
        if isinstance(check, SampledCheck) and check.id == name:
            end = f", {check.narrow} only" if check.narrow else ""
            return f"{'comes to rest as run' if check.rests else 'stable as run'} (sampled){end}"
    return RULES[name].holds + " at nominal numbers" * (name in CERTIFICATES and result.limits.nominal)


def _title(answer: GateAnswer) -> str:
    verdicts = [result.verdict for result in answer]
    worst = next((v for v in (REJECTED, UNDECIDED) if v in verdicts), ACCEPTED)
    far = _farthest(answer) if worst == ACCEPTED else None
    symbol = NAMED if far else SYMBOLS[worst]
    if len(answer) == 1:
        return f"{symbol} {standing(answer[0])}"
    words = [result.standing for result in answer]
    counts = {word: words.count(word) for word in (REJECTED, BREAKS_19, UNDECIDED, ACCEPTED)}
    counted = "; ".join(_counted(answer, word, count) for word, count in counts.items() if count)
    return "; ".join((f"{symbol} {counted or 'no gain sets'}", *([far[1]] if far else [])))


def _farthest(answer: GateAnswer) -> Fact | None:
    facts = (found for result in answer if (found := fact(result)))
    return max(facts, key=lambda one: one[0], default=None)


def standing(result: GateResult) -> str:
    """A set with its verdict, where it fails, and a fact that no condition is about."""
    found = fact(result)
    failed = "" if result.standing in (ACCEPTED, BREAKS_19) else _where(result)
    failed += " at nominal numbers" if result.standing == BREAKS_19 and result.limits.nominal else ""
    said = f"{result.name}: {result.spoken_standing}{failed}"
    return said if found is None else f"{said}; {found[1]}"


def _where(result: GateResult) -> str:
    ids: dict[str, list[str]] = {}
    for check in result.failures:
        if check.verdict == result.verdict:
            ids.setdefault(check.id, []).append(Row(result, check).joint)
    few = [f"({name}) at {' and '.join(joints)}" for name, joints in ids.items() if len(joints) < 3]
    few += [f"({name}) at {len(joints)} joints" for name, joints in ids.items() if len(joints) > 2]
    return f", {', '.join(few).replace(' at all', '')}" if few else ""


def _counted(answer: GateAnswer, word: str, count: int) -> str:
    """So many sets of a standing, as the promises on each of them allow to say it."""
    words = f"{count} {word.replace('breaks', 'break') if count > 1 else word}"
    known = [result for result in answer if result.standing == word]
    if word == ACCEPTED:
        return all_say((one for result in known for one in result.grounds.promises), words)
    if word == BREAKS_19:
        return all_say((result.stable.own_promise for result in known if result.stable), words)
    return words


def fact(result: GateResult) -> Fact | None:
    """What decides nothing of a set that is accepted: rest beside the goal, else the loop as it is run."""
    model = result.limits.model
    if not result.explained or result.verdict != ACCEPTED:
        return None
    if model is None:
        open_ = open_as_run(result.checks)
        return (Fraction(0), open_) if open_ else None
    if alone := unstable_alone(result.checks):
        return ANYWHERE, alone
    unknown = farthest_unknown(result.checks)
    if unknown is not None:
        return unknown[0], unknown[1] + without_friction(model) + exact_only(result.record)
    far = farthest(result, model)
    if far is not None:
        return far
    open_ = open_as_run(result.checks) or swinging(result.gains, model)
    return (Fraction(0), open_) if open_ else None


def _rows(answer: GateAnswer) -> list[Row]:
    """The deciding checks of one set, or of each of many the one that fails or is tightest."""
    if len(answer) == 1:
        return [Row(answer[0], check) for check in answer[0].checks if answer[0].decides(check)]
    rows = []
    for result in answer:
        deciding = result.failures or [check for check in result.checks if result.decides(check)]
        rows += [Row(result, min(deciding, key=_room))] if deciding else []
    return rows


def _room(check: Check) -> Fraction:
    """The margin as a share of the limit."""
    if check.limit is None or check.margin is None or not check.limit.lower:
        return Fraction(10**6)
    return check.margin / abs(check.limit.lower)


def _table(rows: Sequence[Row], named: bool = False) -> Table:
    """Of checks of one set, or of the sets by their names; a narrow terminal does without the limit."""
    keys = 4 if named else 3
    fields = FIELDS if named else [field for field in FIELDS if field.head != "gain set"]
    caption = "The tightest condition of each set; all with -v." if named else ""
    return table(fields, [(row,) for row in rows], caption, keys, (keys + 1,))


def _section(result: GateResult) -> Section:
    """One of many sets, whole."""
    symbol = NAMED if fact(result) else SYMBOLS[result.verdict]
    title = f"{symbol} {standing(result)} ({about(result)}, {result.file.path})"
    said = (*advices(result), *remarks(result))
    rows = [Row(result, check) for check in result.checks]
    return Section(title, (_table(rows), *([Bullets(said)] if said else [])))


def _assumed(answer: GateAnswer) -> str:
    limits = {result.limits.robot: result.limits for result in answer}
    if len(limits) > 1:
        return f"{len(limits)} arms: --explain lists what is assumed of each"
    for robot, one in limits.items():
        if one.model is None:
            return "; ".join(one.assumptions)
        premises = sum(len(result.grounds.premises) for result in answer[:1])
        unshown = f"{premises} bounds of gravity are premises (--explain); " if premises else ""
        return unshown + assumed_line(one.model, robot)
    return ""


def _next(answer: GateAnswer) -> str:
    """The command that follows from the first set that needs one, else a simulation."""
    if not answer:
        return command("init", "bench")
    order = {REJECTED: 0, UNDECIDED: 1, ACCEPTED: 2}
    result = min(answer, key=lambda one: order[one.verdict])
    limits = result.limits
    robot = arm_words(limits.robot) if limits.robot else []
    again = file_words(result.file, limits.robot)
    if conditions := accepting(result):
        return command("gate", *again, *conditions)
    missing = [check.id for check in result.failures if check.id in ("scalar", "global")]
    if result.verdict == UNDECIDED and missing and limits.model is not None:
        other = ["lasalle" if name in missing else name for name in result.deciding]
        named = (word for name in dict.fromkeys(other) for word in ("--condition", name))
        return command("gate", *again, *named)
    torques = (check for check in result.failures if check.id in ("10", "10p", "10i"))
    if robot and any(check.limit is not None and check.limit.upper <= 0 for check in torques):
        return command("robot", *robot, "-v")  # gravity alone needs the motor, and no gains help
    if result.verdict == REJECTED and limits.model is not None and result.m is not None:
        held = HOLDS not in [check.id for check in result.failures]  # else for gains beyond (10p), by proof
        words = (*loop_words(result.file.loop, result.record), *bounds_words(result.file.bounds))
        return command("tune", *robot, "--m", result.m, *words, *([] if held else TARGETS))
    plain = result.verdict == ACCEPTED and limits.model is not None and result.gains.angle_unit == "rad"
    unknown = any(check.reason == NO_LINKS for check in result.checks)  # no run knows that payload either
    return command("simulate", *again) if plain and not unknown else command("gate", *again, "--explain")
