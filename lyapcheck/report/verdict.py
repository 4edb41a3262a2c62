"""The answer in ten seconds: is the proposition true, where does its printed proof break, which gains pass.

Everything here is computed from verdicts; a report that could not decide something says so.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from lyapcheck.answers.gate import GateAnswer
from lyapcheck.answers.gate.judge import BREAKS_19, GateResult
from lyapcheck.check.kinds.sampled import SampledStable
from lyapcheck.control.conditions import ACCEPTED, REJECTED
from lyapcheck.files.decimals import decimal_text
from lyapcheck.output.document import Bullets, Paragraph, Section, Table
from lyapcheck.promise import all_say
from lyapcheck.report.findings import and_list
from lyapcheck.report.jobs import BOUNDS, CLASS, SAMPLED
from lyapcheck.report.model import Box, ClaimRow, Report, applies, behind, keeps_limits
from lyapcheck.verdicts import Verdict

THIS_ARM = "arm.stable"
"""The claim that says the same of the arm and the gains at hand."""


@dataclass(frozen=True)
class Badge:
    """One of the words on the first screen; ``tone`` is ``good``, ``bad``, ``warn`` or ``open``."""

    subject: str
    word: str
    tone: str


@dataclass(frozen=True)
class VerdictBox:
    """A box of the picture with what became of its claims; ``tone`` as of badges."""

    box: Box
    tone: str
    word: str


def sentences(report: Report) -> tuple[str, ...]:
    """The three sentences of the first screen; about an arm of one's own, those on its gains."""
    if report.own:
        return _gains(report)
    return (_theorem(report), _proof(report), *_gains(report))


def badges(report: Report) -> tuple[Badge, ...]:
    """Theorem, proof, tables, experiment and computer; of an arm of one's own, its gain sets."""
    if report.own:
        return tuple(map(_of_gains, report.gate))
    true, broken = _is_true(report), break_places(report)
    every = " for every n" if {row.n for row in _concluding(report)} == {None} else ""
    theorem = Badge("theorem", "not decided", "open")
    if true:
        theorem = Badge("theorem", _say(_concluding(report), f"proved{every}"), "good")
    if broken:
        proof = Badge("printed proof", f"breaks at {broken[0]}", "bad")
    else:
        held = set(report.verdicts((report.notes.paper.theorem,), "published")) == {"proved"}
        proof = Badge("printed proof", "holds", "good") if held else Badge("printed proof", "open", "open")
    judged = [row for row in report.gate if applies(row)]
    passed = [row for row in judged if row.verdict == ACCEPTED]
    failed = [row for row in judged if row.verdict != ACCEPTED]
    parts = (passed, "passes", "pass"), (failed, "does not", "do not")
    words = [
        f"m = {and_list([str(row.m) for row in rows])} {one if len(rows) == 1 else more}"
        for rows, one, more in parts
        if rows
    ]
    said = f"{', '.join(words)}; {len(report.weighing('C'))} misprints"
    tables = Badge("tables", said, "warn" if failed else "good")
    wrong = len(report.weighing("D"))
    refuted = f"{wrong} statement{'s' if wrong > 1 else ''} refuted"
    experiment = Badge("experiment", *((refuted, "warn") if wrong else ("nothing refuted", "open")))
    return theorem, proof, tables, experiment, Badge("on a computer", *_on_a_computer(report))


def chain(report: Report) -> tuple[VerdictBox, ...]:
    """The printed proof, box by box."""
    carrying = behind(report.notes.paper.theorem, report.claims)
    return tuple(_step(box, report, carrying) for box in report.notes.chain)


def route(report: Report) -> tuple[VerdictBox, ...]:
    """The alternative proof; empty where a part of it is not proved."""
    steps = tuple(_step(box, report, set()) for box in report.notes.route)
    return steps if all(step.tone == "good" for step in steps) else ()


def break_places(report: Report) -> list[str]:
    """Where the refuted claims stand that the theorem rests on and that rest on no other of them."""
    carrying = behind(report.notes.paper.theorem, report.claims)
    refuted = {row.id: row for row in report.claims if row.verdict == "refuted" and row.id in carrying}
    first = [name for name, row in refuted.items() if not set(row.uses) & set(refuted)]
    return list(dict.fromkeys(refuted[name].place or f"claim {name}" for name in first))


def _step(box: Box, report: Report, carrying: set[str]) -> VerdictBox:
    rows = [r for r in report.every_claim if r.proof == box.proof and r.id in box.claims]
    refuted = {row.id for row in rows if row.verdict == "refuted"}
    if refuted & carrying and box.proof == "published":
        return VerdictBox(box, "bad", "breaks")
    if refuted:
        return VerdictBox(box, "warn", "wrong, repairable")
    if rows and all(row.verdict == "proved" for row in rows):
        return VerdictBox(box, "good", _say(rows, "proved"))
    return VerdictBox(box, "open", "not shown")


def _say(rows: Sequence[ClaimRow], words: str) -> str:
    """Words that rest on the promises of some claims."""
    return all_say((row.decision.promise for row in rows), words)


def _is_true(report: Report) -> bool:
    return bool(route(report)) or set(report.verdicts((report.notes.paper.theorem,), "published")) == {
        "proved"
    }


def _concluding(report: Report) -> list[ClaimRow]:
    """The claims that say the theorem, by the alternative proof if there is one."""
    last = report.notes.route[-1] if route(report) else report.notes.chain[-1]
    return [r for r in report.every_claim if r.proof == last.proof and r.id in last.claims]


def _theorem(report: Report) -> str:
    if not _is_true(report):
        return "Whether the proposition is true was not decided here."
    rows = _concluding(report)
    joints = {row.n for row in rows}
    size = (
        "every number of joints n" if joints == {None} else f"n = {and_list(sorted(map(str, joints)))} joints"
    )
    members = f"h_m with m = {and_list(list(map(str, report.ms)))}."
    if any(row.m is None for row in rows):
        members += " The proof covers every odd bounded function of a class"
        inside = set(report.verdicts(BOUNDS, Path(CLASS).stem)) == {"proved"}
        members += ", to which h_m belongs for every real m ≥ 1." if inside else "."
    arm = ""
    if set(report.verdicts((THIS_ARM,), "scalar")) == {"proved"}:
        name, n = report.robot.name, report.robot.n
        rows += [r for r in report.every_claim if r.proof == "scalar" and r.id == THIS_ARM]
        arm = f" On {name} (n = {n}) with the gains of Table 2 it also has an explicit ε₀."
    return _say(
        rows,
        f"The proposition is true. It is proved for every arm with Properties 2.1 to 2.7, {size}, all "
        f"positive gains, and {members}{arm} {report.notes.known[0]}",
    )


def _proof(report: Report) -> str:
    broken = break_places(report)
    if not broken:
        return "No step that its printed proof rests on was refuted."
    wrong = sum(1 for finding in report.weighing("B") if finding.claims)
    more = (
        f" Another {wrong} of its statements fail, but the proposition does not need them." if wrong else ""
    )
    errors = report.errors()
    counted = f"{len(errors['quoted'])} sentences of the paper and {len(errors['implied'])} that it relies on"
    count = len(errors["ours"])
    ours = f" Another {count} refuted claims answer questions of ours." if count else ""
    return (
        f"The printed proof breaks at {and_list(broken)}.{more} Claim by claim, {counted} are refuted.{ours}"
    )


def _gains(report: Report) -> tuple[str, ...]:
    judged = [row for row in report.gate if applies(row)]
    others = [row.name for row in report.gate if not applies(row)]
    met: dict[tuple[str, tuple[str, ...]], list[GateResult]] = {}
    for row in judged:
        if row.verdict == ACCEPTED:
            met.setdefault(("meet", tuple(row.deciding)), []).append(row)
    for row in judged:
        if row.verdict == REJECTED:
            ids = dict.fromkeys(check.id for check in row.failures if check.verdict == REJECTED)
            met.setdefault(("break", tuple(ids)), []).append(row)
    failed = any(verb == "break" for verb, _ in met)
    parts = [
        f"{and_list([f'{row.name} (m = {row.m})' for row in rows])} {verb}{'s' if len(rows) == 1 else ''} "
        + f"{and_list([f'({name})' for name in ids])}{rows[0].file.bounds.said}"
        for (verb, ids), rows in met.items()
    ]
    if not parts:
        return ()
    promises = {one.name: one.promise for one in report.epsilon if one.promise is not None}
    certified = [row for row in judged if row.name in promises]
    proved = [row.name for row in certified if keeps_limits(row)]
    limitless = [row.name for row in certified if not keeps_limits(row)]
    where = " at nominal numbers" if any(one.ranged for one in report.robot.numbers.values()) else ""
    tail = ""
    if proved:
        every = len(proved) == len(judged)
        whom = and_list(proved) if not every else "it" if len(proved) == 1 else "all of them"
        arm = " on this arm" if every and report.own else ""
        so = ", so all are still stable" if every and failed and not report.own else ""
        tail = f"; dV/dt < 0 at every state is proved for {whom}{arm}{where}{so}"
    if limitless:
        what = "it is" if proved else "dV/dt < 0 at every state is"
        tail += (
            f"; of {and_list(limitless)} {what} proved for motors without a limit, and theirs may saturate"
        )
    tail = all_say((promises[row.name] for row in certified), tail) if tail else ""
    rest = f" The h of {and_list(others)} has no bound γ, so these conditions do not apply." if others else ""
    subject = "" if report.own else "Gains of Table 2: "
    return (f"{subject}{', '.join(parts)}{tail}.{rest}",)


def _of_gains(row: GateResult) -> Badge:
    """A gain set in the gate's own words."""
    if not applies(row):
        return Badge(row.name, "conditions do not apply", "open")
    (said,) = GateAnswer((row,)).data()["results"]
    tones = {ACCEPTED: "good", REJECTED: "bad", BREAKS_19: "warn"}
    return Badge(row.name, said["standing"], tones.get(row.standing, "open"))


# --- The loop on a computer in a report: a tile, and a card with what its claims suppose.


def _on_a_computer(report: Report) -> tuple[str, str]:
    """For which m it is proved as it was run, and how good that is."""
    known = {f"sampled.m{m}": str(m) for m in report.ms}
    rows = [row for row in _sampled_rows(report) if row.id in known]
    shown = [row for row in rows if row.verdict is Verdict.PROVED]
    left = [row for row in rows if row not in shown]
    asked = [row.decision.promise.asked for row in shown if row.decision.promise is not None]
    periods = {f" at {decimal_text(1000 * one.period)} ms" for one in asked if isinstance(one, SampledStable)}
    stable = _say(shown, f"stable{' and'.join(sorted(periods))} under assumptions") if shown else ""
    parts = [
        f"m = {and_list([known[row.id] for row in some])}: {word}"
        for some, word in ((shown, stable), (left, "open"))
        if some
    ]
    return "; ".join(parts) or "not asked", "open" if not rows else "warn" if left else "good"


def _sampled_rows(report: Report) -> list[ClaimRow]:
    return [row for row in report.others if row.proof == Path(SAMPLED).stem]


def sampled_section(report: Report) -> Iterator[Section]:
    """Each claim and what became of it, and what all of them suppose."""
    rows = _sampled_rows(report)
    if not rows:
        return
    first = next((row for row in rows if row.decision.granted), rows[0])
    became = ("; ".join(filter(None, (row.decision.word, row.decision.reason))) for row in rows)
    table = tuple((row.id, f"“{row.comment}”", word) for row, word in zip(rows, became, strict=True))
    words = (
        "The theorem is about a torque that changes all the time. A computer holds each torque until the "
        "next reading. These claims are about gains of Table 2, with the printed friction and gravity, and "
        f"any inertia. They assume, in the words of {first.id}:"
    )
    blocks = (
        Paragraph(words),
        Bullets(first.decision.granted),
        Table(("claim", "description", "verdict"), table, align="lll"),
    )
    yield Section("On the computer that runs it", blocks)
