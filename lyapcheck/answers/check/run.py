"""Running a proof: every claim decided for every m, by a checker that reads certificates from files."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

from lyapcheck._types import Progress, silent
from lyapcheck.answers import assumed_line
from lyapcheck.answers.check import ClaimResult, ProofResult
from lyapcheck.certificate import Certificate, to_json
from lyapcheck.check.certificate import About, digest_of
from lyapcheck.check.kinds.stability import Stable
from lyapcheck.check.statement import Statement
from lyapcheck.claims.claim import in_order
from lyapcheck.claims.decision import (
    Judged,
    Proposal,
    certificates,
    chained,
    decided,
    file_name,
    judge_afresh,
    rests_on,
    undecided,
)
from lyapcheck.claims.handover import CaseData, Handover, Key, ScriptRequest
from lyapcheck.claims.procedures import propose
from lyapcheck.claims.script import ask, find_script
from lyapcheck.claims.search_result import SearchResult
from lyapcheck.claims.statements import Missing, remarks
from lyapcheck.control.gains import GainFile, GainSet, gain_file_of, paper_gain_file
from lyapcheck.errors import InputError, Problem
from lyapcheck.search.controlled_arm import remember
from lyapcheck.store import KeptCertificates, remembered
from lyapcheck.verdicts import Grade, Verdict

DEFAULT_GAINS = "table2"
DEFAULT_ROBOT = "buap3"
OTHER_SCRIPT, OTHER_THEOREMS = "every_function.py", ("F.family", "F.family.tracking")
"""Theorems about (6) and (21) with h_m, which do not rest on the paper's argument."""
BESIDE = {"method": str, "reason": str, "witness": dict | None, "evidence": dict}
"""What a search says beside its proof."""


def gain_sets(gains: GainFile | str | Path | None, joints: int) -> tuple[GainSet, ...]:
    """The sets of the hyperbolic family; of Table 2, which nobody asked for, those that fit the arm.

    Raises:
        InputError: the gain file cannot be used, or all of its sets are for another number of joints.
    """
    file = gain_file_of(paper_gain_file(DEFAULT_GAINS) if gains is None else gains)
    if gains is not None and all(one.n != joints for one in file.gains):
        raise InputError([_misfit(file, one, joints) for one in file.gains])
    return tuple(one for one in file.gains if one.m is not None and one.n == joints)


def left_out(gains: GainFile | str | Path, joints: int, ms: Sequence[int]) -> list[str]:
    """Which sets of a gain file the claims are not about, and why, a sentence each."""
    file, taken, result = gain_file_of(gains), set(), []
    for one in file.gains:
        if one.n != joints:
            why = f"it has gains for {one.n} joints where the claims are about {joints}"
        elif one.m is None:
            why = f"it is of the family {one.family}, and scripts are about members of the hyperbolic family"
        elif one.m not in ms:
            why = f"--m does not ask for m = {one.m}"
        elif one.m in taken:
            why = f"a set before it has m = {one.m}, too"
        else:
            taken.add(one.m)
            continue
        result.append(f"{file.path}: {one.name} is left out: {why}")
    return result


def _misfit(file: GainFile, one: GainSet, joints: int) -> Problem:
    place = file.place(one, "kp")
    rule = f"{one.name} has gains for {one.n} joints, but the claims are about {joints}"
    repair = f"choose an arm of {one.n} joints by --robot, or give {joints} gains, one a joint"
    return Problem(file.path, place.line if place else None, "kp", "", rule, repair)


def run_proof(
    path: str | Path,
    ms: Sequence[int] = (1, 2, 3),
    robot: Any = None,
    n: int | None = None,
    gains: Any = None,
    only: Sequence[str] = (),
    on_progress: Progress | None = None,
) -> ProofResult:
    """Decide the claims of a proof script for each m.

    Args:
        path: the script, a program that runs in a process of its own; ``published.py`` is found wherever
            lyapcheck is installed.
        ms: the members of the family, m >= 1.
        robot: an arm, its name or its file. Default: the paper's arm, unless ``n`` is given.
        n: the number of joints, for claims on vectors, instead of a robot.
        gains: a gain file or its path. Default: Table 2 of the paper.
        only: the ids to report. Claims that they use are also decided.
        on_progress: called with the fraction done and the id at work.

    Returns:
        One result per claim and m. A claim that does not depend on m has one result with ``m = None``.

    Raises:
        InputError: the script, an id, the robot or the gain file cannot be used, or the gains are for another
            number of joints.

    Soundness: a fresh process of the checker recomputes verdicts and grades from the certificates. A claim is
    proved only if its own certificate is accepted and every claim that it uses is proved for the same m.
    Claims behind the hypotheses of a theorem must state these hypotheses.
    """
    made, result = proposed_proof(path, ms, robot, n, gains, only, on_progress)
    return result(judge_afresh(made))


def _elsewhere(result: ProofResult, model: Any) -> dict[Key, tuple[str, ClaimResult]]:
    """Theorems that a proof leaves open and another script proves, each with that script and its claim.

    Soundness: the other claim is proved, about the same system, without a condition or an assumption that
    the open theorem does not have, and its conclusion is the same.
    """
    open_ = [row for row in result.theorems if row.verdict is not Verdict.PROVED and row.m is not None]
    if not open_ or result.name == Path(OTHER_SCRIPT).stem:
        return {}
    ms, n = tuple(dict.fromkeys(row.m for row in open_ if row.m is not None)), result.n
    others = run_proof(OTHER_SCRIPT, ms, model, n if model is None else None, only=OTHER_THEOREMS).claims
    return {
        (row.id, row.m): (OTHER_SCRIPT, other)
        for row in open_
        for other in others
        if other.m == row.m and other.verdict is Verdict.PROVED and _says_as_much(other.stated, row.stated)
    }


def _says_as_much(shown: Statement | Missing, asked: Statement | Missing) -> bool:
    """Whether one theorem of stability follows from another: see `_elsewhere`."""
    if not isinstance(shown, Stable) or not isinstance(asked, Stable) or shown.argument.local:
        return False
    about = shown.argument.system == asked.argument.system and shown.conclusion == asked.conclusion
    return about and _conditions(shown) <= _conditions(asked)


def _conditions(theorem: Stable) -> set[object]:
    """What a theorem supposes, without the meaning of its letters."""
    meanings = [text for text in theorem.granted if text.startswith("the letters are ")]
    return {*theorem.argument.where, *theorem.granted}.difference(meanings)


def proposed_proof(
    path: str | Path,
    ms: Sequence[int] = (1, 2, 3),
    robot: Any = None,
    n: int | None = None,
    gains: Any = None,
    only: Sequence[str] = (),
    on_progress: Progress | None = None,
) -> tuple[Mapping[Key, Certificate], Callable[[Mapping[Key, Judged]], ProofResult]]:
    """What searches propose for the claims of a proof script, of which nothing is decided; see `run_proof`.

    Returns:
        The certificates, to be judged beside others, and what makes of their verdicts the result.
    """
    script = find_script(str(path))
    model = _robot(robot, n)
    if model is not None:
        remember(model)
    joints = n if n is not None else model.n
    sets = gain_sets(gains, joints)
    asked = tuple((m, joints, model, next((s for s in sets if s.m == m), None)) for m in dict.fromkeys(ms))
    handover = ask(ScriptRequest(str(script), script.name, asked, _others(asked), tuple(only)))
    proposals = _proposals(handover, asked, script.name, on_progress or silent)
    made, claims = certificates(proposals, handover.name), handover.claims
    about_arm, about_gains = (
        frozenset(claim.id for claim in claims if any(name in answer.read for answer in claim.answers))
        for name in ("robot", "gains")
    )

    def result(judged: Mapping[Key, Judged]) -> ProofResult:
        results, places = _results(proposals, judged), {claim.id: k for k, claim in enumerate(claims)}
        every = sorted(results, key=lambda key: (places[key[0]], key[1] or 0))
        found = ProofResult(
            handover.name,
            handover.title,
            tuple(ms),
            joints,
            model.name if model else None,
            tuple(results[key] for key in every if not only or key[0] in only),
            model.assumptions if model and about_arm else (),
            {file_name(*key): made[key] for key in every if results[key].decision.certificate is not None},
            str(path),
            about_gains,
            assumed=assumed_line(model, model.name) if model and about_arm else "",
        )
        return replace(found, elsewhere=_elsewhere(found, model))

    return made, result


def paper_case_data(m: int) -> CaseData:
    """What the case of the paper is made of."""
    model = _robot(None, None)
    return m, model.n, model, next((s for s in gain_sets(None, model.n) if s.m == m), None)


def _others(asked: Sequence[CaseData]) -> tuple[CaseData, ...]:
    """One case with another m and one with another n, to see what a claim depends on whatever it reads."""
    if not asked:
        return ()
    m, n, model, _ = asked[-1]
    return (max(m for m, *_ in asked) + 1, n, model, None), (m, n + 1, None, None)


def _proposals(
    handover: Handover, asked: Sequence[CaseData], file: str, on_progress: Progress
) -> dict[Key, Proposal]:
    """What the searches propose, each row after those it uses."""
    result: dict[Key, Proposal] = {}
    order = [
        claim for claim in in_order({claim.id: claim for claim in handover.claims}, file) if claim.answers
    ]
    depends, search = _dependences(handover), cache(_search)
    for index, (m, n, _, _) in enumerate(asked):
        for step, claim in enumerate(order):
            on_progress((index + step / len(order)) / len(asked), f"m = {m}: {claim.id}")
            key = claim.id, m if "m" in depends[claim.id] else None
            if key in result:
                continue
            begin = time.perf_counter()
            stated = handover.stated(claim.answers[index])
            used = tuple((name, m if "m" in depends[name] else None) for name in claim.uses)
            finding = chained(search(stated), stated, [result[one] for one in used])
            joints = n if "n" in depends[claim.id] else None
            result[key] = Proposal(claim, key[1], joints, stated, used, finding, time.perf_counter() - begin)
    return result


def _dependences(handover: Handover) -> dict[str, set[str]]:
    """Which of m and n each claim depends on, itself or by what it uses.

    A claim is independent of m only if it never looked at m and states the same for every m, the other one
    included; and likewise for n.
    """
    depends: dict[str, set[str]] = {}
    for claim in in_order({claim.id: claim for claim in handover.claims}, ""):
        if claim.answers:
            *own, other_m, other_n = (handover.stated(answer) for answer in claim.answers)
            same = {"m": all(one == other_m for one in own), "n": own[-1] == other_n}
            read = {name for answer in claim.answers[: len(own)] for name in answer.read}
            depends[claim.id] = {name for name in "mn" if name in read or not same[name]}.union(
                *(depends[name] for name in claim.uses)
            )
    return depends


def _search(statement: Statement | Missing) -> SearchResult:
    """What the search proposes, or has proposed before; the checker judges it either way."""
    try:
        if isinstance(statement, Missing):
            return propose(statement)
        asked = {"search": digest_of(to_json(statement))}
        return remembered(
            asked,
            lambda kept: _rebuilt(kept, asked),
            lambda: propose(statement),
            lambda result: _written(statement, result),
        )
    except Exception as error:
        return SearchResult(Verdict.ERROR, "", reason=f"{type(error).__name__}: {error}")


def _written(statement: Statement, result: SearchResult) -> KeptCertificates | None:
    if result.proof is None:
        return None
    about, grade = About("search", "", None, None, ""), result.grade.label
    made = Certificate(about, statement, result.verdict.value, grade, result.proof)
    return KeptCertificates({"search": made}, {name: getattr(result, name) for name in BESIDE})


def _rebuilt(kept: KeptCertificates, asked: Mapping[str, str]) -> SearchResult | None:
    """What was proposed, if it shows what is asked now."""
    one, beside = kept.certificates["search"], kept.beside
    if {"search": digest_of(to_json(one.statement))} != asked:
        return None
    if not all(isinstance(beside[name], form) for name, form in BESIDE.items()):
        return None
    grade = Grade[one.grade.upper()]
    return SearchResult(Verdict(one.verdict), proof=one.proof, grade=grade, **{k: beside[k] for k in BESIDE})


def _results(proposals: Mapping[Key, Proposal], judged: Mapping[Key, Judged]) -> dict[Key, ClaimResult]:
    """What the checker says about each row; what the row uses can only take from that."""
    result: dict[Key, ClaimResult] = {}
    for key, row in proposals.items():
        claim, decision = row.claim, decided(row.finding, judged.get(key), row.stated)
        broken = tuple(used for used, m in row.used if result[used, m].verdict is not Verdict.PROVED)
        if decision.verdict is Verdict.PROVED and broken:
            decision = undecided(rests_on(broken), decision.method, **decision.evidence)
        elif decision.verdict in (Verdict.PROVED, Verdict.UNDECIDED) and not isinstance(row.stated, Missing):
            said = (decision.reason, *remarks(row.stated, _search))
            decision = replace(decision, reason="; ".join(filter(None, said)))
        result[key] = ClaimResult(
            id=claim.id,
            m=row.m,
            n=row.n,
            comment=claim.says,
            place=claim.place,
            section=claim.section,
            kind=type(row.stated).__name__,
            uses=claim.uses,
            broken=broken,
            decision=decision,
            stated=row.stated,
            seconds=row.seconds,
            stands=claim.stands,
        )
    return result


def _robot(robot: Any, n: int | None) -> Any:
    """The arm; ``None`` where a number of joints is given instead."""
    from lyapcheck.robots import arm_of

    return None if robot is None and n is not None else arm_of(robot or DEFAULT_ROBOT)
